#include "patient_site/device_check.h"

#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "patient_site/settings_devices.h"

namespace palp::patient {
namespace {

constexpr const char* kRig =
    "normal { profile: 'orca' address: 'serial:/dev/null/none' }\n"
    "card { model: 'usb-1208fs' n_per_v: 5 range: 8 }\n";

TEST(DeviceCheckTest, KnowsTheDevicesOfItsFile) {
  const DevicePlans plans = make_device_plans(kRig, "rig").value();
  std::istringstream in;
  std::ostringstream out;
  site_program::Dialogue talk{in, out};
  const io::SteadyClock clock;
  DeviceCheck check{plans, clock, talk};
  EXPECT_TRUE(check.known("normal"));
  EXPECT_TRUE(check.known("card"));
  EXPECT_FALSE(check.known("x"));
  EXPECT_FALSE(check.known("robot"));
  EXPECT_EQ(check.run("x", "rig").error().text,
            "rig has no device 'x'; the names are: normal, x, y, cell, card");
}

TEST(DeviceCheckTest, WhatWasFoundIsReadBackWithTheRestOfTheFile) {
  DevicePlans plans = make_device_plans(kRig, "rig").value();
  plans.normal->installation.zero = 0.0123;
  plans.normal->installation.reversed = true;
  plans.normal->installation.force_unit = 2e-3;
  plans.normal->lag = 0.017;
  const auto axis = calibrated_text(kRig, "rig", "normal", *plans.normal);
  ASSERT_TRUE(axis) << axis.error().text;
  EXPECT_THAT(*axis, testing::StartsWith("# Written by a program, from rig. Comments"));
  plans.card->installation.newtons_per_volt = -7.5;
  const auto both = calibrated_text(*axis, "rig", *plans.card);
  ASSERT_TRUE(both) << both.error().text;
  const DevicePlans again = make_device_plans(*both, "again").value();
  EXPECT_NEAR(again.normal->installation.zero, 0.0123, 1e-9);
  EXPECT_TRUE(again.normal->installation.reversed);
  EXPECT_NEAR(again.normal->installation.force_unit, 2e-3, 1e-9);
  EXPECT_NEAR(again.normal->lag, 0.017, 1e-9);
  EXPECT_EQ(again.card->installation.newtons_per_volt, -7.5);
  EXPECT_EQ(again.card->installation.range, kSingleEnded);
  EXPECT_EQ(again.card->installation.kind, CardKind::Usb1208);
}

}  // namespace
}  // namespace palp::patient
