#include "patient_site/devices/register_device.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "patient_site/devices/device_profile.h"
#include "patient_site/devices/device_reading.h"
#include "patient_site/devices/profile_texts.h"
#include "patient_site/settings_devices.h"
#include "tests/patient_site/devices/maker_axis.h"

namespace palp::patient {
namespace {

using io::PortFault;
using testing::HasSubstr;

TEST(RegisterDeviceTest, StartsAnAxisStepByStepAndHoldsItWhereItStands) {
  MakerAxis axis;
  axis.port.words[0x9001] = 3070;
  ASSERT_EQ(axis.cycles(20).state, DeviceState::Ready) << axis.why();
  EXPECT_TRUE(axis.port.coils[0x427]);
  EXPECT_TRUE(axis.port.coils[0x403]);
  EXPECT_FALSE(axis.port.coils.contains(0x40B)) << "it was homed";
  EXPECT_NEAR(axis.reading.position, 0.05 - 0.0307, 1e-9);
  EXPECT_EQ(axis.port.words[0x9901], 3070);
  EXPECT_EQ(axis.port.words[0x9905], 10'000) << "100 mm/s";
  EXPECT_EQ(axis.port.words[0x9906], 20) << "hundredths of g";
}

TEST(RegisterDeviceTest, MovesWithinSpeedTravelAndTime) {
  MakerAxis axis;
  axis.port.words[0x9001] = 5000;
  axis.cycles(20);
  axis.move(0.03);
  axis.cycles(100);
  EXPECT_NEAR(axis.reading.position, 0.03, 1e-5);
  EXPECT_EQ(axis.port.words[0x9901], 2000) << "against the site";
  EXPECT_LE(axis.fastest, 0.1 + 0.002);
  axis.move(5);
  axis.cycles(200);
  EXPECT_TRUE(axis.reading.at_limit);
  EXPECT_NEAR(axis.reading.position, 0.1, 1e-5);
}

TEST(RegisterDeviceTest, AnExpiredCommandStopsIt) {
  MakerAxis axis;
  axis.cycles(20);
  axis.move(-0.1);
  axis.cycles(10);
  axis.alive = false;
  axis.cycles(10);
  const double there = axis.reading.position;
  axis.cycles(50);
  EXPECT_EQ(axis.reading.position, there);
  EXPECT_GT(there, -0.05);
}

TEST(RegisterDeviceTest, WhoIsLeftAloneStopsWithinItsTravel) {
  for (int moving = 1; moving < 200; ++moving) {
    MakerAxis axis;
    axis.port.words[0x9001] = 5000;
    axis.cycles(20);
    axis.move(0.1);
    axis.cycles(moving);
    axis.alive = false;
    axis.cycles(20);
    ASSERT_LE(axis.reading.position, 0.1 + 1e-5) << moving;
  }
}

TEST(RegisterDeviceTest, AnEmergencyStopIsAFaultUntilRestarted) {
  MakerAxis axis;
  axis.cycles(20);
  axis.port.words[0x9005] = 0xB010;
  ASSERT_EQ(axis.cycles(1).state, DeviceState::Fault);
  EXPECT_EQ(axis.why(), "the device reports: emergency stop");
  EXPECT_TRUE(axis.port.coils[0x42C]) << "told to stop";
  axis.port.words[0x9005] = 0x3010;
  EXPECT_EQ(axis.cycles(100).state, DeviceState::Fault);
  ++axis.command.asks.restarts;
  EXPECT_EQ(axis.cycles(30).state, DeviceState::Ready) << axis.why();
}

TEST(RegisterDeviceTest, AWeightWithoutASignHasItsSignInABit) {
  MakerAxis cell{"tlb4"};
  ASSERT_EQ(cell.cycles(40).state, DeviceState::Ready) << cell.why();
  cell.port.words[8] = 30;
  EXPECT_NEAR(cell.cycles(1).force, 0.3, 1e-9);
  cell.port.words[6] = 0x0080;
  EXPECT_NEAR(cell.cycles(1).force, -0.3, 1e-9);
  cell.port.words[6] = 0x0001;
  EXPECT_EQ(cell.cycles(1).state, DeviceState::Fault);
  EXPECT_EQ(cell.why(), "the device reports: load cell error");
}

TEST(RegisterDeviceTest, TheDriveIsToldTheCeilingOfItsForce) {
  DeviceInstallation built_in = MakerAxis::installation();
  built_in.force_limit = 70;
  MakerAxis axis{"orca", built_in};
  ASSERT_EQ(axis.cycles(60).state, DeviceState::Ready) << axis.why();
  EXPECT_EQ(axis.port.words[140], 70'000 - 65'536) << "mN, the low word first";
  EXPECT_EQ(axis.port.words[141], 1);
}

TEST(RegisterDeviceTest, HomesOnlyWhereItMay) {
  MakerAxis axis;
  axis.port.words[0x9005] = 0x3000;
  ASSERT_EQ(axis.cycles(30).state, DeviceState::Fault);
  EXPECT_THAT(axis.why(), HasSubstr("may_home does not permit: home"));
  EXPECT_FALSE(axis.port.coils[0x40B]);
}

TEST(RegisterDeviceTest, AFewLostAnswersAreNoFaultAndSilenceIs) {
  MakerAxis axis;
  axis.cycles(20);
  axis.port.fault = PortFault::NoReply;
  EXPECT_EQ(axis.cycles(1).state, DeviceState::Ready);
  axis.port.fault = PortFault::None;
  EXPECT_EQ(axis.cycles(2).state, DeviceState::Ready);
  axis.port.fault = PortFault::BrokenFrame;
  EXPECT_EQ(axis.cycles(10).state, DeviceState::Absent);
  EXPECT_EQ(axis.why(), "broken frame");
  EXPECT_GE(axis.reading.failures, 3U);
  MakerAxis silent;
  silent.cycles(20);
  silent.port.fault = PortFault::NoReply;
  EXPECT_EQ(silent.cycles(12).state, DeviceState::Absent);
  EXPECT_EQ(silent.why(), "no reply");
}

TEST(RegisterDeviceTest, ARefusalIsAFaultAtOnce) {
  MakerAxis axis;
  axis.port.fault = PortFault::Refused;
  EXPECT_EQ(axis.cycles(2).state, DeviceState::Fault);
  EXPECT_EQ(axis.why(), "request refused");
}

TEST(RegisterDeviceTest, APositionThatJumpsIsAFault) {
  MakerAxis axis;
  axis.port.words[0x9001] = 5000;
  axis.cycles(20);
  axis.port.words[0x9001] = 9000;
  EXPECT_EQ(axis.cycles(1).state, DeviceState::Fault);
  EXPECT_EQ(axis.why(), "the position jumped");
}

TEST(RegisterDeviceTest, AnAxisThatDoesNotGoWhereItIsSentIsToldToStop) {
  for (const bool held : {false, true}) {
    MakerAxis axis;
    axis.port.words[0x9001] = 5000;
    axis.cycles(20);
    axis.move(0.005);
    axis.cycles(30);
    ASSERT_EQ(axis.reading.state, DeviceState::Ready);
    axis.port.written = [](std::uint16_t) {};  // It heeds nothing from here on, and creeps.
    if (held) axis.command.move = false;
    int cycles = 0;
    for (; axis.reading.state == DeviceState::Ready && cycles < 400; ++cycles) {
      axis.port.words[0x9001] = static_cast<std::uint16_t>(axis.port.words[0x9001] - 8);
      axis.cycles(1);
    }
    EXPECT_EQ(axis.why(), "it does not go where it is sent") << held;
    EXPECT_TRUE(axis.port.coils[0x42C]) << "told to stop";
    EXPECT_LT(std::abs(axis.reading.position - 0.005), 9e-3) << held;
  }
}

TEST(RegisterDeviceTest, OneRequestMovesAndReadsWhereTheDeviceCan) {
  MakerAxis axis{"orca"};
  axis.port.words[342] = 50'000;
  axis.port.words[348] = 20;
  ASSERT_EQ(axis.cycles(60).state, DeviceState::Ready) << axis.why();
  EXPECT_EQ(axis.port.words[163], 50) << "the drive's own watchdog";
  EXPECT_EQ(axis.port.words[3], 3);
  EXPECT_NEAR(axis.reading.zero, 0.02, 1e-9) << "its force is tared";
  axis.port.words[348] = 1520;
  axis.move(0.01);
  axis.cycles(100);
  EXPECT_NEAR(axis.reading.position, 0.01, 2e-6);
  EXPECT_NEAR(axis.reading.force, 1.5, 1e-9);
  axis.port.words[432] = 0x800;
  EXPECT_EQ(axis.cycles(10).state, DeviceState::Fault);
  EXPECT_THAT(axis.why(), HasSubstr("watchdog"));
}

TEST(RegisterDeviceTest, ATouchedSensorIsNotTared) {
  MakerAxis cell{"tlb4"};
  cell.port.words[8] = 100;  // 1 N
  EXPECT_EQ(cell.cycles(40).state, DeviceState::Fault);
  EXPECT_THAT(cell.why(), HasSubstr("something touches"));
  cell.port.words[8] = 3;
  ++cell.command.asks.restarts;
  EXPECT_EQ(cell.cycles(40).state, DeviceState::Ready) << cell.why();
}

TEST(RegisterDeviceTest, AFloatThatIsNoNumberIsAFault) {
  MakerAxis cell{"z-sg"};
  ASSERT_EQ(cell.cycles(20).state, DeviceState::Ready) << cell.why();
  cell.port.words[63] = 0x7FC0;
  EXPECT_EQ(cell.cycles(1).state, DeviceState::Fault);
  EXPECT_EQ(cell.why(), "a reading is no number");
}

TEST(RegisterDeviceTest, ATareThatIsAskedForKeepsTheOldOneWhereSomethingTouches) {
  MakerAxis cell{"tlb4"};
  ASSERT_EQ(cell.cycles(40).state, DeviceState::Ready) << cell.why();
  cell.port.words[8] = 5;
  ++cell.command.asks.tares;
  cell.cycles(40);
  EXPECT_EQ(cell.reading.tare.taken, 1U);
  EXPECT_NEAR(cell.reading.tare.moved, 0.05, 1e-9);
  EXPECT_NEAR(cell.reading.force, 0, 1e-9);
  cell.port.words[8] = 105;
  ++cell.command.asks.tares;
  cell.cycles(40);
  EXPECT_EQ(cell.reading.state, DeviceState::Ready) << cell.why();
  EXPECT_EQ(cell.reading.tare.refused, 1U);
  EXPECT_NEAR(cell.reading.force, 1, 1e-9);
}

TEST(RegisterDeviceTest, ATareThatTheTipOrAGapOvertakesIsGivenUp) {
  MakerAxis cell{"tlb4"};
  ASSERT_EQ(cell.cycles(40).state, DeviceState::Ready) << cell.why();
  ++cell.command.asks.tares;
  cell.cycles(5);
  cell.command.asks.may_touch = true;
  cell.port.words[8] = 30;  // 0.3 N, a light touch
  cell.cycles(40);
  EXPECT_EQ(cell.reading.tare.refused, 1U);
  EXPECT_EQ(cell.reading.tare.why, "the tip may touch something");
  cell.command.asks.may_touch = false;
  cell.port.words[8] = 0;
  ++cell.command.asks.tares;
  cell.cycles(5);
  cell.port.fault = PortFault::Lost;
  ASSERT_EQ(cell.cycles(1).state, DeviceState::Absent);
  cell.port.fault = PortFault::None;
  cell.port.words[8] = 30;
  ASSERT_EQ(cell.cycles(200).state, DeviceState::Ready);
  EXPECT_EQ(cell.reading.tare.refused, 2U);
  EXPECT_EQ(cell.reading.tare.taken, 0U);
  EXPECT_NEAR(cell.reading.force, 0.3, 1e-9) << "it came back pressed";
}

TEST(RegisterDeviceTest, ATareOfADeviceThatIsNotReadyIsRefused) {
  MakerAxis cell{"tlb4"};
  cell.port.openable = false;
  ++cell.command.asks.tares;
  EXPECT_EQ(cell.cycles(1).tare.refused, 1U);
  EXPECT_EQ(cell.reading.tare.why, "the sensor is not ready");
  EXPECT_EQ(cell.cycles(5).tare.refused, 1U) << "once";
}

TEST(RegisterDeviceTest, AMoveOfSeveralRequestsGoesInTheirOrderAndNotWithoutItsFirst) {
  constexpr std::uint16_t kTarget = 0x9900;
  constexpr std::uint16_t kGo = 0x7000;
  DeviceProfile profile = find_profile("iai").value();
  profile.move.push_back({WriteKind::Registers, kGo, {{.number = 1}}});
  MakerAxis axis{profile, MakerAxis::installation()};
  axis.port.words[0x9005] = 0x3010;
  ASSERT_EQ(axis.cycles(20).state, DeviceState::Ready) << axis.why();
  std::vector<std::uint16_t> heard;
  axis.port.written = [&](std::uint16_t address) { heard.push_back(address); };
  axis.move(0.04);
  axis.cycles(1);
  EXPECT_EQ(heard, (std::vector<std::uint16_t>{kTarget, kGo}));
  heard.clear();
  axis.port.deaf_at = kTarget;
  axis.cycles(1);
  EXPECT_TRUE(heard.empty());
}

TEST(ProfileTextsTest, ListsWhatIsBuiltIn) {
  EXPECT_EQ(profile_names(), "az, iai, orca, tlb4, z-sg");
  EXPECT_TRUE(profile_text("robot").empty());
  EXPECT_THAT(std::string{profile_text("iai")}, HasSubstr("0x9900"));
}

}  // namespace
}  // namespace palp::patient
