#include "surgeon_site/devices/force_feedback_board.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/surgeon_site/devices/hid_bench.h"

namespace palp::surgeon {
namespace {

using fake_hid::Bytes;
using fake_hid::bytes_of;

constexpr unsigned kFit = 0x0E;  // actuators on, safety switch closed, power

MasterInstallation built_in() {
  MasterInstallation made;
  made.position_unit = 1e-6;
  made.force_unit = 1e-3;
  made.force_max = 3;
  made.silence = std::chrono::milliseconds{200};
  return made;
}

Bytes axes_bytes(std::int16_t position, bool pedal, std::size_t length = 25) {
  Bytes bytes(length);
  bytes[0] = 0x01;
  bytes[1] = pedal ? 1 : 0;
  const auto counts = static_cast<std::uint16_t>(position);
  const std::size_t at = length > 25 ? 11 : 9;  // of 32 bits: the upper half
  bytes[at] = static_cast<std::uint8_t>(counts & 0xFFU);
  bytes[at + 1] = static_cast<std::uint8_t>(counts >> 8U);
  return bytes;
}

class ForceFeedbackBoardTest : public testing::Test {
 protected:
  ForceFeedbackBoardTest()
      : bench_{std::make_unique<ForceFeedbackBoard>(0, AnswerButtons{{5, 63}}),
               ForceFeedbackBoard::address(),
               built_in()} {
    fake_hid::Device made;
    made.path = "board";
    made.vendor = 0x1209;
    made.product = 0xFFB0;
    made.interface_number = 2;
    raw_ = &fake_hid::plug(made);
    raw_->feature = [this](std::uint8_t id) {
      return id == 0x12 ? Bytes{0x12, block_, load_, 0, 0} : Bytes{};
    };
  }
  MasterReading step(double force = 0) {
    raw_->input.push_back(axes_bytes(position_, true));
    raw_->input.push_back({0x02, static_cast<std::uint8_t>(state_)});
    return bench_.step(force);
  }
  MasterReading until_ready() {
    MasterReading reading;
    for (int i = 0; i < 20 && reading.state != MasterState::Ready; ++i) reading = step();
    return reading;
  }

