#include "common/coupling/late_device.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace palp::coupling {
namespace {

constexpr double kCutOff = 60;  // [Hz]

HandFacts hand(double rate, double lag) {
  HandFacts facts;
  facts.rate = rate;
  facts.lag = lag;
  return facts;
}

TEST(LateDeviceTest, OfTheUsualDeviceNothingIsAskedOtherwise) {
  LateDevice device{HandFacts{}, kCutOff};
  EXPECT_EQ(device.velocity_cut_off(), kCutOff);
  EXPECT_GT(device.damping_most(), 1e6);
  device.look(0, false, -1, 10);
  EXPECT_EQ(device.share(), 1);
}

TEST(LateDeviceTest, TheLaterItAnswersTheLessItDamps) {
  double before = 1e6;
  for (const double lag : {1e-3, 5e-3, 20e-3}) {
    const double most = LateDevice{hand(1000, lag), kCutOff}.damping_most();
    EXPECT_LT(most, before);
    before = most;
  }
  EXPECT_LT(LateDevice(hand(50, 0), kCutOff).damping_most(),
            LateDevice(hand(200, 0), kCutOff).damping_most());
}

TEST(LateDeviceTest, ASpringThatDrivesItsHandIsMadeSofterAndComesBackSlowly) {
  LateDevice device{hand(100, 0), kCutOff};
  for (int tick = 0; tick < 300; ++tick) device.look(0, true, -1e-6, 1e-3);
  const double soft = device.share();
  EXPECT_LT(soft, 0.06);
  for (int tick = 0; tick < 1000; ++tick) device.look(0, true, 1e-3, 1e-3);
  EXPECT_GT(device.share(), soft);
  EXPECT_LT(device.share(), soft + 0.02);
}

TEST(LateDeviceTest, ATankThatIsEmptyIsNotOverdrawn) {
  LateDevice device{hand(100, 0), kCutOff};
  for (int tick = 0; tick < 300; ++tick) device.look(0, true, -1e-16, 1e-3);
  EXPECT_EQ(device.share(), 1);
}

TEST(LateDeviceTest, ASpringThatSwingsItsHandIsMadeSofterBeforeTheTankIsEmpty) {
  constexpr double kTurn = 2 * std::numbers::pi;
  LateDevice late{hand(1000, 10e-3), kCutOff};
  LateDevice usual{HandFacts{}, kCutOff};
  for (int tick = 0; tick < 500; ++tick) {
    const double position = 0.4e-3 * std::sin(kTurn * 8 * 1e-3 * tick);
    late.look(position, true, 1e-3, 1e-3);
    usual.look(position, true, 1e-3, 1e-3);
  }
  EXPECT_LT(late.share(), 0.1);
  EXPECT_EQ(usual.share(), 1);
}

}  // namespace
}  // namespace palp::coupling
