#include "judge/depth_statement.h"

#include <gtest/gtest.h>

namespace palp::judge {
namespace {

TEST(DepthStatementTest, AFoundDepthWithAnInterval) {
  const DepthStatement all = statement_of({.place = {},
                                           .verdict = DepthVerdict::Found,
                                           .depth = 0.010,
                                           .depth_stddev = 0.001,
                                           .depth_low = 0.008,
                                           .depth_high = 0.013});
  EXPECT_EQ(all.verdict, DepthVerdict::Found);
  EXPECT_EQ(all.depth, 0.010);
  EXPECT_EQ(all.stddev, 0.001);
  EXPECT_EQ(all.low, 0.008);
  EXPECT_EQ(all.high, 0.013);
  EXPECT_FALSE(all.excluded);
  EXPECT_FALSE(all.says.empty());
}

TEST(DepthStatementTest, WithoutErrorBarsThereIsNoInterval) {
  const DepthStatement bare = statement_of({.place = {},
                                            .verdict = DepthVerdict::Found,
                                            .depth = 0.010,
                                            .depth_low = 0.010,
                                            .depth_high = 0.010});
  EXPECT_EQ(bare.depth, 0.010);
  EXPECT_FALSE(bare.stddev);
  EXPECT_FALSE(bare.low);
  EXPECT_FALSE(bare.high);
}

TEST(DepthStatementTest, WithoutAnInclusionOnlyWhatIsExcluded) {
  const DepthStatement none =
      statement_of({.place = {}, .verdict = DepthVerdict::None, .depth_low = 0.012});
  EXPECT_FALSE(none.depth);
  EXPECT_FALSE(none.low);
  EXPECT_EQ(none.excluded, 0.012);
  EXPECT_FALSE(statement_of({.place = {}, .verdict = DepthVerdict::None}).excluded);
}

TEST(DepthStatementTest, WhatIsInvalidHasNoNumbers) {
  const DepthStatement invalid = statement_of({.place = {},
                                               .verdict = DepthVerdict::Invalid,
                                               .depth = 0.010,
                                               .depth_stddev = 0.001,
                                               .depth_low = 0.008,
                                               .depth_high = 0.013});
  EXPECT_FALSE(invalid.depth || invalid.low || invalid.high || invalid.stddev || invalid.excluded);
}

}  // namespace
}  // namespace palp::judge
