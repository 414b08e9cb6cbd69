#include "fem/off_axis_curve.h"

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/fem/off_axis_reference.h"

namespace palp::fem {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

CurveRequest request_of(const Specimen& specimen, Model model, std::vector<double> indentations) {
  return {.specimen = specimen,
          .model = model,
          .accuracy = Accuracy::Coarse,
          .indentations = std::move(indentations),
          .with_error = false};
}

// The slow tests compare all of an independent three-dimensional code's places.
TEST(OffAxisCurveTest, FiniteStrainBesideABallAgreesWithThreeDimensions) {
  auto request = request_of(ball(5, 5, 856), Model::NeoHookean, {1e-3, 2e-3});
  const auto with = solve_off_axis_curve(request, {.offset = 5e-3});
  request.specimen.inclusion.shape = InclusionShape::None;
  const auto without = solve_curve(request);
  ASSERT_TRUE(with && without);
  int compared = 0;
  for (const Reference& row : read_off_axis("neo_ball_a5_d5_k856")) {
    if (row.tilt != 0 || row.indentation > 2) continue;
    const auto i = static_cast<std::size_t>(std::lround(row.indentation)) - 1;
    const double found = (*with)[i].force / without->rows[i].force;
    EXPECT_NEAR(found / (row.force / row.plain), 1, 0.007) << row.indentation;
    ++compared;
  }
  EXPECT_EQ(compared, 2);
}

TEST(OffAxisCurveTest, OnTheAxisItIsTheCurve) {
  const auto request = request_of(ball(8, 6, 100), Model::Linear, {2e-3, 0, 1e-3});
  const auto wanted = solve_curve(request);
  const auto found = solve_off_axis_curve(request, {});
  ASSERT_TRUE(wanted && found);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_DOUBLE_EQ((*found)[i].indentation, wanted->rows[i].indentation);
    EXPECT_NEAR((*found)[i].force, wanted->rows[i].force, 1e-12);
    EXPECT_NEAR((*found)[i].contact_radius, wanted->rows[i].contact_radius, 1e-12);
  }
}

// A sphere has no orientation: only the part of the way along the normal presses, and only the
// force's part along the way is felt.
TEST(OffAxisCurveTest, ATiltedWayIsAShorterOneThatWalks) {
  const double tilt = 10 * kDegree;
  const double depth = 2e-3;
  const auto specimen = ball(5, 5, 856);
  const auto tilted = solve_off_axis_curve(request_of(specimen, Model::Linear, {depth}),
                                           {.offset = 3e-3, .tilt = tilt});
  const auto straight =
      solve_off_axis_curve(request_of(specimen, Model::Linear, {depth * std::cos(tilt)}),
                           {.offset = 3e-3 + depth * std::sin(tilt)});
  ASSERT_TRUE(tilted && straight);
  EXPECT_NEAR((*tilted)[0].force / (std::cos(tilt) * (*straight)[0].force), 1, 1e-9);
  EXPECT_EQ((*tilted)[0].indentation, depth);
  const auto away = solve_off_axis_curve(request_of(specimen, Model::Linear, {depth}),
                                         {.offset = 3e-3, .tilt = -tilt});
  ASSERT_TRUE(away);
  EXPECT_GT((*away)[0].force, (*tilted)[0].force);  // it walks towards the ball
}

TEST(OffAxisCurveTest, ADomeAndAHollowMultiplyThePlainForce) {
  const auto specimen = ball(5, 5, 856);
  const auto request = request_of(specimen, Model::Linear, {2e-3});
  const auto flat = solve_off_axis_curve(request, {.offset = 3e-3});
  const auto nearly = solve_off_axis_curve(request, {.offset = 3e-3, .surface_curvature = 1e-6});
  const auto dome = solve_off_axis_curve(request, {.offset = 3e-3, .surface_curvature = 16});
  const auto hollow = solve_off_axis_curve(request, {.offset = 3e-3, .surface_curvature = -16});
  ASSERT_TRUE(flat && nearly && dome && hollow);
  EXPECT_NEAR((*nearly)[0].force / (*flat)[0].force, 1, 1e-6);
  EXPECT_LT((*dome)[0].force, 0.98 * (*flat)[0].force);
  EXPECT_LT((*dome)[0].contact_radius, 0.98 * (*flat)[0].contact_radius);
  EXPECT_GT((*hollow)[0].force, 1.02 * (*flat)[0].force);
}

TEST(OffAxisCurveTest, EveryRefusalNamesValueAndLimit) {
  struct Refusal {
    Specimen specimen;
    Approach approach;
    const char* sentence;
  };
  Specimen column = ball(5, 5, 856);
  column.inclusion.shape = InclusionShape::Column;
  Specimen thin;
  thin.block.height = 12e-3;
  Specimen punch;
  punch.indenter.shape = IndenterShape::FlatPunch;
  for (const auto& [specimen, approach, sentence] : std::vector<Refusal>{
           {column, {.offset = 1e-3}, "a ball or none, not a column"},
           {punch, {.offset = 1e-3}, "the tip is a sphere"},
           {thin, {.offset = 1e-3}, "12 mm, expected at least 25 mm"},
           {{}, {.offset = 36e-3}, "36 mm beside the axis, expected at most 35 mm"},
           {{}, {.tilt = 30 * kDegree}, "30 deg, expected at most 20 deg"},
           {{}, {.surface_curvature = -100}, "-10 mm, expected at least 20 mm"},
           {ball(27, 0.3, 856), {.offset = 1e-3}, "0.3 mm below the surface, expected deeper"}}) {
    const auto curve =
        solve_off_axis_curve(request_of(specimen, Model::Linear, {0.1e-3}), approach);
    ASSERT_FALSE(curve) << sentence;
    EXPECT_NE(curve.error().text.find(sentence), std::string::npos) << curve.error().text;
  }
}

}  // namespace
}  // namespace palp::fem
