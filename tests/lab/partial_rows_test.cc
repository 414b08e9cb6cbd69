#include "lab/partial_rows.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "common/core/whole_file.h"
#include "lab/report/checked_rows.h"
#include "tests/support/own_path.h"

namespace palp::lab {
namespace {

TEST(PartialRowsTest, GoesOnBelowTheRowsThatAreWhole) {
  const std::string path = test::own_path("partial_rows");
  const std::string row = with_check("1,x") + "\n";
  {
    auto rows = PartialRows::open(path, false);
    ASSERT_TRUE(rows && rows->begin("head\n"));
    rows->add(row);
    rows->add("2,half of it");
  }
  auto rows = PartialRows::open(path, true);
  ASSERT_TRUE(rows);
  EXPECT_EQ(rows->before(), "head\n" + row);
  ASSERT_TRUE(rows->begin("head\n"));
  rows->add(row);
  EXPECT_EQ(*read_whole_file(rows->file()), "head\n" + row + row);
  remove_partial_rows(path);
  EXPECT_FALSE(std::filesystem::exists(rows->file()));
}

TEST(PartialRowsTest, WithoutAFileNothingIsKeptAndNothingResumed) {
  auto rows = PartialRows::open("", false);
  ASSERT_TRUE(rows && rows->begin("head\n"));
  rows->add("row\n");
  EXPECT_FALSE(PartialRows::open("", true));
  EXPECT_FALSE(PartialRows::open("/dev/null", true));
}

}  // namespace
}  // namespace palp::lab
