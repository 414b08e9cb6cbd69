#include "fem/curve_command.h"

#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/own_path.h"

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

struct Refusal {
  CurveFlags flags;
  const char* sentence;  ///< part of it: what and the limit
};

// Each in one sentence that names the value and the limit, in millimetre.
TEST(CurveCommandTest, EveryRefusalNamesValueAndLimit) {
  const std::vector<Refusal> refusals{
      {{.shape = "ball", .depth_mm = 30}, "60 mm below the surface, expected at most 56.772 mm"},
      {{.shape = "ball", .radius_mm = 0}, "radius is 0 mm, expected above 0"},
      {{.shape = "ball", .depth_mm = -1}, "-1 mm, expected at least 0.228 mm"},
      {{.poisson = 0.5}, "Poisson's ratio is 0.5, expected 0 to 0.49999"},
      {{.shape = "ball", .inclusion_poisson = 0.6}, "is 0.6, expected 0 to 0.49999"},
      {{.shape = "ball", .depth_mm = 4, .indentations_mm = "4"}, "4 mm, expected below 4 mm"},
      {{.indentations_mm = "-1"}, "-1 mm, expected 0 or more"},
      {{.indentations_mm = "9"}, "9 mm, expected at most 6 mm"}};
  for (const Refusal& refusal : refusals) {
    const auto curve = solve(refusal.flags);
    ASSERT_FALSE(curve) << refusal.sentence;
    EXPECT_NE(curve.error().text.find(refusal.sentence), std::string::npos) << curve.error().text;
    EXPECT_EQ(curve.error().text.find('\n'), std::string::npos);
  }
}

TEST(CurveCommandTest, AStepThatDoesNotConvergeNamesHowFarItWent) {
  const auto curve =
      solve({.shape = "ball", .depth_mm = 4.2, .radius_mm = 16, .indentations_mm = "4.15"});
  ASSERT_FALSE(curve);
  EXPECT_NE(curve.error().text.find("asked for 4.15 mm"), std::string::npos) << curve.error().text;
}

TEST(CurveCommandTest, NoFileIsLeftWhereOneCannotBeWritten) {
  const std::string vtu = test::own_path("curve_command_test.vtu");
  const auto exit_status = run_curve(
      {.model = "l1", .indentations_mm = "1", .csv = "/nonexistent/curve.csv", .vtu = vtu});
  EXPECT_EQ(exit_status.code, config::ExitCode::CannotOpen);
  EXPECT_FALSE(std::ifstream{vtu});
}

TEST(CurveCommandTest, APlaceBesideTheBallGoesThroughFlagsInMillimetreAndDegrees) {
  const CurveFlags flags{.shape = "ball",
                         .depth_mm = 5,
                         .radius_mm = 5,
                         .offset_mm = 5,
                         .tilt_deg = 10,
                         .surface_radius_mm = 60,
                         .model = "l1",
                         .indentations_mm = "1",
                         .accuracy = "coarse"};
  const Approach approach = approach_of(flags);
  EXPECT_NEAR(approach.offset, 5e-3, 1e-15);
  EXPECT_NEAR(approach.tilt, std::numbers::pi / 18, 1e-15);
  EXPECT_NEAR(approach.surface_curvature, 1 / 60e-3, 1e-9);
  EXPECT_TRUE(approach_of({}).straight());
  const auto found = solve_off_axis_curve(*curve_request(flags), approach);
  ASSERT_TRUE(found);
  const auto exit_status = run_curve(flags);
  EXPECT_EQ(exit_status.code, config::ExitCode::Done);
  EXPECT_EQ(exit_status.text, csv_text(*found));
}

TEST(CurveCommandTest, ASectionIsDrawnOfATipAboveTheBallAlone) {
  const auto exit_status =
      run_curve({.offset_mm = 5, .model = "l1", .indentations_mm = "1", .vtu = "/nonexistent/a"});
  EXPECT_EQ(exit_status.code, config::ExitCode::BadInput);
}

TEST(CurveCommandTest, TheErrorOfACoarseMeshIsItsDistanceFromTheNormalOne) {
  const auto coarse = solve({.model = "l1", .indentations_mm = "2", .accuracy = "coarse"});
  const auto normal = solve({.model = "l1", .indentations_mm = "2"});
  ASSERT_TRUE(coarse && normal);
  EXPECT_DOUBLE_EQ(coarse->rows[0].error, std::abs(coarse->rows[0].force - normal->rows[0].force));
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
