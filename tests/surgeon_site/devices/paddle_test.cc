#include "surgeon_site/devices/paddle.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "surgeon_site/devices/firmware/paddle/paddle_report.h"
#include "surgeon_site/devices/master_device.h"
#include "surgeon_site/devices/master_protocol.h"
#include "tests/surgeon_site/devices/hid_bench.h"

namespace palp::surgeon {
namespace {

using fake_hid::Bytes;
using std::chrono::milliseconds;

MasterInstallation built_in() {
  MasterInstallation made;
  made.position_unit = Paddle::kPositionUnit;
  made.force_unit = Paddle::kForceUnit;
  made.force_max = 3;
  made.silence = milliseconds{5};
  return made;
}

Bytes state_bytes(const palp_paddle::State& state) {
  Bytes bytes(palp_paddle::kReportBytes);
  palp_paddle::pack(state, bytes.data());
  return bytes;
}

class PaddleTest : public testing::Test {
 protected:
  explicit PaddleTest(const MasterInstallation& installation = built_in())
      : bench_{std::make_unique<Paddle>(), Paddle::address(), installation} {
    fake_hid::Device made;
    made.path = "paddle";
    made.vendor = 0x16C0;
    made.product = 0x0486;
    made.usage_page = 0xFFAB;
    raw_ = &fake_hid::plug(made);
    state_.flags = palp_paddle::kStateCalibrated;
  }
  void report() {
    ++state_.sequence;
    raw_->input.push_back(state_bytes(state_));
  }
  MasterReading step(double force = 0) {
    report();
    return bench_.step(force);
  }
  palp_paddle::Command last() {
    palp_paddle::Command command{};
    const Bytes& bytes = raw_->written.back();
    EXPECT_EQ(bytes.size(), 65U);
    EXPECT_EQ(bytes[0], 0);
    EXPECT_TRUE(palp_paddle::unpack(bytes.data() + 1, bytes.size() - 1, command));
    return command;
  }

