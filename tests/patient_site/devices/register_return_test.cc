// What comes back behind a line that was lost, and what of it waits for a person.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "patient_site/devices/register_device.h"
#include "tests/patient_site/devices/maker_axis.h"

namespace palp::patient {
namespace {

using io::PortFault;
using testing::HasSubstr;

TEST(RegisterDeviceTest, ComesBackWithoutAJump) {
  MakerAxis axis;
  axis.port.words[0x9001] = 5000;
  axis.cycles(20);
  axis.move(0.02);
  axis.cycles(10);
  axis.port.fault = PortFault::Lost;
  axis.port.openable = false;
  ASSERT_EQ(axis.cycles(100).state, DeviceState::Absent);
  EXPECT_EQ(axis.why(), "cannot be opened");
  EXPECT_LT(axis.port.opened, 8) << "tried now and then";
  axis.port.words[0x9001] = 4500;
  axis.port.fault = PortFault::None;
  axis.port.openable = true;
  axis.fastest = 0;
  axis.cycles(200);
  EXPECT_EQ(axis.reading.state, DeviceState::Ready) << axis.why();
  EXPECT_NEAR(axis.reading.position, 0.02, 1e-5);
  EXPECT_LE(axis.fastest, 0.1 + 0.002);
}

TEST(RegisterDeviceTest, ALineThatWasLostFreesItOfNoFault) {
  MakerAxis axis;
  axis.cycles(20);
  axis.port.words[0x9005] = 0xB010;
  ASSERT_EQ(axis.cycles(1).state, DeviceState::Fault);
  axis.port.fault = PortFault::Lost;
  ASSERT_EQ(axis.cycles(5).state, DeviceState::Absent);
  axis.port.fault = PortFault::None;
  axis.port.words[0x9005] = 0x3010;
  axis.port.coils.clear();
  ASSERT_EQ(axis.cycles(100).state, DeviceState::Fault);
  EXPECT_EQ(axis.why(), "the device reports: emergency stop");
  EXPECT_FALSE(axis.port.coils.contains(0x403)) << "its servo is not switched on";
  ++axis.command.asks.restarts;
  EXPECT_EQ(axis.cycles(30).state, DeviceState::Ready) << axis.why();
}

TEST(RegisterDeviceTest, WhatComesBackByItselfDoesNotHomeByItself) {
  DeviceInstallation built_in = MakerAxis::installation();
  built_in.may_home = true;
  MakerAxis axis{"iai", built_in};
  ASSERT_EQ(axis.cycles(20).state, DeviceState::Ready);
  ++axis.command.asks.restarts;  // meant for the site
  axis.port.fault = PortFault::Lost;
  ASSERT_EQ(axis.cycles(5).state, DeviceState::Absent);
  axis.port.fault = PortFault::None;
  axis.port.words[0x9005] = 0x3000;  // its power was lost, and its home with it
  ASSERT_EQ(axis.cycles(100).state, DeviceState::Fault);
  EXPECT_EQ(axis.why(), "it must move, which begins with a reset: home");
  EXPECT_FALSE(axis.port.coils.contains(0x40B));
  ++axis.command.asks.restarts;
  axis.cycles(20);
  EXPECT_TRUE(axis.port.coils[0x40B]);
  axis.port.fault = PortFault::Lost;  // on its way home
  ASSERT_EQ(axis.cycles(5).state, DeviceState::Absent);
  axis.port.fault = PortFault::None;
  axis.port.words[0x9005] = 0x3010;
  EXPECT_EQ(axis.cycles(100).state, DeviceState::Ready) << axis.why();
}

TEST(RegisterDeviceTest, WhatComesBackByItselfClearsNoAlarmAndSwitchesNoServoOn) {
  for (const int state : {0x3410, 0x2010}) {
    MakerAxis axis;
    ASSERT_EQ(axis.cycles(20).state, DeviceState::Ready);
    axis.port.fault = PortFault::Lost;
    ASSERT_EQ(axis.cycles(5).state, DeviceState::Absent);
    axis.port.fault = PortFault::None;
    axis.port.words[0x9005] = static_cast<std::uint16_t>(state);
    axis.port.coils.clear();
    ASSERT_EQ(axis.cycles(100).state, DeviceState::Fault);
    EXPECT_THAT(axis.why(), HasSubstr("which a reset must confirm: "));
    EXPECT_FALSE(axis.port.coils.contains(0x403)) << "its servo is not switched on";
    EXPECT_FALSE(axis.port.coils[0x407]) << "its alarm is not reset";
    axis.port.fault = PortFault::Lost;
    ASSERT_EQ(axis.cycles(5).state, DeviceState::Absent);
    axis.port.fault = PortFault::None;
    ASSERT_EQ(axis.cycles(100).state, DeviceState::Fault) << "nor by a second line";
    ++axis.command.asks.restarts;
    axis.cycles(10);
    EXPECT_TRUE(axis.port.coils[0x403] || axis.port.coils[0x407]) << "a person may";
  }
}

TEST(RegisterDeviceTest, ADrivesOwnWatchdogIsClearedByALineThatComesBackAndNothingElseIs) {
  for (const int errors : {0x0800, 0x0840}) {
    MakerAxis axis{"orca"};
    ASSERT_EQ(axis.cycles(60).state, DeviceState::Ready) << axis.why();
    axis.port.fault = PortFault::Lost;
    ASSERT_EQ(axis.cycles(5).state, DeviceState::Absent);
    axis.port.fault = PortFault::None;
    axis.port.words[432] = static_cast<std::uint16_t>(errors);
    axis.port.written = [&](std::uint16_t address) {
      if (address == 0 && axis.port.words[0] == 2) axis.port.words[432] = 0;
    };
    axis.cycles(200);
    EXPECT_EQ(axis.port.words[432] == 0, errors == 0x0800);
    EXPECT_EQ(axis.reading.state == DeviceState::Ready, errors == 0x0800) << axis.why();
  }
}

TEST(RegisterDeviceTest, WhoComesBackElsewhereWaitsForAPerson) {
  MakerAxis axis;
  axis.port.words[0x9001] = 5000;
  ASSERT_EQ(axis.cycles(20).state, DeviceState::Ready);
  axis.port.fault = PortFault::Lost;
  ASSERT_EQ(axis.cycles(5).state, DeviceState::Absent);
  axis.port.fault = PortFault::None;
  axis.port.words[0x9001] = 7000;  // its zero is another
  ASSERT_EQ(axis.cycles(100).state, DeviceState::Fault);
  EXPECT_EQ(axis.why(), "it came back elsewhere than it stood: is its zero still good?");
  EXPECT_EQ(axis.port.words[0x9001], 7000);
  ++axis.command.asks.restarts;
  EXPECT_EQ(axis.cycles(30).state, DeviceState::Ready) << axis.why();
}

TEST(RegisterDeviceTest, AnErrorBesideTheWatchdogIsSeenAlsoWhereItsFirstReadingFails) {
  MakerAxis axis{"orca"};
  ASSERT_EQ(axis.cycles(60).state, DeviceState::Ready) << axis.why();
  axis.port.fault = PortFault::Lost;
  ASSERT_EQ(axis.cycles(5).state, DeviceState::Absent);
  axis.port.fault = PortFault::None;
  axis.port.words[432] = 0x0840;
  axis.port.deaf_at = 432;
  axis.cycles(102);
  axis.port.deaf_at.reset();
  axis.cycles(20);
  EXPECT_EQ(axis.reading.state, DeviceState::Fault);
  EXPECT_EQ(axis.why(), "it came back by itself, which a reset must confirm: errors of its own");
}

}  // namespace
}  // namespace palp::patient
