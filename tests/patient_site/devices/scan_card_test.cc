#include "patient_site/devices/scan_card.h"

#include <bit>
#include <map>

#include <gtest/gtest.h>

#include "common/core/random.h"
#include "common/io/device/hid_port.h"
#include "patient_site/devices/card_calibration.h"
#include "tests/common/io/device/fake_hidapi.h"
#include "tests/patient_site/devices/fake_registers.h"

namespace palp::patient {
namespace {

using fake_hid::Bytes;
using fake_hid::bytes_of;
using std::chrono::milliseconds;

CardInstallation built_in() {
  CardInstallation made;
  made.newtons_per_volt = 5;
  made.load.tare_time = milliseconds{20};
  return made;
}

class ScanCardTest : public testing::Test {
 protected:
  ScanCardTest() {
    for (int i = 0; i < 7; ++i) {
      fake_hid::Device made;
      made.path = "card" + std::to_string(i);
      made.vendor = 0x09DB;
      made.product = 0x007D;
      made.interface_number = i;
      raw_.push_back(&fake_hid::plug(made));
      ports_.push_back(std::make_unique<io::HidPort>(ScanCard::address(i)));
    }
    remember(0x80, 5.0F);
    remember(0x90, 0.0F);
    remember(0xA0, -5.0F);
    for (int channel = 0; channel < 8; ++channel) {
      remember(0xB0 + 4 * channel, 0x8000);
      remember(0xB2 + 4 * channel, 0xC000);
      remember(0x130 + 2 * channel, 0x4000);
    }
    raw_[0]->on_write = [this](const Bytes& bytes) {
      if (bytes[0] != 0x30 || bytes.size() != 5) return;
      Bytes reply{0x30};
      for (int i = 0; i < bytes[4]; ++i) reply.push_back(memory_[bytes[1] + 256 * bytes[2] + i]);
      raw_[0]->input.push_back(reply);
    };
    ScanCard::Ports all{};
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = ports_[i].get();
    card_ = std::make_unique<ScanCard>(built_in(), all);
  }
  ~ScanCardTest() override {
    ports_.clear();
    fake_hid::clear();
  }
  void remember(int address, float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (int i = 0; i < 4; ++i) memory_[address + i] = static_cast<std::uint8_t>(bits >> (8 * i));
  }
  void remember(int address, int word) {
    memory_[address] = static_cast<std::uint8_t>(word & 0xFF);
    memory_[address + 1] = static_cast<std::uint8_t>(word >> 8);
  }
  /// A packet of samples around `raw`, as a quiet sensor gives them.
  void packet(int raw, int noise = 2) {
    Bytes bytes(64);
    for (std::size_t i = 0; i < 31; ++i) {
      const auto sample = static_cast<unsigned>(raw + (i % 2 == 0 ? noise : -noise) * (i < 30));
      bytes[2 * i] = static_cast<std::uint8_t>(sample & 0xFFU);
      bytes[2 * i + 1] = static_cast<std::uint8_t>(sample >> 8U);
    }
    bytes[62] = static_cast<std::uint8_t>(index_ & 0xFFU);
    bytes[63] = static_cast<std::uint8_t>(index_ >> 8U);
    raw_[1 + index_ % 6U]->input.push_back(bytes);
    ++index_;
  }
  CardReading step() {
    clock_.at += milliseconds{1};
    return card_->cycle(clock_, restarts_);
  }
  CardReading run(int steps, int raw, int noise = 2) {
    CardReading reading;
    for (int i = 0; i < steps; ++i) {
      packet(raw, noise);
      reading = step();
    }
    return reading;
  }

  TestClock clock_;
  std::vector<fake_hid::Device*> raw_;
  std::vector<std::unique_ptr<io::HidPort>> ports_;
  std::map<int, std::uint8_t> memory_;
  std::unique_ptr<ScanCard> card_;
  std::uint16_t index_{};
  std::uint32_t restarts_{};
};

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

TEST_F(ScanCardTest, StuckSaturatedAndTouchedAreSeen) {
  (void)run(50, 0x8000);
  EXPECT_TRUE(run(1, 0xFFF0).saturated);
  EXPECT_FALSE(run(1, 0x8000).saturated);
  const CardReading stuck = run(5, 0x8000, 0);
  EXPECT_EQ(stuck.state, CardState::Fault);
  EXPECT_EQ(stuck.why, "the reading is stuck");
  ++restarts_;
  EXPECT_EQ(run(50, 0x8000).state, CardState::Ready);
}

TEST_F(ScanCardTest, WhatTouchesAtTheStartIsNoTare) {
  EXPECT_EQ(run(50, 0x8000 + 1000).why, "the tare was refused: something touches the sensor");
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

TEST_F(ScanCardTest, NoSequenceOfFaultsGivesAForceThatIsNoNumber) {
  (void)run(50, 0x8000);
  for (std::uint64_t turn = 0; turn < 1000; ++turn) {
    const RandomStream stream{18, turn};
    std::uint64_t index = 0;
    const auto draw = [&](std::uint64_t count) { return stream.bits(index++) % count; };
    for (int i = 0; i < 8; ++i) {
      auto* const one = raw_[draw(7)];
      switch (draw(6)) {
        case 0:
          one->there = !one->there;
          break;
        case 1:
          one->input.push_back(Bytes(draw(70), static_cast<std::uint8_t>(draw(256))));
          break;
        case 2:
          index_ = static_cast<std::uint16_t>(draw(65'536));
          break;
        case 3:
          clock_.at += milliseconds{static_cast<int>(draw(600))};
          break;
        case 4:
          ++restarts_;
          break;
        default:
          break;
      }
      const CardReading reading = run(1, static_cast<int>(draw(65'000)) + 100);
      ASSERT_TRUE(std::isfinite(reading.force));
      ASSERT_LE(std::abs(reading.volts), 10.1);
    }
    for (auto* one : raw_) {
      one->there = true;
      one->input.clear();
    }
    raw_[0]->written.clear();
  }
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