  MasterBench bench_;
  fake_hid::Device* raw_{};
  std::int16_t position_{};
  unsigned state_{kFit};
  std::uint8_t block_{1};
  std::uint8_t load_{1};
};

TEST_F(ForceFeedbackBoardTest, StartsAsItsFirmwareWantsIt) {
  ASSERT_EQ(until_ready().state, MasterState::Ready);
  ASSERT_GE(raw_->written.size(), 6U);
  EXPECT_EQ(raw_->written[0], bytes_of("0C 08"));
  EXPECT_EQ(raw_->written[1], bytes_of("0C 01"));
  EXPECT_EQ(raw_->written[2], bytes_of("0D FF"));
  EXPECT_EQ(raw_->features, std::vector<Bytes>{bytes_of("11 01 00 00")});
  EXPECT_EQ(raw_->written[3], bytes_of("01 01 01 64 00 00 00 00 00 00 00 FF FF 03 28 23 00 00"));
  EXPECT_EQ(raw_->written[4], bytes_of("0A 01 01 01"));
  EXPECT_EQ(raw_->written[5],
            bytes_of("A1 01 01 0A 00 0E 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00"));
}

TEST_F(ForceFeedbackBoardTest, WhatItsOwnProtocolSaysIsASignOfLifeAndNoPlace) {
  const MasterReading before = until_ready();
  raw_->input.push_back(
      bytes_of("A1 0A 01 0A 00 0E 00 00 00 FF FF 00 00 00 00 00 00 00 00 00 00 00 00 00 00"));
  const MasterReading after = bench_.step();
  EXPECT_EQ(after.number, before.number + 1);
  EXPECT_EQ(after.position, before.position);
}

TEST_F(ForceFeedbackBoardTest, WritesItsForceAndBeginsTheEffectAgainBeforeItEnds) {
  (void)until_ready();
  raw_->written.clear();
  (void)step(-1.234);
  EXPECT_EQ(raw_->written.front(), bytes_of("05 01 2E FB"));
  raw_->written.clear();
  for (int i = 0; i < 1000; ++i) (void)step(1);
  const auto starts =
      std::count(raw_->written.begin(), raw_->written.end(), bytes_of("0A 01 01 01"));
  EXPECT_NEAR(static_cast<double>(starts), 25, 1);
  EXPECT_EQ(raw_->written.size(), 1000U + static_cast<std::size_t>(starts));
}

TEST_F(ForceFeedbackBoardTest, WhoSaysNothingMoreLetsTheEffectEnd) {
  (void)until_ready();
  (void)step(1);
  for (int i = 0; i < 30; ++i) {
    raw_->input.push_back(axes_bytes(0, true));
    (void)bench_.step_unheard();
  }
  raw_->written.clear();
  for (int i = 0; i < 200; ++i) {
    raw_->input.push_back(axes_bytes(0, true));
    (void)bench_.step_unheard();
  }
  for (const Bytes& one : raw_->written) EXPECT_EQ(one, bytes_of("05 01 00 00"));
}

TEST_F(ForceFeedbackBoardTest, AStillHandleIsNotSilentAndAQuarterSecondIs) {
  (void)until_ready();
  MasterReading reading;
  for (int i = 0; i < 1000; ++i) {
    if (i % 100 == 0) raw_->input.push_back(axes_bytes(0, false));
    reading = bench_.step();
    ASSERT_EQ(reading.state, MasterState::Ready) << i;
  }
  for (int i = 0; i < 250; ++i) reading = bench_.step();
  EXPECT_EQ(reading.why, "it fell silent");
}

TEST_F(ForceFeedbackBoardTest, AnyOfItsButtonsMayAnswer) {
  EXPECT_EQ(until_ready().answers, 0U) << "the pedal is held, and is no answer";
  Bytes first = axes_bytes(0, true);
  first[1] |= 1U << 5U;
  Bytes second = axes_bytes(0, true);
  second[8] = 0x80;
  raw_->input.push_back(first);
  EXPECT_EQ(bench_.step().answer, 1U);
  raw_->input.push_back(second);
  const MasterReading reading = bench_.step();
  EXPECT_EQ(reading.answer, 2U);
  EXPECT_EQ(reading.answers, 2U);
  EXPECT_TRUE(reading.pedal_held);
}

TEST_F(ForceFeedbackBoardTest, PositionAndPedalOfBothBuilds) {
  (void)until_ready();
  for (int i = 0; i < 100; ++i) {
    position_ = static_cast<std::int16_t>(position_ - 20);
    (void)step();
  }
  const MasterReading moved = step();
  EXPECT_NEAR(moved.position, -2e-3, 1e-9);
  EXPECT_TRUE(moved.pedal_held);
  EXPECT_NEAR(moved.velocity, -20e-3, 8e-3);
  raw_->input.push_back(axes_bytes(position_, false, 27));
  const MasterReading wide = bench_.step();
  EXPECT_NEAR(wide.position, -2e-3, 2e-6);
  EXPECT_FALSE(wide.pedal_held);
  raw_->input.push_back(axes_bytes(position_, false, 26));
  EXPECT_EQ(bench_.step().broken, wide.broken + 1);
}

TEST_F(ForceFeedbackBoardTest, AFullPoolIsResetAndThenSaid) {
  load_ = 2;
  MasterReading reading;
  for (int i = 0; i < 40; ++i) reading = step();
  EXPECT_EQ(reading.state, MasterState::Fault);
  EXPECT_EQ(reading.why, "its effect pool is full, also after a reset: another program uses it");
  EXPECT_EQ(std::count(raw_->written.begin(), raw_->written.end(), bytes_of("0C 08")), 3);
  load_ = 1;
  ++bench_.command.restarts;
  EXPECT_EQ(until_ready().state, MasterState::Ready);
}

TEST_F(ForceFeedbackBoardTest, AnErrorOfTheLoadAndARefusedRequestAreFaults) {
  load_ = 3;
  MasterReading reading;
  for (int i = 0; i < 40; ++i) reading = step();
  EXPECT_EQ(reading.why, "it could not make an effect");
  raw_->writable = false;
  ++bench_.command.restarts;
  EXPECT_EQ(step().why, "a request of its start was refused");
}

TEST_F(ForceFeedbackBoardTest, EmergencyStopAndPowerAreConditions) {
  (void)until_ready();
  state_ = kFit & ~4U;
  const MasterReading stopped = step(1);
  EXPECT_EQ(stopped.why, "emergency stop");
  EXPECT_TRUE(stopped.emergency_stop);
  EXPECT_EQ(raw_->written.back(), bytes_of("05 01 00 00"));
  state_ = kFit & ~8U;
  ++bench_.command.restarts;
  MasterReading reading;
  for (int i = 0; i < 1100; ++i) reading = step(1);
  EXPECT_EQ(reading.why, "the actuator has no power");
}

TEST_F(ForceFeedbackBoardTest, OnTheWayOutItsMotorIsOff) {
  (void)until_ready();
  (void)step(1);
  raw_->written.clear();
  bench_.device.stop();
  EXPECT_EQ(raw_->written,
            (std::vector<Bytes>{bytes_of("05 01 00 00"), bytes_of("0C 04"), bytes_of("0C 02")}));
}

}  // namespace
}  // namespace palp::surgeon
