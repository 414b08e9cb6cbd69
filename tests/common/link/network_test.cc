// Goal: what a Link stands over a wide-area network: losses repaired, blackouts survived.
// Method: two Links under keys over the engine of palp-netem, in virtual time.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/common/link/loss_repair.h"

namespace palp::link {
namespace {

using std::chrono_literals::operator""s;
using std::chrono_literals::operator""ms;

TEST(NetworkTest, RepetitionRepairsRandomLosses) {
  const Repair repair = repair_over(kRandom, 100'000, 31);
  EXPECT_NEAR(repair.lost, 0.05, 0.003);
  EXPECT_LE(repair.missing, 2e-4);  // 0.05^3
}

TEST(NetworkTest, RepetitionRepairsMostOfTheBurstsOfThree) {
  const Repair repair = repair_over(kBursts, 100'000, 32);
  EXPECT_NEAR(repair.lost, 0.02, 0.003);
  EXPECT_LE(repair.missing, 6e-4);
}

LinkState state_of(const LinkHealth& health) {
  if (health.session_id == 0) return LinkState::Down;
  if (health.gap > 500ms) return LinkState::Lost;
  return health.gap > 100ms ? LinkState::Hold : LinkState::Live;
}

constexpr Duration kWay = 20ms;
constexpr Duration kWhen = 3s;  ///< the trouble begins

/// What both ends must do around one time of trouble.
struct Watch {
  Duration longest_gap{};
  LinkState worst{LinkState::Live};
  TimePoint live_again{};  ///< the last change back to Live
};

Watch watch_over(Duration span, NetworkCouple& couple) {
  Watch watch;
  for (NetworkCouple::Side* side : {&couple.surgeon, &couple.patient}) {
    side->look = [&watch, side, &couple](const Arrivals& arrivals) {
      const LinkHealth& health = side->health;
      if (couple.now < TimePoint{1s}) return;
      // The recorded gap decides, at every tick of either end.
      ASSERT_EQ(health.state, state_of(health)) << couple.now.time_since_epoch().count();
      if (arrivals.accepted > 0) {
        ASSERT_EQ(health.state, LinkState::Live) << "out of HOLD and LOST with the first accepted";
      }
      for (const Incoming& one : arrivals.samples) {
        if (!one.fresh) continue;
        const Duration age = one.arrived_at.time_since_epoch() - one.sent_at.time_since_epoch();
        ASSERT_LE(age, kWay + 200ms + 1ms) << "a stale command was handed over as fresh";
      }
      if (health.state != LinkState::Live) watch.live_again = couple.now;
      watch.longest_gap = std::max(watch.longest_gap, health.gap);
      if (health.state == LinkState::Down || health.state > watch.worst) {
        watch.worst = health.state;
      }
    };
  }
  couple.run(kWhen + span + 5s);
  return watch;
}

netem::PathPlan path_with(netem::Change::Kind kind, Duration span) {
  const netem::Impairment delay = netem::impaired("delay 20ms");
  netem::Change change;
  change.at = kWhen;
  change.kind = kind;
  change.span = span;
  return {.impairment = delay, .changes = {change}};
}

TEST(NetworkTest, EveryBlackoutLeadsToTheStateOfItsGapAndBackAtOnce) {
  for (const Duration span :
       std::initializer_list<Duration>{50ms, 100ms, 150ms, 500ms, 600ms, 2s, 10s, 29s, 30s}) {
    const netem::PathPlan path = path_with(netem::Change::Kind::Blackout, span);
    NetworkCouple couple{path, path, 1};
    const Watch watch = watch_over(span, couple);
    EXPECT_GE(watch.longest_gap, span - 1ms);
    EXPECT_LE(watch.longest_gap, std::min<Duration>(span + 2ms, 30s + 1ms));
    if (watch.worst == LinkState::Down) {
      EXPECT_EQ(span, Duration{30s});  // the gap was a little longer
      continue;
    }
    EXPECT_LE(watch.live_again, TimePoint{kWhen + span + 2 * kWay + 100ms}) << seconds(span);
    EXPECT_EQ(couple.surgeon.health.state, LinkState::Live);
    EXPECT_EQ(couple.patient.health.state, LinkState::Live);
    const auto lost = static_cast<std::uint64_t>(span / 1ms);
    EXPECT_NEAR(static_cast<double>(couple.patient.health.lost), static_cast<double>(lost), 2);
  }
}

TEST(NetworkTest, AfterFortySecondsTheSessionIsOverAndTheNextOneIsClean) {
  const netem::PathPlan path = path_with(netem::Change::Kind::Blackout, 40s);
  NetworkCouple couple{path, path, 1};
  couple.surgeon.telegram.site.epoch = 7;
  watch_over(40s, couple);
  for (NetworkCouple::Side* side : {&couple.surgeon, &couple.patient}) {
    EXPECT_EQ(side->health.session_id, 0U);
    side->look = nullptr;
  }
  const LinkHealth before = couple.patient.health;
  couple.surgeon.telegram.site.epoch = 0;
  std::vector<std::uint64_t> numbers;
  couple.connect(2);
  couple.patient.look = [&](const Arrivals& arrivals) {
    for (const Incoming& one : arrivals.samples) numbers.push_back(one.number);
    EXPECT_EQ(arrivals.peer.epoch, 0U);
  };
  couple.run(1s);
  EXPECT_EQ(couple.patient.health.state, LinkState::Live);
  EXPECT_EQ(couple.surgeon.health.state, LinkState::Live);
  ASSERT_FALSE(numbers.empty());
  EXPECT_EQ(numbers.front(), 0U);
  EXPECT_EQ(couple.patient.health.forged, before.forged);
}

TEST(NetworkTest, WhatAStallHeldBackIsNeverTakenForFresh) {
  for (const Duration span : std::initializer_list<Duration>{150ms, 250ms, 600ms, 2s}) {
    const netem::PathPlan path = path_with(netem::Change::Kind::Stall, span);
    NetworkCouple couple{path, path, 1};
    const Watch watch = watch_over(span, couple);
    EXPECT_GE(watch.longest_gap, span - 1ms);
    EXPECT_LE(watch.live_again, TimePoint{kWhen + span + 2 * kWay + 100ms}) << seconds(span);
    const auto held_too_long =
        static_cast<double>(std::max<Duration>(Duration{}, span - 200ms) / 1ms);
    EXPECT_NEAR(static_cast<double>(couple.patient.health.stale), held_too_long, 3);
  }
}

TEST(NetworkTest, TheClockLeansToNeitherSideWhereBothWaysAreAlike) {
  // A busy wireless network: telegrams wait for their slot and come in bunches, in both directions.
  const netem::PathPlan way{
      .impairment = netem::impaired(
          "delay 2ms 1ms distribution lognormal correlation-time 20ms slot 1ms 10ms")};
  constexpr int kLinks = 12;
  double sum = 0;      // [s], of the errors
  double squares = 0;  // [s^2]
  for (std::uint64_t seed = 1; seed <= kLinks; ++seed) {
    NetworkCouple couple{way, way, seed};
    couple.run(20s);
    const double error = seconds(couple.surgeon.health.peer_clock->offset_at(couple.now));
    sum += error;
    squares += error * error;
  }
  const double spread = std::sqrt(squares / kLinks);
  EXPECT_LE(spread, 100e-6);
  EXPECT_LE(std::abs(sum / kLinks), 3 * spread / std::sqrt(kLinks));
}

}  // namespace
}  // namespace palp::link
