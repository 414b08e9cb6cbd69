#include "judge/tissue_table.h"

#include <gtest/gtest.h>

namespace palp::judge {
namespace {

TEST(TissueTableTest, InterpolatesBetweenRowsAndSaysNothingBeyond) {
  const auto table =
      TissueTable::parse("# comment\nsite,d_mm,F_N\nA,0,0\nA,1,0.1\nA,2,0.4\nB,0,0\nB,1,0.5\n");
  ASSERT_TRUE(table) << table.error().text;
  EXPECT_DOUBLE_EQ(*table->force(kSiteA, 1.5e-3), 0.25);
  EXPECT_DOUBLE_EQ(*table->force(kSiteA, 0), 0);
  EXPECT_DOUBLE_EQ(*table->force(kSiteB, 1e-3), 0.5);
  EXPECT_FALSE(table->force(kSiteB, 1.001e-3));
  EXPECT_FALSE(table->force(kSiteA, -1e-6));
}

TEST(TissueTableTest, AcceptsMoreColumnsAndWindowsLineEnds) {
  const auto table = TissueTable::parse("site,d_mm,F_N,err_N\r\nA,0,0,1\r\nA,1,0.1,1\r\n");
  ASSERT_TRUE(table);
  EXPECT_DOUBLE_EQ(*table->force(kSiteA, 0.5e-3), 0.05);
}

TEST(TissueTableTest, KnowsItsCurvesByTheirPlaces) {
  const auto table =
      TissueTable::parse("x_mm,y_mm,d_mm,F_N\n5,-3,0,0\n5,-3,1,0.1\n9,0,0,0\n9,0,1,0.3\n");
  ASSERT_TRUE(table);
  EXPECT_DOUBLE_EQ(*table->force({5e-3, -3e-3}, 0.5e-3), 0.05);
  EXPECT_DOUBLE_EQ(*table->force({9.5e-3, 0}, 1e-3), 0.3);
  EXPECT_FALSE(table->force({7e-3, 0}, 0.5e-3)) << "of no curve";
  EXPECT_FALSE(TissueTable::parse("x_mm,d_mm,F_N\n0,0,0\n"));
  EXPECT_FALSE(TissueTable::parse("x_mm,y_mm,d_mm,F_N\n0,a,0,0\n"));
}

TEST(TissueTableTest, RefusesOtherColumnsPlacesAndNumbers) {
  EXPECT_FALSE(TissueTable::parse("site,d_mm,F_N\nA,0,0\nA,1,0,5\n")) << "a decimal comma";
  EXPECT_TRUE(TissueTable::parse("\xef\xbb\xbfsite,d_mm,F_N\nA,0,0\nA,1,0.5\n"));
  EXPECT_FALSE(TissueTable::parse("d_mm,F_N\n0,0\n"));
  EXPECT_FALSE(TissueTable::parse("site,d_mm,F_N\nC,0,0\n"));
  EXPECT_FALSE(TissueTable::parse("site,d_mm,F_N\nA,0,nan\n"));
  EXPECT_FALSE(TissueTable::parse("site,d_mm,F_N\nA,0\n"));
  EXPECT_FALSE(TissueTable::parse("site,d_mm,F_N\nA,1,0\nA,1,0.1\n")) << "does not rise";
}

TEST(TissueTableTest, EmptyTableKnowsNothing) {
  const auto table = TissueTable::parse("");
  ASSERT_TRUE(table);
  EXPECT_FALSE(table->force(kSiteA, 0));
}

}  // namespace
}  // namespace palp::judge
