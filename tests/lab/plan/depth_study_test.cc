// Goal: the Monte Carlo of the depth estimator says what it ran, and its bound behaves as one.
// Method: a few cases, and the information of single samples against what theory says of it.
#include "lab/plan/depth_study.h"

#include <cmath>

#include <gtest/gtest.h>

#include "lab/depth_command.h"

namespace palp::lab {
namespace {

TEST(DepthBoundTest, StepsTakeInformationAndNoStepsNone) {
  EXPECT_NEAR(sample_information(0.3, 0.015, 0), 1 / (0.015 * 0.015), 1e-6);
  for (const double force : {0.1, 0.11, 0.125, 0.3}) {
    EXPECT_LT(sample_information(force, 0.015, 0.05), 1 / (0.015 * 0.015));
  }
  // Wide noise does not feel the steps.
  EXPECT_NEAR(sample_information(0.1, 0.5, 0.05) * 0.25, 1, 0.01);
}

TEST(DepthBoundTest, MoreTapsAndShallowerInclusionsAreKnownBetter) {
  const auto database = depth::default_database();
  ASSERT_TRUE(database);
  depth::DepthPrior prior;
  prior.radius_min = prior.radius_max = 15e-3;
  prior.ratio_min = prior.ratio_max = 856;
  const auto bound = [&](double depth, int taps) {
    return depth_bound(*database,
                       {.depth = depth, .radius = 15e-3, .ratio = 856},
                       prior,
                       {},
                       {},
                       motion_of({.taps = taps, .reference_taps = taps}));
  };
  EXPECT_LT(bound(10e-3, 8).depth_stddev, bound(10e-3, 4).depth_stddev);
  EXPECT_LT(bound(6e-3, 4).depth_stddev, bound(12e-3, 4).depth_stddev);
  EXPECT_GT(bound(6e-3, 4).signal, bound(12e-3, 4).signal);
}

TEST(DepthStudyTest, ACaseDependsOnSeedAndIndexAlone) {
  const DepthStudy study{.depths = {10e-3}, .repeats = 2, .seed = 7};
  const auto one = run_case(study, 1);
  const auto again = run_case(study, 1);
  ASSERT_TRUE(one && again);
  EXPECT_EQ(one->strokes, 4U);
  EXPECT_EQ(one->estimate, again->estimate);
  EXPECT_NEAR(one->estimate, 10e-3, 1.5e-3);
  EXPECT_LT(one->low, one->estimate);
  EXPECT_GT(one->high, one->estimate);
}

TEST(DepthStudyTest, ReportsNameTheirSchemaAndCountCases) {
  const DepthStudy study{.count = 1, .seed = 3};
  EXPECT_EQ(case_count(study), 2U);
  const auto with = run_case(study, 0);
  const auto without = run_case(study, 1);
  ASSERT_TRUE(with && without);
  EXPECT_TRUE(with->inclusion);
  EXPECT_FALSE(without->inclusion);
  const std::string report = depth_report(study, {*with, *without}, "rows.csv");
  EXPECT_NE(report.find("palp.depth/1"), std::string::npos);
  EXPECT_NE(report.find("\"plain_count\": 1"), std::string::npos);
  EXPECT_NE(report.find("\"cases_csv\": \"rows.csv\""), std::string::npos);
}

TEST(DepthCommandTest, RefusesDepthsThatAreNone) {
  for (const char* text : {"", "x", "5,", "2", "28", "5,,6"}) {
    DepthFlags flags;
    flags.depths_mm = text;
    if (flags.depths_mm.empty()) continue;
    EXPECT_EQ(run_depth(flags).code, config::ExitCode::BadInput) << text;
  }
}

}  // namespace
}  // namespace palp::lab
