// Goal: the map on a terminal shows where an inclusion is likely. Method: a few cells.
#include "review/map_drawing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::review {
namespace {

std::vector<MapCell> three_by_two() {
  std::vector<MapCell> cells;
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 3; ++column) {
      cells.push_back({.place = {2e-3 * column, 2e-3 * row},
                       .stiffness = 1,
                       .inclusion = column == 1 && row == 1 ? 1.0 : 0.0});
    }
  }
  return cells;
}

TEST(MapDrawingTest, LikelyCellsAreDarkAndTheTopIsFarthestAlongY) {
  const MapReport report{.stop = MapStop::Known};
  EXPECT_THAT(map_drawing(report, three_by_two()),
              testing::HasSubstr("   2.0 |  @@  |\n   0.0 |      |\ny mm    x 0.0 to 4.0 mm\n"));
}

TEST(MapDrawingTest, TheAxisAndTheNextTapAreMarked) {
  const MapReport report{.verdict = DepthVerdict::Found,
                         .x = {.median = 2.3e-3},
                         .y = {.median = 1.8e-3},
                         .next = {3.9e-3, 0.1e-3},
                         .stop = MapStop::GoOn};
  EXPECT_THAT(map_drawing(report, three_by_two()),
              testing::HasSubstr("   2.0 |  +   |\n   0.0 |    x |\n"));
}

TEST(MapDrawingTest, NoMapIsNotDrawn) { EXPECT_EQ(map_drawing({}, {}), ""); }

}  // namespace
}  // namespace palp::review
