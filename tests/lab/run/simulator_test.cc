#include "lab/run/simulator.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace palp::lab {
namespace {

using std::chrono::milliseconds;

TEST(WorldTest, RunsTickersInDueOrderAndTiesInOrderOfRegistration) {
  Simulator world;
  const TimePoint start = world.now();
  std::string order;
  world.every({.period = milliseconds{2}}, [&](TimePoint) { order += 'a'; });
  world.every({.period = milliseconds{1}}, [&](TimePoint) { order += 'b'; });
  world.every({.period = milliseconds{2}, .phase = milliseconds{1}},
              [&](TimePoint) { order += 'c'; });
  world.run_for(milliseconds{4});
  EXPECT_EQ(order, "abbcabbc");
  EXPECT_EQ(world.now() - start, milliseconds{4});
}

TEST(WorldTest, EachTickIsToldTheTimeAtWhichItIsDue) {
  Simulator world;
  const TimePoint start = world.now();
  std::vector<Duration> seen;
  world.every({.period = milliseconds{3}, .phase = milliseconds{1}}, [&](TimePoint now) {
    EXPECT_EQ(now, world.now());
    seen.push_back(now - start);
  });
  world.run_for(milliseconds{8});
  EXPECT_EQ(seen, (std::vector<Duration>{milliseconds{1}, milliseconds{4}, milliseconds{7}}));
}

TEST(WorldTest, TwoHalvesRunLikeOneWhole) {
  const auto run = [](int pieces) {
    Simulator world;
    std::vector<TimePoint> seen;
    world.every({.period = milliseconds{3}}, [&](TimePoint now) { seen.push_back(now); });
    for (int k = 0; k < pieces; ++k) world.run_for(milliseconds{60} / pieces);
    return seen;
  };
  EXPECT_EQ(run(1), run(2));
  EXPECT_EQ(run(1), run(60));
}

}  // namespace
}  // namespace palp::lab
