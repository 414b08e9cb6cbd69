#include "surgeon_site/placed_hand.h"

#include <gtest/gtest.h>

#include "tests/support/realtime_guard.h"

namespace palp::surgeon {
namespace {

/// A hand that stands somewhere and remembers what it was given.
struct Given final : HapticDevice {
  HandState state{.position = 2e-3, .velocity = 0.1, .place = {1e-3, 2e-3}, .pedal_held = true};
  double force{};
  bool held{};
  int shown{};
  [[nodiscard]] HandFacts hand_facts() const noexcept override { return {.force_peak = 4}; }
  HandState read(TimePoint now) noexcept override {
    state.sampled_at = now;
    return state;
  }
  void apply(double newtons) noexcept override { force = newtons; }
  void show(const OperatorView& /*view*/) noexcept override { ++shown; }
  void hold_in_plane(bool wanted) noexcept override { held = wanted; }
  [[nodiscard]] ScriptProgress progress() const noexcept override { return {.phase = 3}; }
};

TEST(PlacedHandTest, StandsWhereItIsWantedAndIsElseTheHand) {
  Given given;
  PlacedHand hand{given};
  const TimePoint now{std::chrono::seconds{5}};
  EXPECT_EQ(hand.read(now).place, (Place{1e-3, 2e-3}));
  hand.places().put({.place = {-7e-3, 9e-3}, .number = 1});
  const test::RealtimeGuard guard;
  const HandState read = hand.read(now);
  hand.apply(0.7);
  hand.hold_in_plane(true);
  hand.show({});
  EXPECT_TRUE(guard.clean()) << guard.first_violation();
  EXPECT_EQ(read.place, (Place{-7e-3, 9e-3}));
  EXPECT_EQ(read.position, 2e-3);
  EXPECT_EQ(read.velocity, 0.1);
  EXPECT_EQ(read.sampled_at, now);
  EXPECT_TRUE(read.pedal_held);
  EXPECT_EQ(given.force, 0.7);
  EXPECT_TRUE(given.held);
  EXPECT_EQ(given.shown, 1);
  EXPECT_EQ(hand.hand_facts().force_peak, 4);
  EXPECT_EQ(hand.progress().phase, 3U);
}

TEST(PlacedHandTest, MovesOnFromItsPlaceAsFarAsItMayLeaveIt) {
  Given given;
  PlacedHand hand{given};
  const auto place = [&](const Place& own) {
    given.state.place = own;
    return hand.read({}).place;
  };
  const auto stands = [](const Place& is, const Place& wanted) {
    EXPECT_LT(distance(is, wanted), 1e-12) << is.x << ' ' << is.y;
  };
  given.state.place = {50e-3, 3e-3};
  hand.places().put({.place = {-7e-3, 9e-3}, .reach = 20e-3, .number = 1});
  stands(place({50e-3, 3e-3}), {-7e-3, 9e-3});
  stands(place({55e-3, -3e-3}), {-2e-3, 3e-3});
  stands(place({90e-3, 3e-3}), {13e-3, 9e-3});  // the edge
  stands(place({51e-3, 3e-3}), {-6e-3, 9e-3});
  hand.places().put({.place = {1e-3, 1e-3}, .reach = 0, .number = 2});
  stands(place({60e-3, 3e-3}), {1e-3, 1e-3});
  stands(place({70e-3, 9e-3}), {1e-3, 1e-3});
}

}  // namespace
}  // namespace palp::surgeon
