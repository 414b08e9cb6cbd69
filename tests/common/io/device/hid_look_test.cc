#include "common/io/device/hid_look.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/common/io/device/fake_hidapi.h"

namespace palp::io {
namespace {

TEST(HidLookTest, NamesWhatIsThereAndWhatIsNot) {
  fake_hid::Device board;
  board.path = "board";
  board.vendor = 1;
  board.product = 2;
  board.name = L"Board";
  board.serial = L"77";
  fake_hid::plug(board);
  board.path = "locked";
  board.openable = false;
  fake_hid::plug(board);
  const auto address = [](std::uint16_t product) {
    return HidAddress{
        .vendor = 1, .product = product, .interface_number = -1, .usage_page = 0, .serial = {}};
  };
  const auto looks = look_for_hid({{"A board", {address(2)}}, {"A cap", {address(3), address(4)}}});
  fake_hid::clear();
  ASSERT_EQ(looks.size(), 3U);
  EXPECT_TRUE(looks[0].usable);
  EXPECT_EQ(looks[0].address, "hid:board");
  EXPECT_EQ(looks[0].found, "Board, serial 77");
  EXPECT_FALSE(looks[1].usable);
  EXPECT_THAT(looks[1].found, testing::HasSubstr("cannot be opened"));
  EXPECT_EQ(looks[2].product, "A cap");
  EXPECT_EQ(looks[2].found, "absent");
}

}  // namespace
}  // namespace palp::io
