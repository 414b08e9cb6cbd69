// Goal: curves beside the axis agree with an independent three-dimensional code.
// Method: reference/off_axis/ holds that code's forces with and without the ball on one mesh each.
// Its mesh makes forces too high, so in L1 the shape over the offset is compared; the tolerances
// are the targets of this comparison.
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "fem/off_axis_contact.h"
#include "fem/off_axis_curve.h"
#include "tests/fem/off_axis_reference.h"

namespace palp::fem {
namespace {

struct File {
  const char* name;
  double radius_mm;
  double depth_mm;
  double ratio;
};

class OffAxisShapeTest : public testing::TestWithParam<File> {};

TEST_P(OffAxisShapeTest, TheShapeOverTheOffsetAgreesWithThreeDimensions) {
  const auto& [name, radius_mm, depth_mm, ratio] = GetParam();
  OffAxisContact contact{ball(radius_mm, depth_mm, ratio), 20e-3, Accuracy::Normal};
  // ln F / F_plain on the axis, by indentation: theirs and ours. Rows on the axis come first.
  std::map<double, std::pair<double, double>> above;
  int compared = 0;
  for (const Reference& row : read_off_axis(name)) {
    if (row.indentation < 1) continue;
    const auto excess = contact.excess(row.indentation * 1e-3, row.offset * 1e-3);
    ASSERT_TRUE(excess) << excess.error().text;
    const double wanted = std::log(row.force / row.plain);
    if (row.offset == 0) {
      above[row.indentation] = {wanted, *excess};
      continue;
    }
    const auto& [their_above, our_above] = above.at(row.indentation);
    EXPECT_NEAR(*excess / our_above, wanted / their_above, 0.015)
        << row.offset << ' ' << row.indentation;
    ++compared;
  }
  EXPECT_EQ(compared, 42);
}

INSTANTIATE_TEST_SUITE_P(Balls,
                         OffAxisShapeTest,
                         testing::Values(File{"l1_ball_a5_d5_k856", 5, 5, 856},
                                         File{"l1_ball_a15_d10_k856", 15, 10, 856},
                                         File{"l1_ball_a8_d8_k20", 8, 8, 20},
                                         File{"l1_ball_a10_d15_k100", 10, 15, 100}),
                         [](const auto& file) { return std::string{file.param.name}; });

/// Our force over the plain block's against the reference's, model N.
void compare_finite(const std::string& name,
                    const Specimen& specimen,
                    const Reference& like,
                    double tolerance) {
  const Approach approach{.offset = like.offset * 1e-3,
                          .tilt = like.tilt * std::numbers::pi / 180,
                          .surface_curvature = like.dome > 0 ? 1e3 / like.dome : 0};
  CurveRequest request{.specimen = specimen,
                       .model = Model::NeoHookean,
                       .indentations = {1e-3, 2e-3, 3e-3, 4e-3},
                       .with_error = false};
  const auto with = solve_off_axis_curve(request, approach);
  request.specimen.inclusion.shape = InclusionShape::None;
  const auto without = solve_off_axis_curve(request, approach);
  ASSERT_TRUE(with && without);
  int compared = 0;
  for (const Reference& row : read_off_axis(name)) {
    if (row.tilt != like.tilt || row.dome != like.dome) continue;
    const auto i = static_cast<std::size_t>(std::lround(row.indentation)) - 1;
    const double found = (*with)[i].force / (*without)[i].force;
    EXPECT_NEAR(found / (row.force / row.plain), 1, tolerance) << row.indentation;
    ++compared;
  }
  EXPECT_EQ(compared, 4);
}

TEST(OffAxisReferenceTest, FiniteStrainBesideASmallBallAgreesWithThreeDimensions) {
  compare_finite("neo_ball_a5_d5_k856", ball(5, 5, 856), {.offset = 5}, 0.007);
}

TEST(OffAxisReferenceTest, FiniteStrainBesideALargeBallAgreesWithThreeDimensions) {
  compare_finite("neo_ball_a15_d10_k856", ball(15, 10, 856), {.offset = 10}, 0.007);
}

// The law of a dome keeps the ball's factor; three dimensions let it change by 0.7 %.
TEST(OffAxisReferenceTest, OnADomeTheBallsFactorStays) {
  compare_finite("neo_ball_a15_d10_k856", ball(15, 10, 856), {.dome = 60}, 0.01);
}

// Their mesh of 0.8 mm alone makes the ball's factor 0.8 % too large.
TEST(OffAxisReferenceTest, ATiltedWayAgreesWithThreeDimensions) {
  compare_finite("neo_ball_a5_d5_k856", ball(5, 5, 856), {.tilt = 20}, 0.01);
}

}  // namespace
}  // namespace palp::fem
