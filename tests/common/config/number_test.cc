#include "common/config/number.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp::config {
namespace {

TEST(NumberTest, ReadsWhatPeopleType) {
  EXPECT_EQ(parse_number("-1.5e-3"), -0.0015);
  EXPECT_EQ(parse_number("0"), 0.0);
  EXPECT_EQ(parse_whole("18446744073709551615"), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(parse_integer("-7"), -7);
}

TEST(NumberTest, RefusesWhatIsNotWhollyAFiniteNumber) {
  for (const char* text :
       {"", " 1", "1 ", "1x", "+1", "0x10", "nan", "inf", "-inf", "1e999", "1,5"}) {
    EXPECT_FALSE(parse_number(text)) << text;
  }
  for (const char* text : {"", "-1", "1.0", "1e3", " 1", "18446744073709551616"}) {
    EXPECT_FALSE(parse_whole(text)) << text;
  }
}

TEST(NumberTest, ReadsSharesAsFractionOrPerCent) {
  EXPECT_EQ(parse_share("0.05"), 0.05);
  EXPECT_EQ(parse_share("5%"), 0.05);
  EXPECT_EQ(parse_share("100%"), 1.0);
  for (const char* text : {"", "%", "5 %", "5%%", "nan%", "5%x"}) {
    EXPECT_FALSE(parse_share(text)) << text;
  }
  EXPECT_EQ(range_text(0, 1, "share"), "0 to 1 (0% to 100%)");
}

RC_GTEST_PROP(NumberTest, TextReadsBackAsTheSameNumber, (double value)) {
  RC_PRE(std::isfinite(value));
  RC_ASSERT(parse_number(number_text(value)) == value);
}

TEST(NumberTest, LeavesOutTheUnitOfPlainNumbers) {
  EXPECT_EQ(range_text(0.1, 10, "N"), "0.1 to 10 N");
  EXPECT_EQ(range_text(0, 1, "1"), "0 to 1");
}

}  // namespace
}  // namespace palp::config
