#include "surgeon_site/simulated_hand.h"

#include <cmath>

#include <gtest/gtest.h>

#include "surgeon_site/script_builder.h"
#include "tests/surgeon_site/fake_session.h"

namespace palp::surgeon {
namespace {

using std::chrono_literals::operator""s;
using std::chrono_literals::operator""ms;

GestureScript still() { return ScriptBuilder{300}.hold(1000s).build(); }

TimePoint at(Duration span) { return TimePoint{1000s} + span; }

TEST(SimulatedHandTest, ReportsWholeCountsOfItsEncoder) {
  SimulatedHand hand{{}, still()};
  for (Duration t{}; t < 1s; t += 1ms) {
    const double counts = hand.read(at(t)).position / 0.03e-3;
    ASSERT_NEAR(counts, std::round(counts), 1e-9);
    ASSERT_LE(std::abs(hand.read(at(t)).position - hand.truth().position), 0.015e-3 + 1e-12);
    hand.apply(0.5 * std::sin(seconds(t) * 20));
  }
}

TEST(SimulatedHandTest, TremblesWithItsAmplitude) {
  SimulatedHandConfig config;
  config.plant.grip = kFirmGrip;
  SimulatedHand hand{config, still()};
  double low = 1, high = -1;
  for (Duration t{}; t < 2s; t += 1ms) {
    hand.read(at(t));
    if (t < 1s) continue;
    low = std::min(low, hand.truth().position);
    high = std::max(high, hand.truth().position);
  }
  EXPECT_NEAR((high - low) / 2, 0.03e-3, 0.015e-3);
  EXPECT_NEAR((high + low) / 2, -10e-3, 0.005e-3);
}

TEST(SimulatedHandTest, ReadingTwiceInOneInstantChangesNothing) {
  SimulatedHand hand{{}, still()};
  hand.read(at(0ms));
  const HandState first = hand.read(at(1ms));
  const HandState second = hand.read(at(1ms));
  EXPECT_EQ(first.position, second.position);
  EXPECT_EQ(first.velocity, second.velocity);
  EXPECT_EQ(second.sampled_at, at(1ms));
  EXPECT_EQ(hand.read(at(0ms)).sampled_at, at(1ms)) << "time does not run backwards";
}

TEST(SimulatedHandTest, MissedTicksAreLivedThrough) {
  SimulatedHand every{{}, still()};
  SimulatedHand some{{}, still()};
  every.read(at(0ms));
  some.read(at(0ms));
  every.apply(1.0);
  some.apply(1.0);
  for (Duration t = 1ms; t <= 300ms; t += 1ms) every.read(at(t));
  for (Duration t = 5ms; t <= 300ms; t += 5ms) some.read(at(t));
  EXPECT_NEAR(every.truth().position, some.truth().position, 1e-6);
  EXPECT_NEAR(every.truth().work, some.truth().work, 1e-6);
}

TEST(SimulatedHandTest, LivesAtMostATenthOfASecondAtOnce) {
  SimulatedHand paused{{}, still()};
  SimulatedHand lively{{}, still()};
  for (SimulatedHand* hand : {&paused, &lively}) {
    hand->read(at(0ms));
    hand->apply(1.0);
  }
  paused.read(at(3600s));
  lively.read(at(100ms));
  EXPECT_EQ(paused.truth().position, lively.truth().position);
  EXPECT_EQ(paused.read(at(3600s)).sampled_at, at(3600s));
}

TEST(SimulatedHandTest, AppliesNoMoreThanItCanAndNothingThatIsNoNumber) {
  SimulatedHand hand{{}, still()};
  hand.apply(100);
  EXPECT_EQ(hand.truth().force, 8.5);
  hand.apply(-100);
  EXPECT_EQ(hand.truth().force, -8.5);
  hand.apply(std::nan(""));
  EXPECT_EQ(hand.truth().force, 0);
}

TEST(SimulatedHandTest, VelocityIsTheFilteredRateOfTheEncoder) {
  // A slow long move: the mean of the reported velocity is the mean rate.
  SimulatedHand hand{{}, still()};
  FakeSession session{-40e-3};
  double sum = 0;
  double begin = hand.read(at(0ms)).position;
  Duration t{};
  for (; t < 1s; t += 1ms) {
    sum += hand.read(at(t)).velocity * 1e-3;
    hand.show(session.view());
  }
  const double way = hand.read(at(t - 1ms)).position - begin;
  EXPECT_LT(way, -5e-3);
  EXPECT_NEAR(sum, way, 0.15e-3);
}

TEST(SimulatedHandTest, PerformsItsScriptAgainstASpring) {
  SimulatedHandConfig config;
  GestureScript script = standard_script({.hand_stiffness = config.plant.grip.stiffness});
  SimulatedHand hand{config, script};
  FakeSession session{-10e-3};
  double deepest = -1;
  double work_low = 0;
  Duration t{};
  for (; t < 60s && !hand.finished(); t += 1ms) {
    const HandState state = hand.read(at(t));
    session.step(state.pedal_held);
    hand.show(session.view());
    hand.apply(plain_force(std::max(0.0, hand.truth().position)));
    deepest = std::max(deepest, hand.truth().position);
    work_low = std::min(work_low, hand.truth().work);
  }
  EXPECT_TRUE(hand.finished());
  EXPECT_EQ(hand.progress().outcome, ScriptOutcome::Completed);
  // On the tissue the script assumes, the hand reaches the depth the script names.
  EXPECT_NEAR(deepest, 4e-3, 0.2e-3);
  // A sampled spring gives back what it took, and the little its sampling adds.
  EXPECT_GT(work_low, -0.1e-3);
}

}  // namespace
}  // namespace palp::surgeon
