#include "common/coupling/contact_model.h"

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp::coupling {
namespace {

ContactModel some_model() {
  const auto share = [] { return *rc::gen::inRange(0, 1000) * 1e-3; };
  return {1e-3 * (share() - 0.5),
          {0.3 * share(), 0.1 * share(), 0.02 * share(), 0.3 * share()},
          7e-3 * share()};
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

RC_GTEST_PROP(ContactModelTest, ForceIsConvexAndRisesFromZeroAtTheSurface, ()) {
  const ContactModel model = some_model();
  const double step = 10e-6;
  const double depth = *rc::gen::inRange(10, 9000) * 1e-6;
  RC_ASSERT(model.force(0) == 0);
  RC_ASSERT(model.force(-depth) == 0);
  RC_ASSERT(model.energy(-depth) == 0);
  const double before = model.force(depth) - model.force(depth - step);
  const double after = model.force(depth + step) - model.force(depth);
  RC_ASSERT(before >= 0);
  // The tangent of a convex curve lies between its chords on both sides.
  const double tangent = model.slope(depth) * step;
  RC_ASSERT(before <= tangent + 1e-12);
  RC_ASSERT(tangent <= after + 1e-12);
}

TEST(ContactModelTest, GoesOnAlongItsTangentBeyondWhatWasMeasured) {
  const ContactModel model{0, {0.06, 0.01, 0.005, 0.02}, 4e-3};
  EXPECT_NEAR(model.force(6e-3), model.force(4e-3) + 2e-3 * model.slope(4e-3), 1e-12);
  EXPECT_EQ(model.slope(6e-3), model.slope(4e-3));
}

TEST(ContactModelTest, IsNotBelievedWithNumbersThatNoPassiveTissueHas) {
  const ModelPayload good{.version = 1, .c = {0.06, 0, 0, 0}};
  const auto with = [&](auto change) {
    ModelPayload model = good;
    change(model);
    return is_sound(model, 60e-3, 2000);
  };
  EXPECT_TRUE(with([](ModelPayload&) {}));
  EXPECT_TRUE(with([](ModelPayload& m) { m.surface = 60e-3; }));
  EXPECT_FALSE(with([](ModelPayload& m) { m.surface = 61e-3; }));
  EXPECT_FALSE(with([](ModelPayload& m) { m.surface = std::nan(""); }));
  EXPECT_FALSE(with([](ModelPayload& m) { m.depth_max = INFINITY; }));
  EXPECT_FALSE(with([](ModelPayload& m) { m.c[0] = -1e-9; }));
  EXPECT_FALSE(with([](ModelPayload& m) { m.c[2] = std::nan(""); }));
  EXPECT_FALSE(with([](ModelPayload& m) { m.c[3] = INFINITY; }));
  // 2 c xi/L0 at xi = 5: 2,000 N/m is c2 = 0.2 N.
  EXPECT_TRUE(with([](ModelPayload& m) { m.c = {0, 0.2, 0, 0}; }));
  EXPECT_FALSE(with([](ModelPayload& m) { m.c = {0, 0.2001, 0, 0}; }));
}

}  // namespace
}  // namespace palp::coupling
