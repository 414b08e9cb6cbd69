#include "fem/shape_table.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp::fem {
namespace {

/// g = exp(-fall offset^2), with a fall that goes as the table's axes are interpolated.
double exact(double depth, double radius, double ratio, double offset, double indentation) {
  const double fall = 1 + std::log(depth / 1e-3) + 0.5 * std::log(radius / 1e-3) +
                      (ratio - 1) / (ratio + 1.5) - 0.3 * offset + 50 * indentation;
  return std::exp(-fall * offset * offset);
}

ShapeTable some_table() {
  ShapeTable table{.depths = {3e-3, 6e-3, 12e-3},
                   .radii = {4e-3, 10e-3},
                   .ratios = {3, 30},
                   .offsets = {0.1, 0.4, 1},
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

TEST(ShapeTableTest, BetweenItsPointsItIsLinearInTheFallOverEveryAxis) {
  const ShapeTable table = some_table();
  ASSERT_TRUE(check(table));
  for (const ShapeTable::Place& place : {ShapeTable::Place{6e-3, 10e-3, 3, 6.4e-3, 1e-3},
                                         {4e-3, 5e-3, 9, 3e-3, 2.3e-3},
                                         {8.1e-3, 9.9e-3, 29, 12e-3, 3.9e-3},
                                         {11e-3, 4.2e-3, 5, -9e-3, 1.4e-3}}) {
    const double offset = std::abs(place.offset) / (place.depth + place.radius);
    EXPECT_NEAR(table.at(place),
                exact(place.depth, place.radius, place.ratio, offset, place.indentation),
                1e-6);
  }
}

TEST(ShapeTableTest, AboveTheBallNothingIsMissingAndFarAwayNothingIsLeft) {
  const ShapeTable table = some_table();
  ShapeTable::Place place{5e-3, 5e-3, 10, 0, 2e-3};
  EXPECT_EQ(table.at(place), 1);
  place.offset = 10e-3;
  const double edge = table.at(place);
  place.offset = 20e-3;
  EXPECT_NEAR(table.at(place) / edge, 1.0 / 64, 1e-9);
  place.offset = 2e-3;
  const double inside = table.at(place);
  EXPECT_LT(inside, 1);
  place.ratio = 1e4;
  place.indentation = 1;
  EXPECT_GT(table.at(place), 0);  // outside of the grid as at its edge
}

TEST(ShapeTableTest, RefusesAnAxisThatDoesNotRiseAndAValueThatIsNone) {
  ShapeTable table = some_table();
  table.shape.pop_back();
  EXPECT_FALSE(check(table));
  table.shape.push_back(1.5F);
  EXPECT_FALSE(check(table));
  table = some_table();
  std::swap(table.offsets[0], table.offsets[1]);
  EXPECT_FALSE(check(table));
  table = some_table();
  table.ratios[0] = 1;
  EXPECT_FALSE(check(table));
  table = some_table();
  table.radii.clear();
  EXPECT_FALSE(check(table));
}

}  // namespace
}  // namespace palp::fem
