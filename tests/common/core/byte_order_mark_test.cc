#include "common/core/byte_order_mark.h"

#include <gtest/gtest.h>

namespace palp {
namespace {

TEST(ByteOrderMarkTest, OneIsTakenOffAtTheBeginningOnly) {
  EXPECT_EQ(without_byte_order_mark("\xef\xbb\xbf"
                                    "d_mm,F_N"),
            "d_mm,F_N");
  EXPECT_EQ(without_byte_order_mark("d_mm"), "d_mm");
  EXPECT_EQ(without_byte_order_mark("\xef\xbb"), "\xef\xbb");
  EXPECT_EQ(without_byte_order_mark("a\xef\xbb\xbf"), "a\xef\xbb\xbf");
  EXPECT_EQ(without_byte_order_mark(""), "");
}

}  // namespace
}  // namespace palp
