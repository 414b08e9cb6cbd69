#include "lab/run/simulator.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace palp::lab {
namespace {

using std::chrono::milliseconds;

TEST(WorldTest, RunsTickersInDueOrderAndTiesInOrderOfRegistration) {
  Simulator simulator;
  const TimePoint start = simulator.now();
  std::string order;
  simulator.every({.period = milliseconds{2}}, [&](TimePoint) { order += 'a'; });
  simulator.every({.period = milliseconds{1}}, [&](TimePoint) { order += 'b'; });
  simulator.every({.period = milliseconds{2}, .phase = milliseconds{1}},
                  [&](TimePoint) { order += 'c'; });
  simulator.run_for(milliseconds{4});
  EXPECT_EQ(order, "abbcabbc");
  EXPECT_EQ(simulator.now() - start, milliseconds{4});
}

TEST(WorldTest, EachTickIsToldTheTimeAtWhichItIsDue) {
  Simulator simulator;
  const TimePoint start = simulator.now();
  std::vector<Duration> seen;
  simulator.every({.period = milliseconds{3}, .phase = milliseconds{1}}, [&](TimePoint now) {
    EXPECT_EQ(now, simulator.now());
    seen.push_back(now - start);
  });
  simulator.run_for(milliseconds{8});
  EXPECT_EQ(seen, (std::vector<Duration>{milliseconds{1}, milliseconds{4}, milliseconds{7}}));
}

TEST(WorldTest, TwoHalvesRunLikeOneWhole) {
  const auto run = [](int pieces) {
    Simulator simulator;
    std::vector<TimePoint> seen;
    simulator.every({.period = milliseconds{3}}, [&](TimePoint now) { seen.push_back(now); });
    for (int k = 0; k < pieces; ++k) simulator.run_for(milliseconds{60} / pieces);
    return seen;
  };
  EXPECT_EQ(run(1), run(2));
  EXPECT_EQ(run(1), run(60));
}

}  // namespace
}  // namespace palp::lab
