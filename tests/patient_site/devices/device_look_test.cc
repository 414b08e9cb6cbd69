#include "patient_site/devices/device_look.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/json.h"
#include "patient_site/devices_command.h"
#include "patient_site/settings_devices.h"
#include "tests/common/io/device/fake_registers.h"

namespace palp::patient {
namespace {

using testing::HasSubstr;

DevicePlan plan_of(const std::string& profile, const std::string& address) {
  DevicePlan plan;
  plan.profile = find_profile(profile).value();
  plan.address = io::parse_modbus_address(address).value();
  return plan;
}

TEST(DeviceLookTest, ReadsAndMovesNothing) {
  FakeRegisters port;
  port.words[0x9001] = 3070;
  port.words[0x9005] = 0xB000;
  const DeviceLook look = look_at("x axis", plan_of("iai", "tcp:127.0.0.1:502"), port);
  EXPECT_TRUE(look.usable);
  EXPECT_EQ(look.found, "reads 30.700 mm, emergency stop");
  EXPECT_EQ(port.writes, 0);
  EXPECT_TRUE(port.coils.empty());
}

TEST(DeviceLookTest, SaysWhyOneCannotBeUsed) {
  FakeRegisters port;
  port.openable = false;
  EXPECT_THAT(look_at("x axis", plan_of("iai", "serial:/no/such"), port).found,
              HasSubstr("there is no such line"));
  port.openable = true;
  port.fault = io::PortFault::NoReply;
  const DeviceLook silent = look_at("force sensor", plan_of("tlb4", "tcp:127.0.0.1:502"), port);
  EXPECT_FALSE(silent.usable);
  EXPECT_EQ(silent.found, "no reply");
  port.fault = io::PortFault::Refused;
  EXPECT_EQ(look_at("force sensor", plan_of("tlb4", "tcp:127.0.0.1:502"), port).found,
            "request refused: it has no registers 5 to 13; is that its profile?");
}

TEST(DevicesCommandTest, ListsForPeopleAndForScripts) {
  const std::vector<DeviceLook> looks{{.place = "force sensor",
                                       .product = "Laumas TLB4",
                                       .address = "serial:/dev/a",
                                       .usable = false,
                                       .found = "no reply"}};
  EXPECT_EQ(devices_text(looks),
            "not usable  force sensor (Laumas TLB4, serial:/dev/a): no reply\n");
  const config::Json json = config::Json::parse(devices_json(looks));
  EXPECT_TRUE(json.contains("devices"));
  EXPECT_THAT(devices_json(looks), HasSubstr("\"usable\": false"));
}

}  // namespace
}  // namespace palp::patient
