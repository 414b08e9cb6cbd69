#include "study/tab_cells.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::study {
namespace {

TEST(TabCellsTest, EmptyCellsAreCellsToo) {
  EXPECT_THAT(tab_cells("a\tb c\t\td"), testing::ElementsAre("a", "b c", "", "d"));
  EXPECT_THAT(tab_cells("\t"), testing::ElementsAre("", ""));
  EXPECT_THAT(tab_cells(""), testing::ElementsAre(""));
}

}  // namespace
}  // namespace palp::study
