#include "lab/report/checked_rows.h"

#include <gtest/gtest.h>

namespace palp::lab {
namespace {

TEST(CheckedRowsTest, EveryCutAndEveryChangedByteIsNoticed) {
  const std::string row = with_check("3,99,,\"a, b\",0.25");
  EXPECT_TRUE(holds_check(row));
  for (std::size_t i = 0; i < row.size(); ++i) {
    EXPECT_FALSE(holds_check(row.substr(0, i))) << i;
    std::string changed = row;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    EXPECT_FALSE(holds_check(changed)) << i;
  }
}

TEST(CheckedRowsTest, OnlySoundRowsBelowTheHeaderAreKept) {
  const std::string one = with_check("1,x") + "\n";
  const std::string two = with_check("2,y") + "\n";
  EXPECT_EQ(sound_rows("head,check\n" + one + two.substr(0, 4) + one + two),
            "head,check\n" + one + two);
  EXPECT_EQ(sound_rows("head,check\n" + one + two.substr(0, two.size() - 1)), "head,check\n" + one);
  EXPECT_EQ(sound_rows("head,che"), "");
}

TEST(CheckedRowsTest, WhatIsMissingTwiceOrTooManyIsNamed) {
  EXPECT_TRUE(check_all_there({0, 1, 2}, 3));
  const auto fault = [](const std::vector<std::uint64_t>& indices) {
    const auto whole = check_all_there(indices, 3);
    return whole ? std::string{} : whole.error().text;
  };
  const std::string missing = " of 3 is missing: merge the cases of all shards of one plan";
  EXPECT_EQ(fault({}), "there is no case in these files");
  EXPECT_EQ(fault({1, 2}), "case 0" + missing);
  EXPECT_EQ(fault({0, 2}), "case 1" + missing);
  EXPECT_EQ(fault({0, 1}), "case 2" + missing);
  EXPECT_EQ(fault({0, 1, 1, 2}), "case 1 of 3 is given twice");
  EXPECT_EQ(fault({0, 1, 2, 2}), "case 2 of 3 is given twice");
  EXPECT_EQ(fault({0, 1, 2, 3}), "case 3 of 3 is none of them");
}

}  // namespace
}  // namespace palp::lab
