#include "surgeon_site/devices_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::surgeon {
namespace {

using testing::HasSubstr;

TEST(MasterListTest, SaysWhatCanBeUsedForPeopleAndForScripts) {
  const std::vector<io::HidLook> looks{
      {.product = "Paddle", .address = "hid:/dev/hidraw3", .usable = true, .found = "T, serial 1"},
      {.product = "Board", .address = {}, .usable = false, .found = "absent"}};
  EXPECT_EQ(devices_text(looks),
            "usable      Paddle (hid:/dev/hidraw3): T, serial 1\n"
            "not usable  Board: absent\n");
  EXPECT_THAT(devices_json(looks), HasSubstr("\"schema\": \"palp.devices/1\""));
  EXPECT_THAT(devices_json(looks), HasSubstr("\"address\": \"hid:/dev/hidraw3\""));
}

}  // namespace
}  // namespace palp::surgeon
