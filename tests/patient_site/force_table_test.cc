#include "patient_site/force_table.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::patient {
namespace {

using ::testing::HasSubstr;

std::vector<ForceRow> hertz_rows() {
  std::vector<ForceRow> rows;
  for (int i = 0; i <= 20; ++i) {
    const double d = 0.25e-3 * i;
    rows.push_back({d, 1897 * d * std::sqrt(d)});
  }
  return rows;
}

std::string sentence(std::string_view text) {
  const Result<ForceTable> table = parse_force_table(text, "t.csv");
  return table ? "" : table.error().text;
}

TEST(ForceTableTest, IsExactAtItsRows) {
  const auto table = ForceTable::make(hertz_rows());
  ASSERT_TRUE(table);
  for (const ForceRow& row : hertz_rows()) {
    EXPECT_NEAR(table->force(row.indentation), row.force, 1e-12);
  }
}

TEST(ForceTableTest, FollowsHertzBetweenItsRows) {
  const auto table = ForceTable::make(hertz_rows());
  ASSERT_TRUE(table);
  // Half a millinewton is a hundredth of the transducer's step.
  for (double d = 0; d < 5e-3; d += 1e-5) {
    EXPECT_NEAR(table->force(d), 1897 * d * std::sqrt(d), 0.3e-3) << d;
  }
}

TEST(ForceTableTest, NeverFallsWhereItsRowsRise) {
  const auto table = ForceTable::make({{0, 0}, {1e-3, 0.01}, {2e-3, 0.5}, {3e-3, 0.51}, {4e-3, 2}});
  ASSERT_TRUE(table);
  double before = 0;
  for (double d = 0; d <= 4e-3; d += 1e-6) {
    EXPECT_GE(table->force(d), before - 1e-12) << d;
    before = table->force(d);
  }
}

TEST(ForceTableTest, DerivativeIsTheSlopeOfTheForceAndContinuous) {
  const auto table = ForceTable::make(hertz_rows());
  ASSERT_TRUE(table);
  constexpr double kStep = 1e-7;
  for (double d = 0.1e-3; d < 4.9e-3; d += 37e-6) {
    const double slope = (table->force(d + kStep) - table->force(d - kStep)) / (2 * kStep);
    EXPECT_NEAR(table->derivative(d), slope, 0.02) << d;
  }
  for (const ForceRow& row : hertz_rows()) {
    if (row.indentation < 1e-4 || row.indentation > 4.9e-3) continue;
    EXPECT_NEAR(table->derivative(row.indentation - 1e-10),
                table->derivative(row.indentation + 1e-10),
                1e-3);
  }
}

TEST(ForceTableTest, AStraightTableStaysStraight) {
  const auto table = ForceTable::make({{0, 0}, {1e-3, 0.1}, {2e-3, 0.2}, {3e-3, 0.3}});
  ASSERT_TRUE(table);
  for (double d = 0; d < 3e-3; d += 1e-5) EXPECT_NEAR(table->force(d), 100 * d, 1e-12);
}

TEST(ForceTableTest, GivesNoForceInTheAirAndNeverExtrapolates) {
  const auto table = ForceTable::make(hertz_rows());
  ASSERT_TRUE(table);
  EXPECT_EQ(table->force(-1e-3), 0);
  EXPECT_EQ(table->force(std::nan("")), 0);
  EXPECT_FALSE(table->beyond(5e-3));
  EXPECT_TRUE(table->beyond(5.1e-3));
  EXPECT_EQ(table->force(9e-3), hertz_rows().back().force);
  EXPECT_EQ(table->force(std::numeric_limits<double>::infinity()), hertz_rows().back().force);
  EXPECT_EQ(table->derivative(9e-3), 0);
}

TEST(ForceTableTest, BeginsAtTheSurfaceWhereItsFirstRowIsDeeper) {
  const auto table = ForceTable::make({{1e-3, 0.06}, {2e-3, 0.17}, {3e-3, 0.31}, {4e-3, 0.48}});
  ASSERT_TRUE(table);
  EXPECT_EQ(table->force(0), 0);
  EXPECT_NEAR(table->force(1e-3), 0.06, 1e-15);
}

TEST(ForceTableTest, ReadsCommentsExtraColumnsAndAnyOrderOfColumns) {
  const auto table = parse_force_table(
      "# made by hand\nerr_N,F_N,d_mm\r\n1,0,0\n1, 0.06 ,1\n\n# more\n1,0.17,2\n1,+0.31,3\n",
      "t.csv");
  ASSERT_TRUE(table) << table.error().text;
  EXPECT_NEAR(table->force(2e-3), 0.17, 1e-15);
  EXPECT_EQ(table->rows().size(), 4U);
}

TEST(ForceTableTest, SaysWhereAFileIsWrong) {
  const std::string head = "# c\nd_mm,F_N\n0,0\n1,0.1\n";
  EXPECT_THAT(sentence(head + "x,0.2\n3,0.3\n"), HasSubstr("t.csv: line 5: column 1 (d_mm): 'x'"));
  EXPECT_THAT(sentence(head + "2,0.2x\n3,0.3\n"), HasSubstr("line 5: column 2 (F_N)"));
  EXPECT_THAT(sentence(head + "2\n3,0.3\n"),
              HasSubstr("line 5: column 2 (F_N): the value is missing"));
  EXPECT_THAT(sentence(head + "2,nan\n3,0.3\n"), HasSubstr("not finite"));
  EXPECT_THAT(sentence(head + "2,1e999\n3,0.3\n"), HasSubstr("out of range"));
  EXPECT_THAT(sentence(head + "1,0.2\n3,0.3\n"), HasSubstr("line 5: d_mm = 1 does not rise"));
  EXPECT_THAT(sentence(head + "2,-0.2\n3,0.3\n"), HasSubstr("line 5: F_N = -0.2 is negative"));
  EXPECT_THAT(sentence("d_mm,F_N\n-1,0\n"), HasSubstr("d_mm = -1 is negative"));
  EXPECT_THAT(sentence(head + "2000,0.2\n"), HasSubstr("exceeds 100"));
  EXPECT_THAT(sentence(head + "2,2000\n"), HasSubstr("exceeds 1000"));
  EXPECT_THAT(sentence(head + "2,0.2\n"), HasSubstr("3 rows; a table needs at least 4"));
  EXPECT_THAT(sentence("d,F_N\n0,0\n"), HasSubstr("line 1: the header has no column d_mm"));
  EXPECT_THAT(sentence("d_mm,f\n0,0\n"), HasSubstr("no column F_N"));
  EXPECT_THAT(sentence(""), HasSubstr("no header"));
  EXPECT_EQ(sentence(head + "2,0.2\n3,0.3\n"), "");
}

TEST(ForceTableTest, ADecimalCommaIsRefusedNotReadAsZero) {
  EXPECT_THAT(sentence("d_mm,F_N\n0,0,0,0\n1,0,0,1\n2,0,0,2\n3,0,0,3\n"),
              HasSubstr("t.csv: line 2: there are 4 cells"
                        ", the header has 2; numbers are written with a point"));
  EXPECT_THAT(sentence("d_mm,F_N\n0,0\n1,0.1\n2,0.2\n3,0,3\n"), HasSubstr("line 5: there are 3"));
  EXPECT_THAT(sentence("d_mm;F_N\n0;0\n1,0;0,1\n"), HasSubstr("no column d_mm"));
  EXPECT_EQ(sentence("d_mm,F_N\n0,0,\n1,0.1,\n2,0.2,,\n3,0.3\n"), "") << "empty cells at the end";
}

TEST(ForceTableTest, AForceThatFallsIsRefused) {
  EXPECT_THAT(sentence("d_mm,F_N\n0,0\n1,0.1\n2,0.3\n3,0.2\n"),
              HasSubstr("t.csv: line 5: F_N = 0.2 falls below the row before (0.3)"));
  EXPECT_EQ(sentence("d_mm,F_N\n0,0\n1,0.1\n2,0.1\n3,0.2\n"), "") << "a plateau";
}

TEST(ForceTableTest, AByteOrderMarkIsNoPartOfTheFirstName) {
  EXPECT_EQ(sentence("\xef\xbb\xbf"
                     "d_mm,F_N\n0,0\n1,0.1\n2,0.2\n3,0.3\n"),
            "");
}

std::string placed_sentence(const std::string& text) {
  const auto curves = parse_tissue_curves(text, "t.csv", kSiteB);
  return curves ? std::string{} : curves.error().text;
}

TEST(ForceTableTest, CurvesWithoutPlacesAreOneWhereTheCallerSays) {
  const auto curves = parse_tissue_curves("d_mm,F_N\n0,0\n1,0.1\n2,0.2\n3,0.3\n", "t", kSiteB);
  ASSERT_TRUE(curves) << curves.error().text;
  ASSERT_EQ(curves->size(), 1U);
  EXPECT_EQ(curves->front().place, kSiteB);
}

TEST(ForceTableTest, AColumnOfPlacesThatIsAbsentIsZero) {
  const auto curves =
      parse_tissue_curves("d_mm,x_mm,F_N\n0,3,0\n1,3,0.1\n2,3,0.2\n3,3,0.3\n", "t", kSiteB);
  ASSERT_TRUE(curves) << curves.error().text;
  EXPECT_EQ(curves->front().place, (Place{3e-3, 0}));
}

TEST(ForceTableTest, SaysWhichPlaceIsWrong) {
  const std::string one = "x_mm,y_mm,d_mm,F_N\n1,2,0,0\n1,2,1,0.1\n1,2,2,0.2\n1,2,3,0.3\n";
  const std::string two = "5,2,0,0\n5,2,1,0.1\n5,2,2,0.2\n5,2,3,0.3\n";
  EXPECT_EQ(placed_sentence(one + two), "");
  EXPECT_THAT(placed_sentence(one + two + "1,2,4,1\n"),
              HasSubstr("t.csv: line 10: place 1,2 mm comes again"));
  EXPECT_THAT(placed_sentence(one + "1.9,2,0,0\n"), HasSubstr("within 1 mm of 1,2"));
  EXPECT_THAT(placed_sentence(one + "5,2,0,0\n"), HasSubstr("place 5,2 mm: there are 1 rows"));
  EXPECT_THAT(placed_sentence(one + "250.5,2,0,0\n"), HasSubstr("x_mm = 250.5 lies beyond 250"));
  EXPECT_THAT(placed_sentence(one + "5,-251,0,0\n"), HasSubstr("y_mm = -251 lies beyond 250"));
  EXPECT_THAT(placed_sentence(one + "5,,0,0\n"),
              HasSubstr("column 2 (y_mm): the value is missing"));
  std::string many = "x_mm,y_mm,d_mm,F_N\n";
  for (int i = 0; i < 65; ++i) {
    for (int d = 0; d < 4; ++d) many += std::to_string(2 * i) + ",0," + std::to_string(d) + ",1\n";
  }
  EXPECT_THAT(placed_sentence(many), HasSubstr("more than 64 places"));
}

TEST(ForceTableTest, ANamedFileThatIsNotThereIsOneSentence) {
  const auto table = load_tissue_curves("no/such/file.csv", {});
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error().text, "cannot read no/such/file.csv: No such file or directory");
}

}  // namespace
}  // namespace palp::patient