  MasterBench bench_;
  fake_hid::Device* raw_{};
  palp_paddle::State state_{};
};

TEST_F(PaddleTest, IsReadyWithItsFirstReportAndGivesForce) {
  state_.position_nm = -2'000'000;
  state_.velocity_um_per_s = 50'000;
  state_.flags |= palp_paddle::kStatePedalHeld;
  EXPECT_EQ(step().state, MasterState::Ready);
  const MasterReading reading = step(-1.5);
  EXPECT_DOUBLE_EQ(reading.position, -2e-3);
  EXPECT_DOUBLE_EQ(reading.velocity, 50e-3);
  EXPECT_TRUE(reading.pedal_held);
  EXPECT_EQ(last().force_un, -1'500'000);
  EXPECT_EQ(last().valid_for_ms, 20);
  EXPECT_EQ(last().flags, palp_paddle::kCommandEnable);
  bench_.command.engaged = true;
  (void)step();
  EXPECT_EQ(last().flags, palp_paddle::kCommandEnable | palp_paddle::kCommandLamp);
}

TEST_F(PaddleTest, AnOldCommandIsNoForce) {
  (void)step();
  EXPECT_DOUBLE_EQ(step(2).force, 2);
  for (int i = 0; i < 20; ++i) {
    report();
    EXPECT_DOUBLE_EQ(bench_.step_unheard().force, 2);
  }
  report();
  EXPECT_DOUBLE_EQ(bench_.step_unheard().force, 0);
  EXPECT_EQ(last().force_un, 0);
  EXPECT_EQ(last().valid_for_ms, 0);
}

TEST_F(PaddleTest, ForceIsWithinItsLimitsAndANumber) {
  (void)step();
  EXPECT_DOUBLE_EQ(step(50).force, 3);
  EXPECT_DOUBLE_EQ(step(-50).force, -3);
  EXPECT_EQ(last().force_un, -3'000'000);
  (void)step(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(last().force_un, 0);
}

TEST_F(PaddleTest, NewestOfManyReportsCountsAndGapsAreSeen) {
  (void)step();
  for (int i = 0; i < 1000; ++i) {
    state_.position_nm = i;
    report();
  }
  state_.sequence = static_cast<std::uint16_t>(state_.sequence + 3);
  const MasterReading reading = step();
  EXPECT_NEAR(reading.position, 999e-9, 1e-15);
  EXPECT_EQ(reading.skipped, 1000U);
  EXPECT_EQ(reading.lost, 3U);
}

TEST_F(PaddleTest, WhatIsNoReportOfItsIsCountedAndNothingElse) {
  (void)step();
  raw_->input.push_back(Bytes(64, 0xFF));
  raw_->input.push_back(Bytes(7, 1));
  EXPECT_EQ(bench_.step().broken, 2U);
}

TEST_F(PaddleTest, SilenceIsAFaultAndItComesBackByItself) {
  (void)step(1);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(bench_.step(1).state, MasterState::Ready);
  const MasterReading silent = bench_.step(1);
  EXPECT_EQ(silent.state, MasterState::Absent);
  EXPECT_EQ(silent.why, "it fell silent");
  EXPECT_EQ(last().valid_for_ms, 0);
  for (int i = 0; i < 500; ++i) (void)bench_.step(1);
  EXPECT_EQ(step().state, MasterState::Ready);
  EXPECT_EQ(step().starts, 2U);
}

TEST_F(PaddleTest, UnpluggedItIsAbsentAtOnce) {
  (void)step(1);
  raw_->there = false;
  const MasterReading gone = bench_.step(1);
  EXPECT_EQ(gone.state, MasterState::Absent);
  EXPECT_DOUBLE_EQ(gone.force, 0);
  EXPECT_FALSE(gone.pedal_held);
}

TEST_F(PaddleTest, EmergencyStopStaysAFaultUntilAPersonRestarts) {
  (void)step(1);
  state_.flags |= palp_paddle::kStateEmergencyStop;
  const MasterReading stopped = step(1);
  EXPECT_EQ(stopped.state, MasterState::Fault);
  EXPECT_EQ(stopped.why, "emergency stop");
  EXPECT_TRUE(stopped.emergency_stop);
  EXPECT_EQ(last().force_un, 0);
  state_.flags = palp_paddle::kStateCalibrated;
  EXPECT_EQ(step(1).state, MasterState::Fault);
  ++bench_.command.restarts;
  EXPECT_EQ(step(1).state, MasterState::Ready);
}

TEST_F(PaddleTest, ItsFirmwareIsCalibratedOrItGivesNoForce) {
  state_.flags = 0;
  MasterReading reading;
  for (int i = 0; i < 1100; ++i) reading = step(1);
  EXPECT_EQ(reading.state, MasterState::Fault);
  EXPECT_EQ(reading.why, "its firmware is not calibrated");
}

TEST_F(PaddleTest, APositionThatNoHandReachesIsAFault) {
  (void)step();
  state_.position_nm = -30'000'000;
  EXPECT_EQ(step(1).why, "the position jumped");
  EXPECT_EQ(last().force_un, 0);
}

TEST_F(PaddleTest, OutsideItsTravelIsAFault) {
  (void)step();
  MasterReading reading;
  for (int i = 0; i < 30; ++i) {
    state_.position_nm += 1'000'000;
    reading = step();
  }
  EXPECT_EQ(reading.why, "the position is outside its travel");
}

TEST_F(PaddleTest, OnTheWayOutItTakesTheForceAway) {
  (void)step(2);
  bench_.device.stop();
  EXPECT_EQ(last().force_un, 0);
  EXPECT_EQ(last().valid_for_ms, 0);
}

class UncalibratedTest : public PaddleTest {
 protected:
  static MasterInstallation without_force() {
    MasterInstallation made = built_in();
    made.force_unit = 0;
    return made;
  }
  UncalibratedTest() : PaddleTest{without_force()} {}
};

TEST_F(UncalibratedTest, WithoutAUnitOfForceThereIsNone) {
  (void)step();
  EXPECT_DOUBLE_EQ(step(2).force, 0);
  EXPECT_EQ(last().force_un, 0);
  EXPECT_EQ(last().flags, 0);
}

}  // namespace
}  // namespace palp::surgeon
