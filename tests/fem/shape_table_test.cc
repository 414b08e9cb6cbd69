#include "fem/shape_table.h"

#include <utility>

#include <gtest/gtest.h>

namespace palp::fem {
namespace {

ShapeTable some_table() {
  ShapeTable table{.depths = {3e-3, 6e-3},
                   .radii = {4e-3, 10e-3},
                   .ratios = {3, 30},
                   .offsets = {0.1, 0.4, 1},
                   .indentations = {1e-3, 4e-3},
                   .shape = {}};
  table.shape.assign(2 * 2 * 2 * table.ball_size(), 0.5F);
  return table;
}

TEST(ShapeTableTest, RefusesAnAxisThatDoesNotRiseAndAValueThatIsNone) {
  ShapeTable table = some_table();
  EXPECT_TRUE(check(table));
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
