#include "surgeon_site/devices/firmware/paddle/paddle_report.h"

#include <array>

#include <gtest/gtest.h>

namespace palp_paddle {
namespace {

using Report = std::array<std::uint8_t, kReportBytes>;

Report report_of(std::initializer_list<int> head, int crc_low, int crc_high) {
  Report report{};
  std::size_t at = 0;
  for (const int byte : head) report.at(at++) = static_cast<std::uint8_t>(byte);
  report[kCrcAt] = static_cast<std::uint8_t>(crc_low);
  report[kCrcAt + 1] = static_cast<std::uint8_t>(crc_high);
  return report;
}

const Report kState = report_of({0x50, 0x50, 0x01, 0x01, 0xE8, 0x03, 0x03, 0x00, 0x40, 0x42, 0x0F,
                                 0x00, 0x4E, 0x61, 0xBC, 0x00, 0xB0, 0x3C, 0xFF, 0xFF, 0xFA},
                                0x0B,
                                0xB6);
const Report kCommand = report_of({0x50,
                                   0x50,
                                   0x01,
                                   0x02,
                                   0xE9,
                                   0x03,
                                   0x01,
                                   0x00,
                                   0x34,
                                   0x44,
                                   0x0F,
                                   0x00,
                                   0xA0,
                                   0x1C,
                                   0xE9,
                                   0xFF,
                                   0x14},
                                  0x9B,
                                  0xEB);

TEST(PaddleReportTest, ChecksumIsTheKnownOne) {
  const std::array<std::uint8_t, 9> digits{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(crc(digits.data(), digits.size()), 0x29B1);
}

TEST(PaddleReportTest, StateIsThatOfTheVector) {
  const State state{.sequence = 1000,
                    .flags = kStateCalibrated | kStateMotorEnabled,
                    .time_us = 1'000'000,
                    .position_nm = 12'345'678,
                    .velocity_um_per_s = -50'000,
                    .current_ma = 250,
                    .command_sequence = 0};
  Report report{};
  pack(state, report.data());
  EXPECT_EQ(report, kState);
  State back{};
  ASSERT_TRUE(unpack(kState.data(), kState.size(), back));
  EXPECT_EQ(back.sequence, 1000);
  EXPECT_EQ(back.flags, 3);
  EXPECT_EQ(back.time_us, 1'000'000U);
  EXPECT_EQ(back.position_nm, 12'345'678);
  EXPECT_EQ(back.velocity_um_per_s, -50'000);
  EXPECT_EQ(back.current_ma, 250);
  EXPECT_EQ(back.command_sequence, 0);
}

TEST(PaddleReportTest, CommandIsThatOfTheVector) {
  const Command command{.sequence = 1001,
                        .flags = kCommandEnable,
                        .time_us = 1'000'500,
                        .force_un = -1'500'000,
                        .valid_for_ms = 20};
  Report report{};
  pack(command, report.data());
  EXPECT_EQ(report, kCommand);
  Command back{};
  ASSERT_TRUE(unpack(kCommand.data(), kCommand.size(), back));
  EXPECT_EQ(back.sequence, 1001);
  EXPECT_EQ(back.force_un, -1'500'000);
  EXPECT_EQ(back.valid_for_ms, 20);
}

TEST(PaddleReportTest, AnyOtherBitIsNoReport) {
  State state{};
  for (std::size_t bit = 0; bit < 8 * kReportBytes; ++bit) {
    Report report = kState;
    report.at(bit / 8) = static_cast<std::uint8_t>(report.at(bit / 8) ^ (1U << (bit % 8)));
    EXPECT_FALSE(unpack(report.data(), report.size(), state)) << bit;
  }
  EXPECT_FALSE(unpack(kState.data(), 63, state));
  EXPECT_FALSE(unpack(kCommand.data(), kCommand.size(), state));
  Command command{};
  EXPECT_FALSE(unpack(kState.data(), kState.size(), command));
}

}  // namespace
}  // namespace palp_paddle
