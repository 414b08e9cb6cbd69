#include "depth/lateral_shape.h"

#include <cmath>

#include <gtest/gtest.h>

#include "depth/depth_database.h"

namespace palp::depth {
namespace {

/// g = exp(-fall offset^2), with a fall that the axes interpolate without an error.
double exact(double depth, double radius, double ratio, double offset, double indentation) {
  const double fall = 1 + std::log(depth / 1e-3) + 0.5 * std::log(radius / 1e-3) +
                      ratio_coordinate(ratio) - 0.3 * offset + 50 * indentation;
  return std::exp(-fall * offset * offset);
}

fem::ShapeTable some_table() {
  fem::ShapeTable table{.depths = {3e-3, 6e-3, 12e-3},
                        .radii = {4e-3, 10e-3},
                        .ratios = {3, 30},
                        .offsets = {0.1, 0.4, 0.7, 1},
                        .indentations = {1e-3, 4e-3},
                        .shape = {}};
  for (const double depth : table.depths) {
    for (const double radius : table.radii) {
      for (const double ratio : table.ratios) {
        for (const double offset : table.offsets) {
          for (const double indentation : table.indentations) {
            table.shape.push_back(
                static_cast<float>(exact(depth, radius, ratio, offset, indentation)));
          }
        }
      }
    }
  }
  return table;
}

TEST(LateralShapeTest, BetweenTheTablesPointsTheFallIsInterpolated) {
  const fem::ShapeTable table = some_table();
  ASSERT_TRUE(fem::check(table));
  const LateralShape shape{table};
  struct Place {
    double depth, radius, ratio, offset, indentation;
  };
  for (const Place& at : {Place{6e-3, 10e-3, 3, 6.4e-3, 1e-3},
                          {4e-3, 5e-3, 9, 3e-3, 2.3e-3},
                          {8.1e-3, 9.9e-3, 29, 12e-3, 3.9e-3}}) {
    const double wanted =
        exact(at.depth, at.radius, at.ratio, at.offset / (at.depth + at.radius), at.indentation);
    const auto ball = shape.of(at.depth, at.radius, at.ratio);
    EXPECT_NEAR(shape.share(ball, at.offset, at.indentation), wanted, 1e-6) << at.offset;
    EXPECT_EQ(shape.share(ball, -at.offset, at.indentation),
              shape.share(ball, at.offset, at.indentation));
  }
}

TEST(LateralShapeTest, BeyondTheTableItFallsAsTheSixthPowerAndEndsWithoutAJump) {
  const LateralShape shape{some_table()};
  const auto ball = shape.of(5e-3, 5e-3, 10);  // its centre 10 mm deep: the table ends at 10 mm
  EXPECT_EQ(shape.share(ball, 0, 2e-3), 1);
  EXPECT_NEAR(shape.share(ball, 20e-3, 2e-3) / shape.share(ball, 10e-3, 2e-3), 1.0 / 64, 1e-9);
  EXPECT_GT(shape.share(shape.of(1, 1, 1e4), 2e-3, 1), 0);  // outside as at the edge
  const auto wide = shape.of(12e-3, 30e-3, 10);
  for (const double edge : {LateralShape::kFadesFrom, LateralShape::kReach}) {
    EXPECT_NEAR(shape.share(wide, edge - 1e-8, 2e-3), shape.share(wide, edge + 1e-8, 2e-3), 1e-6);
  }
  EXPECT_GT(shape.share(wide, 39e-3, 2e-3), 0);
  EXPECT_EQ(shape.share(wide, 40e-3, 2e-3), 0);
}

// Of the database in the program. Below a thousandth of the effect it is the noise of the solver's
// cells and of 16 bits.
TEST(LateralShapeTest, ItFallsAllTheWayBesideEveryBall) {
  const auto database = default_database();
  ASSERT_TRUE(database);
  ASSERT_TRUE(database->solved_beside());
  for (const double depth : {3e-3, 4.4e-3, 8e-3, 15e-3, 24e-3}) {
    for (const double radius : {3e-3, 6e-3, 9.7e-3, 15.5e-3}) {
      for (const double ratio : {4.0, 30.0, 800.0}) {
        const auto ball = database->shape({.depth = depth, .radius = radius, .ratio = ratio});
        for (const double indentation : {0.3e-3, 1e-3, 2.2e-3, 4e-3}) {
          double last = database->share(ball, 0, indentation);
          EXPECT_EQ(last, 1);
          for (double offset = 0.5e-3; offset < LateralShape::kReach; offset += 0.5e-3) {
            const double here = database->share(ball, offset, indentation);
            ASSERT_GT(here, 0);
            ASSERT_LT(here, last > 1e-3 ? last : 1.1 * last)
                << depth << ' ' << radius << ' ' << ratio << ' ' << offset;
            last = here;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace palp::depth
