#include "patient_site/devices/scan_card.h"

#include <gtest/gtest.h>

#include "patient_site/devices/card_calibration.h"
#include "tests/patient_site/devices/card_bench.h"

namespace palp::patient {
namespace {

using fake_hid::Bytes;
using fake_hid::bytes_of;

class ScanCardTest : public CardBench {};

TEST_F(ScanCardTest, AsksForItsCalibrationThenSamplesWithoutEnd) {
  (void)step();
  const auto& written = raw_[0]->written;
  ASSERT_EQ(written.size(), 8U);
  EXPECT_EQ(written[0], bytes_of("12"));
  EXPECT_EQ(written[1], bytes_of("30 90 00 00 04"));
  EXPECT_EQ(written[2], bytes_of("30 80 00 00 04"));
  EXPECT_EQ(written[6], bytes_of("13 00 00 00 00 00 00 00 00"));
  EXPECT_EQ(written[7], bytes_of("11 00 00 00 00 00 00 00 43 01 04"));
  card_->stop();
  EXPECT_EQ(written.back(), bytes_of("12"));
}

TEST_F(ScanCardTest, TaresInQuietAirAndThenFeels) {
  EXPECT_EQ(run(10, 0x8010).state, CardState::Starting);
  EXPECT_EQ(run(30, 0x8010).state, CardState::Ready);
  const CardReading pressed = run(1, 0x8010 + 3277);  // 1 V
  EXPECT_NEAR(pressed.force, 5, 0.01);
  EXPECT_NEAR(pressed.volts, 1.005, 0.002);
  EXPECT_EQ(pressed.starts, 1U);
}

TEST_F(ScanCardTest, PacketsOfSixInterfacesAreOrderedAndGapsCounted) {
  (void)run(50, 0x8000);
  for (int i = 0; i < 12; ++i) packet(0x8000);
  CardReading reading = step();
  EXPECT_EQ(reading.lost, 0U);
  EXPECT_EQ(reading.packets, 62U);
  index_ = static_cast<std::uint16_t>(index_ + 5);
  reading = run(1, 0x8000);
  EXPECT_EQ(reading.lost, 5U);
  EXPECT_EQ(reading.broken, 0U);
}

TEST_F(ScanCardTest, ItsIndexMayPassItsEnd) {
  index_ = 65'500;
  EXPECT_EQ(run(100, 0x8000).lost, 0U);
}

TEST_F(ScanCardTest, ALatePacketIsNoLoss) {
  (void)run(12, 0x8000);
  packet(0x8000);
  const Bytes late = std::move(raw_[1]->input.front());
  raw_[1]->input.pop_front();
  packet(0x8000);
  EXPECT_EQ(step().lost, 1U);
  raw_[1]->input.push_back(late);
  const CardReading reading = step();
  EXPECT_EQ(reading.lost, 0U);
  EXPECT_EQ(reading.packets, 14U);
}

TEST_F(ScanCardTest, PacketsOfAnOlderScanDoNotKeepItFromItsOwn) {
  index_ = 3000;
  for (int i = 0; i < 20; ++i) packet(0x8000);  // left in the kernel by who was here before
  (void)step();
  index_ = 0;
  const CardReading reading = run(60, 0x8000);
  EXPECT_EQ(reading.state, CardState::Ready) << reading.why;
  EXPECT_LE(reading.broken, 3U);
  EXPECT_EQ(reading.lost, 0U);
}

TEST_F(ScanCardTest, StuckSaturatedAndTouchedAreSeen) {
  (void)run(50, 0x8000);
  EXPECT_TRUE(run(1, 0xFFF0).saturated);
  EXPECT_FALSE(run(1, 0x8000).saturated);
  const CardReading stuck = run(5, 0x8000, 0);
  EXPECT_EQ(stuck.state, CardState::Fault);
  EXPECT_EQ(stuck.why, "the reading is stuck");
  ++asks_.restarts;
  EXPECT_EQ(run(50, 0x8000).state, CardState::Ready);
}

TEST_F(ScanCardTest, AResetKeepsTheZeroAndOnlyItEndsAFault) {
  (void)run(50, 0x8000);
  ASSERT_EQ(run(5, 0x8000 + 200, 0).state, CardState::Fault);
  for (auto* one : raw_) one->there = false;
  ASSERT_EQ(step().state, CardState::Absent);
  for (auto* one : raw_) one->there = true;
  for (int i = 0; i < 501; ++i) (void)step();
  CardReading reading = run(50, 0x8000 + 200);
  EXPECT_EQ(reading.state, CardState::Fault) << "no cable ends it";
  EXPECT_EQ(reading.why, "the reading is stuck");
  ++asks_.restarts;
  reading = run(50, 0x8000 + 200);
  EXPECT_EQ(reading.state, CardState::Ready) << reading.why;
  EXPECT_NEAR(reading.force, 0.3, 0.01) << "the tip may press";
}

TEST_F(ScanCardTest, WhatTouchesAtTheStartIsNoTare) {
  EXPECT_EQ(run(50, 0x8000 + 1000).why, "the tare was refused: something touches the sensor");
}

TEST_F(ScanCardTest, AReadingAtTheEndOfItsRangeIsNoTare) {
  EXPECT_EQ(run(50, 0xFFF0).why, "the reading is at the end of its range");
}

TEST_F(ScanCardTest, ATareThatIsAskedForIsTakenOrRefusedAndTheOldOneHoldsMeanwhile) {
  (void)run(50, 0x8000);
  ++asks_.tares;
  CardReading reading = run(5, 0x8000 + 33);  // 10 mV, 50 mN
  EXPECT_NEAR(reading.force, 0.05, 2e-3) << "it is under way";
  reading = run(50, 0x8000 + 33);
  EXPECT_EQ(reading.tare.taken, 1U);
  EXPECT_NEAR(reading.tare.moved, 0.05, 2e-3);
  EXPECT_NEAR(reading.force, 0, 2e-3);
  ++asks_.tares;
  reading = run(50, 0x8000 + 1000);
  EXPECT_EQ(reading.state, CardState::Ready);
  EXPECT_EQ(reading.tare.refused, 1U);
  EXPECT_NEAR(reading.force, 1.47, 0.01) << "against the old zero";
}

TEST_F(ScanCardTest, ATareThatTheTipOrAGapOvertakesIsGivenUp) {
  (void)run(50, 0x8000);
  ++asks_.tares;
  (void)run(1, 0x8000);
  asks_.may_touch = true;
  CardReading reading = run(50, 0x8000 + 200);  // 0.3 N, a light touch
  EXPECT_EQ(reading.tare.refused, 1U);
  EXPECT_NEAR(reading.force, 0.3, 0.01) << "against the old zero";
  asks_.may_touch = false;
  ++asks_.tares;
  (void)run(1, 0x8000);
  for (int i = 0; i < 7; ++i) reading = step();
  ASSERT_EQ(reading.state, CardState::Absent);
  ++asks_.tares;
  EXPECT_EQ(step().tare.refused, 3U) << "the one under way, and another";
  for (int i = 0; i < 501; ++i) (void)step();
  reading = run(50, 0x8000 + 200);
  EXPECT_EQ(reading.tare.taken, 0U);
  EXPECT_NEAR(reading.force, 0.3, 0.01) << "it came back pressed";
}

TEST_F(ScanCardTest, SilenceAndUnpluggingMakeItAbsentAndItComesBackWithItsTare) {
  (void)run(50, 0x8100);
  CardReading reading;
  for (int i = 0; i < 7; ++i) reading = step();
  EXPECT_EQ(reading.why, "it fell silent");
  for (auto* one : raw_) one->there = false;
  for (int i = 0; i < 600; ++i) reading = step();
  EXPECT_EQ(reading.why, "cannot be opened");
  for (auto* one : raw_) one->there = true;
  for (int i = 0; i < 501; ++i) reading = step();
  reading = run(5, 0x8100 + 3277);
  EXPECT_EQ(reading.state, CardState::Ready);
  EXPECT_NEAR(reading.force, 5, 0.01) << "it may be pressed: no new tare";
}

TEST_F(ScanCardTest, WithoutItsCalibrationItIsNotUsed) {
  raw_[0]->on_write = [](const Bytes&) {};
  EXPECT_EQ(step().why, "its calibration cannot be read");
  EXPECT_FALSE(raw_[0]->open);
}

TEST_F(ScanCardTest, OnlyWholePacketsCount) {
  (void)run(50, 0x8000);
  raw_[2]->input.push_back(Bytes(7, 1));
  raw_[2]->input.push_back(Bytes(80, 1));
  EXPECT_EQ(run(1, 0x8000).broken, 2U);
}

TEST(CardCalibrationTest, LineThroughThreeReferencesAndThroughTwo) {
  const CardRange& ten = card_ranges()[0];
  EXPECT_DOUBLE_EQ(target_of(5, ten), 0xC000);
  EXPECT_DOUBLE_EQ(volts_of(0x8000, ten), 0);
  EXPECT_DOUBLE_EQ(volts_of(0x8000 + 0x7FFF, ten), 10);
  EXPECT_DOUBLE_EQ(volts_of(0x8000 + 0x7FFF, card_ranges()[7]), 0.3125);
  CardReferences three{.ground_x = 100,
                       .ground_y = 210,
                       .plus_x = 200,
                       .plus_y = 410,
                       .minus_x = 0.0,
                       .minus_y = 10};
  const auto line = line_through(three);
  ASSERT_TRUE(line);
  EXPECT_NEAR(line->slope, 2, 1e-12);
  EXPECT_NEAR(line->offset, 10, 1e-9);
  three.minus_x.reset();
  const auto two = line_through(three);
  ASSERT_TRUE(two);
  EXPECT_NEAR(two->slope, 2, 1e-12);
  EXPECT_NEAR(two->offset, 10, 1e-9);
  three.plus_x = three.ground_x;
  EXPECT_FALSE(line_through(three));
}

}  // namespace
}  // namespace palp::patient
