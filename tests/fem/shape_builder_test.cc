#include "fem/shape_builder.h"

#include <functional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "fem/off_axis_contact.h"

namespace palp::fem {
namespace {

ShapeTable axes_of(std::vector<double> depths, std::vector<double> radii) {
  return {.depths = std::move(depths),
          .radii = std::move(radii),
          .ratios = {100},
          .offsets = {0.3, 1, 2},
          .indentations = {2e-3},
          .shape = {}};
}

void in_turn(std::size_t count, const std::function<void(std::size_t)>& work) {
  for (std::size_t i = 0; i < count; ++i) work(i);
}

TEST(ShapeBuilderTest, TheTableHoldsWhatTheContactFinds) {
  const DepthGrid grid = default_grid();
  const auto table = solve_shape_table(grid, axes_of({5e-3}, {5e-3}), Accuracy::Coarse, in_turn);
  ASSERT_TRUE(table) << table.error().text;
  ASSERT_TRUE(check(*table));
  Specimen specimen;
  specimen.inclusion = {.shape = InclusionShape::Ball, .depth = 5e-3, .radius = 5e-3, .ratio = 100};
  OffAxisContact contact{specimen, 20e-3, Accuracy::Coarse};
  for (std::size_t i = 0; i < 3; ++i) {  // the ball's centre is 10 mm deep
    const double offset = table->offsets[i] * 10e-3;
    const double wanted = *contact.excess(2e-3, offset) / *contact.excess(2e-3, 0);
    EXPECT_NEAR(table->shape[i], wanted, 2e-4) << offset;
  }
}

// A ball of 18 mm does not fit 24 mm deep, nor an offset of twice its centre's depth.
TEST(ShapeBuilderTest, WhatDoesNotFitIsFilledFromItsNeighbours) {
  const DepthGrid grid = default_grid();
  const ShapeTable axes = axes_of({24e-3}, {5e-3, 18e-3});
  const auto large = solve_shape(grid, axes, 0, 1, 0, Accuracy::Coarse);
  const auto small = solve_shape(grid, axes, 0, 0, 0, Accuracy::Coarse);
  ASSERT_TRUE(large && small);
  EXPECT_EQ(*large, *small);
  EXPECT_LT((*small)[2], (*small)[1]);
  EXPECT_GT((*small)[2], 0);
}

}  // namespace
}  // namespace palp::fem
