#include "common/io/device/hid_port.h"

#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/io/device/report_port.h"
#include "tests/common/io/device/fake_hidapi.h"

namespace palp::io {
namespace {

using fake_hid::Bytes;
using testing::HasSubstr;

class HidPortTest : public testing::Test {
 protected:
  ~HidPortTest() override { fake_hid::clear(); }
  static fake_hid::Device device(const std::string& path, int interface_number) {
    fake_hid::Device made;
    made.path = path;
    made.vendor = 0x16C0;
    made.product = 0x0486;
    made.interface_number = interface_number;
    made.usage_page = static_cast<std::uint16_t>(0xFFAB + interface_number);
    made.serial = L"12\n34";
    return made;
  }
  inline static const HidAddress kFirst{
      .vendor = 0x16C0, .product = 0x0486, .interface_number = 0, .usage_page = 0, .serial = {}};
};

TEST_F(HidPortTest, ListsWhatIsThereInPrintableWords) {
  fake_hid::plug(device("/dev/hidraw4", 1));
  fake_hid::plug(device("/dev/hidraw3", 0));
  const auto all = list_hid();
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].path, "/dev/hidraw3");
  EXPECT_EQ(all[0].serial, "12?34");
  EXPECT_TRUE(agrees(all[0], kFirst));
  EXPECT_FALSE(agrees(all[1], kFirst));
  HidAddress by_usage = kFirst;
  by_usage.interface_number = -1;
  by_usage.usage_page = 0xFFAC;
  EXPECT_TRUE(agrees(all[1], by_usage));
  by_usage.serial = "other";
  EXPECT_FALSE(agrees(all[1], by_usage));
}

TEST_F(HidPortTest, SaysWhyOneCannotBeOpened) {
  auto& one = fake_hid::plug(device("/no/such/node", 0));
  EXPECT_FALSE(why_not_opened(list_hid()[0]).has_value());
  one.openable = false;
  EXPECT_THAT(why_not_opened(list_hid()[0]).value_or(""), HasSubstr("no such device"));
}

TEST_F(HidPortTest, HandsOverReportsAsTheyAre) {
  auto& one = fake_hid::plug(device("a", 0));
  HidPort port{kFirst};
  std::array<std::uint8_t, 8> bytes{};
  std::size_t length = 9;
  EXPECT_EQ(port.read(bytes, length, Duration{0}), PortFault::Lost);
  ASSERT_EQ(port.open(), PortFault::None);
  EXPECT_EQ(port.read(bytes, length, Duration{0}), PortFault::None);
  EXPECT_EQ(length, 0U);
  one.input.push_back({1, 2, 3});
  EXPECT_EQ(port.read(bytes, length, Duration{0}), PortFault::None);
  EXPECT_EQ(length, 3U);
  EXPECT_EQ(bytes[2], 3);
  const Bytes out{0, 7};
  EXPECT_EQ(port.write(out), PortFault::None);
  EXPECT_EQ(port.set_feature(out), PortFault::None);
  EXPECT_EQ(one.written, std::vector<Bytes>{out});
  EXPECT_EQ(one.features, std::vector<Bytes>{out});
  EXPECT_EQ(port.get_feature(bytes, length), PortFault::Refused);
  one.feature = [](std::uint8_t id) { return Bytes{id, 9}; };
  bytes[0] = 0x12;
  EXPECT_EQ(port.get_feature(bytes, length), PortFault::None);
  EXPECT_EQ(length, 2U);
  one.writable = false;
  EXPECT_EQ(port.write(out), PortFault::Refused);
}

TEST_F(HidPortTest, OpensNeitherOfTwoThatAgree) {
  fake_hid::Device& first = fake_hid::plug(device("/dev/hidraw3", 0));
  fake_hid::Device& twin = fake_hid::plug(device("/dev/hidraw10", 0));
  fake_hid::plug(device("/dev/hidraw4", 1));
  HidPort port{kFirst};
  EXPECT_EQ(port.open(), PortFault::Ambiguous);
  EXPECT_FALSE(first.open || twin.open);
  HidAddress any = kFirst;
  any.interface_number = -1;
  twin.there = false;
  EXPECT_EQ(HidPort{any}.open(), PortFault::None) << "interfaces of one device are no twins";
  twin.there = true;
  twin.serial = L"56";
  HidAddress by_serial = kFirst;
  by_serial.serial = "56";
  HidPort second{by_serial};
  EXPECT_EQ(second.open(), PortFault::None);
  EXPECT_TRUE(twin.open);
}

TEST_F(HidPortTest, FindsADeviceThatWasPluggedInAgainElsewhere) {
  auto& one = fake_hid::plug(device("a", 0));
  HidPort port{kFirst};
  ASSERT_EQ(port.open(), PortFault::None);
  one.there = false;
  std::array<std::uint8_t, 8> bytes{};
  std::size_t length{};
  EXPECT_EQ(port.read(bytes, length, Duration{0}), PortFault::Lost);
  EXPECT_EQ(port.write(bytes), PortFault::Lost);
  EXPECT_FALSE(one.open);
  EXPECT_EQ(port.open(), PortFault::NotOpen);
  auto& again = fake_hid::plug(device("b", 0));
  EXPECT_EQ(port.open(), PortFault::None);
  EXPECT_EQ(again.opened, 1);
  port.close();
  port.close();
  EXPECT_FALSE(again.open);
}

}  // namespace
}  // namespace palp::io
