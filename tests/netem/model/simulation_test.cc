#include "netem/model/simulation.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "netem/model/occupancy.h"
#include "tests/netem/model/impairment_builders.h"
#include "tests/netem/model/impairment_generators.h"

namespace palp::netem {
namespace {

using std::chrono::milliseconds;

RC_GTEST_PROP(SimulationTest, SumsAreThoseOfTheDecisions, ()) {
  SimulationConfig config{.plan = {.impairment = make_impairment(milliseconds{100})},
                          .packets = 400,
                          .interval = milliseconds{1},
                          .burst = *rc::gen::inRange<std::uint64_t>(1, 4),
                          .seed = *rc::gen::arbitrary<std::uint64_t>()};
  if (*rc::gen::arbitrary<bool>()) {
    config.plan.impairment = *parse_impairment(
        "delay 20ms 15ms loss 5% duplicate 20% reorder 10% rate 1mbit limit 15", Mode::Netem61);
  }
  const SimulationResult sums = simulate(config);
  std::array<std::uint64_t, kVerdictCount> verdicts{};
  std::uint64_t copies = 0;
  const SimulationResult told = simulate(config, [&](const Decision& decision) {
    if (decision.copy == 0) ++verdicts[static_cast<std::size_t>(decision.verdict)];
    copies += decision.copy > 0 ? 1 : 0;
  });
  RC_ASSERT(verdicts == sums.verdicts);
  RC_ASSERT(copies == sums.copies);
  RC_ASSERT(told.reordered == sums.reordered);
  RC_ASSERT(told.delay.max() == sums.delay.max());
  RC_ASSERT(told.delay.mean() == sums.delay.mean());
}

TEST(OccupancyTest, CountsThoseWhoOvertake) {
  Occupancy occupancy{3};
  const auto at = [](int ms) { return TimePoint{milliseconds{ms}}; };
  occupancy.enter(at(50));
  occupancy.enter(at(10));
  occupancy.enter(at(20));
  EXPECT_EQ(occupancy.room(at(9), 1), 0U);
  EXPECT_EQ(occupancy.room(at(10), 1), 1U);
  EXPECT_EQ(occupancy.room(at(49), 3), 2U);
  EXPECT_EQ(occupancy.room(at(50), 3), 3U);
}

RC_GTEST_PROP(OccupancyTest, CountsAsIfEachWereLookedAt, ()) {
  const auto most = *rc::gen::inRange<std::size_t>(1, 40);
  Occupancy occupancy{most};
  std::vector<TimePoint> inside;
  TimePoint now{};
  const auto span = *rc::gen::inRange(1, 200);
  for (const int ahead : *rc::gen::container<std::vector<int>>(300, rc::gen::inRange(0, span))) {
    now += milliseconds{ahead % 7};
    std::erase_if(inside, [now](TimePoint release) { return release <= now; });
    const std::size_t room = most - inside.size();
    RC_ASSERT(occupancy.room(now, 2) == std::min<std::size_t>(room, 2));
    if (room == 0) continue;
    inside.push_back(now + milliseconds{ahead});
    occupancy.enter(now + milliseconds{ahead});
  }
}

}  // namespace
}  // namespace palp::netem
