#include "study/raster.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace palp::study {
namespace {

// Wherever a ball is, a place of the raster has found it, and a coarser one would not do.
TEST(RasterTest, LeavesNothingOut) {
  for (const SearchArea area : {SearchArea{.side = 40e-3, .within = 8e-3},
                                SearchArea{.side = 40e-3, .within = 10e-3},
                                SearchArea{.side = 30e-3, .within = 15e-3},
                                SearchArea{.side = 60e-3, .within = 5e-3}}) {
    const auto places = raster(area);
    double worst = 0;
    for (int i = 0; i <= 60; ++i) {
      for (int j = 0; j <= 60; ++j) {
        const Place ball{area.side * (i / 60.0 - 0.5), area.side * (j / 60.0 - 0.5)};
        double nearest = 1;
        for (const Place& one : places) nearest = std::min(nearest, distance(one, ball));
        worst = std::max(worst, nearest);
      }
    }
    EXPECT_LE(worst, area.within + 1e-12);
    const double rows = std::sqrt(static_cast<double>(places.size()));
    EXPECT_GT(area.side / (rows - 1) / std::sqrt(2.0), area.within * (1 - 1e-9));
    EXPECT_NEAR(length_of(places), area.side / rows * static_cast<double>(places.size() - 1), 1e-12)
        << "from one place to its neighbour";
  }
}

TEST(RasterTest, EndsWhereTheTimeDoes) {
  const SearchArea area{.side = 40e-3, .within = 8e-3, .limit = 20};
  EXPECT_EQ(raster_in_time(area, 1).size(), raster(area).size());
  EXPECT_EQ(raster_in_time(area, 5).size(), 4U);
  EXPECT_EQ(raster_in_time(area, 50).size(), 1U);
}

}  // namespace
}  // namespace palp::study
