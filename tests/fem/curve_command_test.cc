#include "fem/curve_command.h"

#include <gtest/gtest.h>

namespace palp::fem {
namespace {

TEST(CurveCommandTest, RangesIncludeBothEnds) {
  const auto range = parse_indentations("0:4:0.25");
  ASSERT_TRUE(range);
  EXPECT_EQ(range->size(), 17U);
  EXPECT_NEAR(range->back(), 4e-3, 1e-15);
  EXPECT_EQ(parse_indentations("0.1:0.3:0.1")->size(), 3U);
  EXPECT_EQ(parse_indentations("2,0.5")->front(), 2e-3);
}

TEST(CurveCommandTest, RefusesWhatIsNoList) {
  for (const char* text :
       {"", "a", "1,,2", "0:4:0", "4:0:1", "0:4:-1", "0:1e9:1e-9", "1:2", "nan"}) {
    EXPECT_FALSE(parse_indentations(text)) << text;
  }
}

Result<Curve> solve(CurveFlags flags) {
  flags.indentations_mm = flags.indentations_mm == "0:4:0.25" ? "1" : flags.indentations_mm;
  const auto request = curve_request(flags);
  if (!request) return tl::unexpected<Error>(request.error());
  return solve_curve(*request);
}

TEST(CurveCommandTest, RefusesWhatCannotBeSolvedAndNamesTheLimit) {
  EXPECT_TRUE(solve({.model = "l1"}));
  EXPECT_FALSE(solve({.shape = "ball", .depth_mm = 30}));
  EXPECT_FALSE(solve({.poisson = 0.5}));
  EXPECT_FALSE(solve({.indentations_mm = "-1"}));
  const auto reach = solve({.shape = "ball", .depth_mm = 4, .indentations_mm = "4"});
  ASSERT_FALSE(reach);
  EXPECT_NE(reach.error().text.find("below 4 mm"), std::string::npos);
}

TEST(CurveCommandTest, RowsComeInTheOrderAskedWithAHeader) {
  const auto curve = solve({.model = "l1", .indentations_mm = "2,0,1"});
  ASSERT_TRUE(curve);
  EXPECT_NEAR(curve->rows[0].indentation, 2e-3, 1e-12);
  EXPECT_EQ(curve->rows[1].force, 0);
  EXPECT_GT(curve->rows[0].force, curve->rows[2].force);
  EXPECT_GT(curve->rows[0].error, 0);
  EXPECT_EQ(csv_text(curve->rows).substr(0, 33), "d_mm,F_N,contact_radius_mm,err_N\n");
}

}  // namespace
}  // namespace palp::fem
