#include "lab/report/depth_cases.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::lab {
namespace {

DepthStudy study_of_two() {
  DepthStudy study{.depths = {5e-3, 1.0 / 3}, .seed = 7};
  study.coupling = "mmt";
  study.estimator = depth::EstimatorKind::Paper;
  return study;
}

DepthCase case_of(std::uint32_t index) {
  DepthCase one;
  one.index = index;
  one.inclusion = true;
  one.knowledge = Knowledge::Ball;
  one.verdict = DepthVerdict::Found;
  one.estimate = 0.1 + 0.2;
  one.bound = std::numeric_limits<double>::infinity();
  one.hash = 1e-310;
  one.strokes = 4;
  return one;
}

std::string file_of(const DepthStudy& study, const std::vector<std::uint32_t>& indices) {
  std::string text = depth_cases_header();
  for (const std::uint32_t index : indices) {
    text += depth_case_row(study, case_of(index), "a, \"compiler\"");
  }
  return text;
}

TEST(DepthCasesTest, EveryNumberComesBackToTheBit) {
  DepthRows rows;
  const auto read = read_depth_cases(file_of(study_of_two(), {1, 0}), "f", rows);
  ASSERT_TRUE(read) << read.error().text;
  ASSERT_TRUE(check_complete(rows));
  EXPECT_EQ(digest_of(rows.cases), digest_of({case_of(0), case_of(1)}));
  EXPECT_EQ(rows.study.depths, study_of_two().depths);
  EXPECT_EQ(rows.study.coupling, "mmt");
  EXPECT_EQ(rows.study.estimator, depth::EstimatorKind::Paper);
  EXPECT_EQ(rows.makers, std::set<std::string>{"a   compiler "});
}

TEST(DepthCasesTest, WhatIsMissingTwiceOrTooManyIsNamed) {
  const auto fault = [](const std::vector<std::uint32_t>& indices) {
    DepthRows rows;
    EXPECT_TRUE(read_depth_cases(file_of(study_of_two(), indices), "f", rows));
    const auto whole = check_complete(rows);
    return whole ? std::string{} : whole.error().text;
  };
  EXPECT_EQ(fault({}), "there is no case in these files");
  EXPECT_THAT(fault({0}), testing::StartsWith("case 1 of 2 is missing"));
  EXPECT_THAT(fault({1}), testing::StartsWith("case 0 of 2 is missing"));
  EXPECT_EQ(fault({0, 0, 1}), "case 0 of 2 is given twice");
  EXPECT_EQ(fault({0, 1, 2}), "case 2 of 2 is none of them");
}

TEST(DepthCasesTest, RowsOfAnotherStudyOrCutOnesAreRefused) {
  DepthRows rows;
  ASSERT_TRUE(read_depth_cases(file_of(study_of_two(), {0}), "f", rows));
  DepthStudy other = study_of_two();
  other.seed = 8;
  const auto refused = read_depth_cases(file_of(other, {1}), "g", rows);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text.find("g: line 2 is of another study"), std::string::npos);
  std::string cut = file_of(study_of_two(), {1});
  cut.resize(cut.size() - 20);
  EXPECT_FALSE(read_depth_cases(cut, "g", rows));
  std::string changed = file_of(study_of_two(), {1});
  changed.replace(changed.find("0.3000"), 3, "0.4");
  EXPECT_FALSE(read_depth_cases(changed, "g", rows));
  EXPECT_FALSE(read_depth_cases("index,seed\n", "g", rows));
  EXPECT_FALSE(is_depth_cases("index,seed\n"));
}

}  // namespace
}  // namespace palp::lab
