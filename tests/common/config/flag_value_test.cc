#include "common/config/flag_value.h"

#include <gtest/gtest.h>

namespace palp::config {
namespace {

TEST(FlagValueTest, HoldsNumbersInTheirRange) {
  const NumberRange range{.min = -1, .max = 1, .unit = "N"};
  EXPECT_EQ(read_number("--x", "-1", range), -1.0);
  EXPECT_EQ(read_number("--x", "1", range), 1.0);
  EXPECT_EQ(read_number("--x", "1.0000000000000002", range).error().text,
            "--x = 1.0000000000000002 is out of range: -1 to 1 N");
  EXPECT_EQ(read_number("--x", "nan", range).error().text, "--x = nan is not a number: -1 to 1 N");
}

TEST(FlagValueTest, HoldsWholeNumbersInTheirRange) {
  const WholeRange range{.min = 1, .max = 3, .unit = "taps"};
  EXPECT_EQ(read_whole("--x", "1", range), 1U);
  EXPECT_EQ(read_whole("--x", "3", range), 3U);
  EXPECT_EQ(read_whole("--x", "0", range).error().text, "--x = 0 is out of range: 1 to 3 taps");
  EXPECT_EQ(read_whole("--x", "4", range).error().text, "--x = 4 is out of range: 1 to 3 taps");
  EXPECT_EQ(read_whole("--x", "2.0", range).error().text,
            "--x = 2.0 is not a whole number: 1 to 3 taps");
}

TEST(FlagValueTest, DescribesUnitAndRange) {
  EXPECT_EQ(describe("how far", NumberRange{.min = 0, .max = 0.5, .unit = "m"}),
            "how far [m], 0 to 0.5");
  EXPECT_EQ(describe("how many", WholeRange{.min = 1, .max = 3}), "how many, 1 to 3");
}

TEST(FlagValueTest, ATextIsNotEmptyAndASwitchTakesNone) {
  EXPECT_EQ(read_text("--out", "a b").value(), "a b");
  EXPECT_EQ(read_text("--out", "").error().text, "--out is empty");
  EXPECT_FALSE(read_text("--out", std::string{"a\0b", 3}));
  EXPECT_TRUE(read_switch("--json", "true"));
  EXPECT_EQ(read_switch("--json", "yes").error().text, "--json takes no value");
}

TEST(FlagValueTest, AnAddressIsNamedWithItsFlag) {
  EXPECT_EQ(read_address("--peer", "here:9", 1).value().port, 9);
  EXPECT_EQ(read_address("--peer", "here:0", 1).error().text.find("--peer: "), 0U);
}

TEST(FlagValueTest, TakesOnlyTheChoicesThereAre) {
  EXPECT_EQ(read_choice("--x", "b", {"a", "b"}), "b");
  EXPECT_EQ(read_choice("--x", "B", {"a", "b"}).error().text, "--x = B is not one of: a, b");
  EXPECT_EQ(list_text({}), "");
}

}  // namespace
}  // namespace palp::config
