#include "depth/paper_estimator.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/depth/tapping.h"

namespace palp::patient {
namespace {

TEST(PaperEstimatorTest, TissueOfAnotherStiffnessIsMeasuredToo) {
  for (const double factor : {0.5, 3.0}) {
    auto phantom = make_phantom("none");
    ASSERT_TRUE(phantom);
    std::vector<ForceRow> rows{phantom->over.rows().begin(), phantom->over.rows().end()};
    for (ForceRow& row : rows) row.force *= factor;
    phantom->over = *ForceTable::make(rows);
    const double expected = hash_of(phantom->over);
    const auto estimates = tap(*phantom, ideal_sensor(), {.taps = 4});
    ASSERT_EQ(estimates.size(), 4U);
    EXPECT_NEAR(median_hash(estimates), expected, 0.02 * expected);
    EXPECT_EQ(estimates.back().verdict, factor < 1 ? DepthVerdict::None : DepthVerdict::Invalid);
  }
}

TEST(PaperEstimatorTest, AShortStrokeIsInvalidAndStillGivesItsHash) {
  const auto phantom = make_phantom("paper-10mm");
  ASSERT_TRUE(phantom);
  const auto shallow = tap(*phantom, ideal_sensor(), {.taps = 1, .indentation = 2.2e-3});
  ASSERT_EQ(shallow.size(), 1U);
  EXPECT_EQ(shallow[0].verdict, DepthVerdict::Invalid);
  EXPECT_EQ(shallow[0].reason, DepthReason::StrokeTooShort);
  EXPECT_GT(shallow[0].hash, 0.05);
  const auto deep = tap(*phantom, ideal_sensor(), {.taps = 1, .indentation = 2.8e-3});
  ASSERT_EQ(deep.size(), 1U);
  EXPECT_EQ(deep[0].verdict, DepthVerdict::Found);
}

TEST(PaperEstimatorTest, JudgesTheHashOfAStrokeThatIsFitForIt) {
  const depth::PaperEstimator estimator{{}};
  depth::Stroke stroke;
  stroke.number = 3;
  stroke.indentation_max = 3e-3;
  stroke.hash = 0.07;
  const DepthEstimate found = estimator.judge(stroke);
  EXPECT_EQ(found.verdict, DepthVerdict::Found);
  EXPECT_EQ(found.depth, depth::depth_of_hash(0.07));
  EXPECT_EQ(found.depth_low, found.depth);
  EXPECT_EQ(found.number, 3U);
  stroke.reason = DepthReason::TooNoisy;
  const DepthEstimate refused = estimator.judge(stroke);
  EXPECT_EQ(refused.verdict, DepthVerdict::Invalid);
  EXPECT_EQ(refused.reason, DepthReason::TooNoisy);
  EXPECT_EQ(refused.depth, 0);
}

}  // namespace
}  // namespace palp::patient
