#include "common/coupling/contact_model.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp::coupling {
namespace {

/// Often none, as in most telegrams; else one that rises and falls.
KnotStiffness some_stiffness() {
  KnotStiffness stiffness{};
  if (*rc::gen::inRange(0, 3) == 0) return stiffness;
  for (double& one : stiffness) one = *rc::gen::inRange(0, 1500);
  return stiffness;
}

ContactModel some_model() {
  const auto share = [] { return *rc::gen::inRange(0, 1000) * 1e-3; };
  return {1e-3 * (share() - 0.5),
          {0.3 * share(), 0.3 * share(), 0.1 * share(), 0.02 * share(), 1e-4 * share()},
          7e-3 * share(),
          some_stiffness()};
}

RC_GTEST_PROP(ContactModelTest, EnergyIsTheIntegralOfTheForce, ()) {
  const ContactModel model = some_model();
  const double depth = *rc::gen::inRange(1, 9000) * 1e-6;
  // Simpson's rule over 2,000 parts, which knows nothing of the closed forms.
  constexpr int kParts = 2000;
  double sum = model.force(0) + model.force(depth);
  for (int i = 1; i < kParts; ++i) sum += (i % 2 == 0 ? 2 : 4) * model.force(depth * i / kParts);
  const double integral = sum * depth / (3 * kParts);
  RC_ASSERT(std::abs(model.energy(depth) - integral) <= 1e-5 * integral + 1e-15);
}

RC_GTEST_PROP(ContactModelTest, ADepthIsFoundFromItsForce, ()) {
  const ContactModel model = some_model();
  const double depth = *rc::gen::inRange(100, 7900) * 1e-6;
  const double force = model.force(depth);
  RC_PRE(force > 1e-3);
  RC_ASSERT(std::abs(model.force(model.depth(force)) - force) <= 1e-6);
}

RC_GTEST_PROP(ContactModelTest, ForceRisesFromZeroAtTheSurfaceWhateverTheStiffness, ()) {
  const ContactModel model = some_model();
  const double step = 10e-6;
  const double depth = *rc::gen::inRange(10, 9000) * 1e-6;
  RC_ASSERT(model.force(0) == 0);
  RC_ASSERT(model.force(-depth) == 0);
  RC_ASSERT(model.energy(-depth) == 0);
  const double before = model.force(depth) - model.force(depth - step);
  const double after = model.force(depth + step) - model.force(depth);
  RC_ASSERT(before >= 0);
  // The mean value theorem: somewhere in between the slope is that of the chord.
  double least = model.slope(depth);
  double most = least;
  for (int i = -20; i <= 20; ++i) {
    const double slope = model.slope(depth + i * step / 20);
    least = std::min(least, slope);
    most = std::max(most, slope);
  }
  const double chord = (after + before) / (2 * step);
  RC_ASSERT(chord >= 0.99 * least - 1e-9);
  RC_ASSERT(chord <= 1.01 * most + 1e-9);
}

RC_GTEST_PROP(ContactModelTest, TheFiveShapesAloneAreConvex, ()) {
  ContactModel model = some_model();
  model.stiffness = {};
  const double step = 10e-6;
  const double depth = *rc::gen::inRange(10, 9000) * 1e-6;
  const double before = model.force(depth) - model.force(depth - step);
  const double after = model.force(depth + step) - model.force(depth);
  // The tangent of a convex curve lies between its chords on both sides.
  const double tangent = model.slope(depth) * step;
  RC_ASSERT(before <= tangent + 1e-12);
  RC_ASSERT(tangent <= after + 1e-12);
}

TEST(ContactModelTest, GoesOnAlongItsTangentBeyondWhatWasMeasured) {
  const ContactModel model{0, {0.02, 0.06, 0.01, 0.005, 1e-4}, 4e-3};
  EXPECT_NEAR(model.force(6e-3), model.force(4e-3) + 2e-3 * model.slope(4e-3), 1e-12);
  EXPECT_EQ(model.slope(6e-3), model.slope(4e-3));
}

TEST(ContactModelTest, IsNotBelievedWithNumbersThatNoPassiveTissueHas) {
  const ModelPayload good{.version = 1, .c = {0, 0.06, 0, 0, 0}};
  const auto with = [&](auto change) {
    ModelPayload model = good;
    change(model);
    return is_sound(model, 60e-3);
  };
  EXPECT_TRUE(with([](ModelPayload&) {}));
  EXPECT_TRUE(with([](ModelPayload& m) { m.surface = 60e-3; }));
  EXPECT_FALSE(with([](ModelPayload& m) { m.surface = 61e-3; }));
  EXPECT_FALSE(with([](ModelPayload& m) { m.surface = std::nan(""); }));
  EXPECT_FALSE(with([](ModelPayload& m) { m.depth_max = INFINITY; }));
  EXPECT_FALSE(with([](ModelPayload& m) { m.c[0] = -1e-9; }));
  EXPECT_FALSE(with([](ModelPayload& m) { m.c[2] = std::nan(""); }));
  EXPECT_FALSE(with([](ModelPayload& m) { m.c[3] = INFINITY; }));
  EXPECT_FALSE(with([](ModelPayload& m) { m.c[4] = -1e-9; }));
  EXPECT_TRUE(with([](ModelPayload& m) { m.relaxing = {1, 1}; }));
  EXPECT_FALSE(with([](ModelPayload& m) { m.relaxing[0] = -1e-9; }));
  EXPECT_FALSE(with([](ModelPayload& m) { m.relaxing[1] = 1.001; }));
  EXPECT_FALSE(with([](ModelPayload& m) { m.relaxing[1] = std::nan(""); }));
  EXPECT_TRUE(with([](ModelPayload& m) { m.stiffness[11] = 1500; }));
  EXPECT_FALSE(with([](ModelPayload& m) { m.stiffness[0] = -1e-9; }));
  EXPECT_FALSE(with([](ModelPayload& m) { m.stiffness[11] = std::nan(""); }));
}

TEST(ContactModelTest, SaysTheStiffnessAtAKnotAndStraightLinesBetween) {
  ContactModel model{.reach = 10e-3};
  model.stiffness = {100, 300, 200};
  EXPECT_NEAR(model.slope(0.25e-3), 200, 1e-9);
  EXPECT_NEAR(model.slope(0.5e-3), 300, 1e-9);
  EXPECT_NEAR(model.slope(0.75e-3), 250, 1e-9);
  EXPECT_NEAR(model.force(1e-3), 0.1 + 0.125, 1e-12);
  EXPECT_NEAR(knot_ramp(1, 1e-3), 0.5e-3, 1e-15);
}

TEST(ContactModelTest, NoMoreIsShownOfASurfaceThatWasHardlyTouched) {
  const ContactModel shown = no_steeper({.c = {0.1}, .reach = 0}, 50);
  EXPECT_LE(shown.slope(1e-3), 50 * (1 + 1e-9));
}

RC_GTEST_PROP(ContactModelTest, NoMoreIsShownThanADeviceMayShow, ()) {
  const ContactModel model = some_model();
  const double most = *rc::gen::inRange(50, 3000);
  const ContactModel shown = no_steeper(model, most);
  const double depth = *rc::gen::inRange(1, 9000) * 1e-6;
  RC_ASSERT(shown.slope(depth) <= most * (1 + 1e-9));
  RC_ASSERT(shown.force(depth) <= model.force(depth) + 1e-12);
}

/// Or a little of it would make a wall of another model that reaches deeper.
TEST(ContactModelTest, NoTermOfWhatIsShownIsHugeThoughItReachesNoDepth) {
  for (std::size_t term = 0; term < kModelTerms; ++term) {
    ContactModel model{.reach = 5e-3};
    model.c[term] = 1e5;
    ContactModel alone;
    alone.c[term] = no_steeper(model, 1500).c[term];
    alone.reach = 0.25e-3;
    EXPECT_LE(alone.slope(alone.reach), 1500 * (1 + 1e-9)) << term;
    EXPECT_GE(alone.slope(alone.reach), 1500 * (1 - 1e-9)) << term;
  }
}

TEST(ContactModelTest, WhatIsNotTooSteepIsShownAsItIs) {
  ContactModel model{0, {0.02, 0.06, 0.01, 0.005, 1e-4}, 4e-3};
  model.stiffness[3] = 50;
  const ContactModel shown = no_steeper(model, 2000);
  EXPECT_EQ(shown.c, model.c);
  EXPECT_EQ(shown.stiffness, model.stiffness);
  EXPECT_EQ(shown.reach, model.reach);
}

TEST(ContactModelTest, WhatAStiffSkinLostIsMadeGoodInSofterTissueUnderIt) {
  // 2,500 N/m to 1 mm, then 600.
  ContactModel skin{0, {}, 8e-3};
  skin.stiffness = {2500, 2500, 600, 600, 600, 600, 600, 600, 600, 600, 600, 600};
  const ContactModel shown = no_steeper(skin, 1500);
  EXPECT_LT(shown.force(0.5e-3), 0.7 * skin.force(0.5e-3));
  EXPECT_NEAR(shown.force(4e-3) / skin.force(4e-3), 1, 0.01);
  for (int i = 1; i <= 100; ++i) {
    EXPECT_LE(shown.force(0.1e-3 * i), skin.force(0.1e-3 * i) + 1e-12) << i;
    EXPECT_LE(shown.slope(0.1e-3 * i), 1500 * (1 + 1e-9)) << i;
  }
}

RelaxingContact some_relaxing() {
  RelaxingContact contact;
  contact.become(some_model(),
                 {1e-3 * *rc::gen::inRange(0, 500), 1e-3 * *rc::gen::inRange(1, 500)});
  contact.age(1e-6 * *rc::gen::inRange(1, 7000), 1e-3 * *rc::gen::inRange(1, 2000));
  return contact;
}

RC_GTEST_PROP(RelaxingContactTest, WithAPastThatStandsStillItIsASpringThatNeverPulls, ()) {
  const RelaxingContact contact = some_relaxing();
  const double depth = *rc::gen::inRange(1, 9000) * 1e-6;
  constexpr int kParts = 4000;
  double sum = 0.5 * contact.force(depth);
  double before = 0;
  double rise = 0;
  for (int i = 0; i < kParts; ++i) {
    const double force = contact.force(depth * i / kParts);
    RC_ASSERT(force >= before);
    rise = std::max(rise, force - before);
    before = force;
    sum += force;
  }
  const double integral = sum * depth / kParts;
  // The trapezes miss the corner where the force begins.
  const double corner = rise * depth / kParts;
  RC_ASSERT(std::abs(contact.energy(depth) - integral) <= 2e-3 * integral + corner + 1e-12);
}

RC_GTEST_PROP(RelaxingContactTest, NoPathEverGivesMoreThanItTook, ()) {
  RelaxingContact contact;
  contact.become(some_model(), {0.3, 0.4});
  double work = 0;
  double depth = 0;
  double least = 0;
  for (int leg = 0; leg < 12; ++leg) {
    const double to = *rc::gen::inRange(-500, 7000) * 1e-6;
    const int ticks = *rc::gen::inRange(20, 2000);
    for (int i = 1; i <= ticks; ++i) {
      const double next = depth + (to - depth) / (ticks - i + 1);
      work += 0.5 * (contact.force(depth) + contact.force(next)) * (next - depth);
      depth = next;
      contact.age(depth, 1e-3);
      least = std::min(least, work);
    }
  }
  RC_ASSERT(least >= -2e-6);  // what steps of 1 ms are wrong by
}

TEST(RelaxingContactTest, ComesToTheElasticForceAndBeginsAboveIt) {
  const ContactModel elastic{0, {0, 0.06, 0, 0, 0}, 6e-3};
  RelaxingContact contact;
  contact.become(elastic, {0.1, 0.2});
  EXPECT_NEAR(contact.force(4e-3), 1.3 * elastic.force(4e-3), 1e-12);
  for (int tick = 0; tick < 2500; ++tick) contact.age(4e-3, 1e-3);
  const double slow = 0.2 * std::exp(-1.0) + 0.1 * std::exp(-5.0);
  EXPECT_NEAR(contact.force(4e-3) / elastic.force(4e-3), 1 + slow, 1e-3);
  for (int tick = 0; tick < 30'000; ++tick) contact.age(4e-3, 1e-3);
  EXPECT_NEAR(contact.force(4e-3), elastic.force(4e-3), 1e-5);
  EXPECT_EQ(contact.force(0.5e-3), 0);  // let go of faster than it comes back
  contact.forget();
  EXPECT_GT(contact.force(0.5e-3), 0);
}

}  // namespace
}  // namespace palp::coupling
