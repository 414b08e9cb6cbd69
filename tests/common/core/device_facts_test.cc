#include "common/core/device_facts.h"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace palp {
namespace {

DeviceFacts all() { return {HandFacts{}, StageFacts{}, ForceSensorFacts{}}; }

TEST(DeviceFactsTest, TheSimulatedDevicesAreSound) {
  EXPECT_FALSE(flaw_of(all()));
  EXPECT_FALSE(flaw_of({})) << "what is not there has no flaw";
}

TEST(DeviceFactsTest, ANumberOutsideItsRangeIsNamedWithItsValueAndLimit) {
  DeviceFacts facts = all();
  facts.sensor->pole = -3;
  EXPECT_EQ(flaw_of(facts), "the force sensor's pole of -3 Hz is not 0.1 to 1e+05 Hz");
  facts = all();
  facts.stage->speed = 0;
  EXPECT_EQ(flaw_of(facts), "the stage's speed of 0 m/s is not above 0 and at most 100 m/s");
  facts = all();
  facts.hand->axes = 7;
  EXPECT_EQ(flaw_of(facts), "the hand's axes of 7 is not 1 to 6");
  facts = all();
  facts.sensor->yield = 0.02;
  EXPECT_EQ(flaw_of(facts), "the force sensor's yield of 0.02 m/N is not 0 to 0.01 m/N");
  facts.sensor->yield = -1e-6;
  EXPECT_EQ(flaw_of(facts), "the force sensor's yield of -1e-06 m/N is not 0 to 0.01 m/N");
}

/// Every number has both borders, and none lets through what is no number.
TEST(DeviceFactsTest, NoNumberIsLeftOut) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  DeviceFacts facts = all();
  const std::vector<double*> numbers{&facts.hand->force_peak,
                                     &facts.hand->force_continuous,
                                     &facts.hand->rate,
                                     &facts.stage->travel_min,
                                     &facts.stage->travel_max,
                                     &facts.stage->travel_side,
                                     &facts.stage->speed,
                                     &facts.stage->acceleration,
                                     &facts.stage->rate,
                                     &facts.stage->lag,
                                     &facts.sensor->pole,
                                     &facts.sensor->step,
                                     &facts.sensor->range,
                                     &facts.sensor->noise,
                                     &facts.sensor->rate,
                                     &facts.sensor->lag,
                                     &facts.sensor->yield};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    for (const double bad : {kNan, kInfinite, -kInfinite}) {
      const double good = std::exchange(*numbers[i], bad);
      EXPECT_TRUE(flaw_of(facts)) << i << ' ' << bad;
      *numbers[i] = good;
    }
  }
  EXPECT_FALSE(flaw_of(facts));
  facts.stage->travel_max = facts.stage->travel_min - 1e-3;
  EXPECT_TRUE(flaw_of(facts)) << "a travel the wrong way round";
  facts = all();
  facts.hand->force_continuous = 2 * facts.hand->force_peak;
  EXPECT_TRUE(flaw_of(facts));
}

TEST(DeviceFactsTest, PeopleReadThemInOneLine) {
  EXPECT_EQ(describe(HandFacts{}), "3 axes, 8.5 N, 1.4 N for ever, 1000 Hz, lag 0 s");
  EXPECT_EQ(describe(StageFacts{}),
            "3 axes, -0.2 to 0.2 m, +-0.25 m, 0.15 m/s, 8 m/s^2, 1000 Hz, lag 0.0143 s, drags");
  EXPECT_EQ(describe(ForceSensorFacts{}),
            "pole 20 Hz, steps of 0.05 N, range 49 N, noise 0.015 N rms, 1000 Hz, lag 0.008 s, "
            "yield 0 m/N");
}

}  // namespace
}  // namespace palp
