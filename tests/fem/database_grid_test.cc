#include "fem/database_grid.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fem/database_builder.h"

namespace palp::fem {
namespace {

TEST(DatabaseGridTest, OfThePapersBlockItIsTheDefault) {
  const DepthGrid grid = grid_for(Block{}, 5e-3, 0.49, Detail::Normal);
  EXPECT_TRUE(grid == default_grid());
  EXPECT_TRUE(check(grid));
}

// A lab's own block, 60 mm wide and 30 mm high, with a tip of 4 mm.
DepthGrid thin_grid(Detail detail) {
  return grid_for({.half_width = 30e-3, .height = 30e-3, .youngs_modulus = 25e3, .poisson = 0.45},
                  4e-3,
                  0.49,
                  detail);
}

TEST(DatabaseGridTest, InAThinBlockItHoldsWhatFitsAndIsPressedNoDeeperThanTheTip) {
  const DepthGrid grid = thin_grid(Detail::Coarse);
  ASSERT_TRUE(check(grid));
  EXPECT_EQ(grid.indentations.back(), 4e-3);
  EXPECT_GT(grid.radii.back(), 8e-3);
  EXPECT_LT(grid.radii.back(), 13e-3) << "at the least depth 26 mm of 30 would be inclusion";
  EXPECT_LT(grid.depths.back(), 24e-3);
  EXPECT_LT(cells_of(grid).size(), cells_of(thin_grid(Detail::Normal)).size() / 2);
}

TEST(DatabaseGridTest, AFileMayGiveAxesOfItsOwn) {
  const auto grid =
      with_axes(thin_grid(Detail::Coarse), "# mine\nradius_mm 4 6.5\n\nratio 10 100 # hard\n");
  ASSERT_TRUE(grid) << grid.error().text;
  ASSERT_EQ(grid->radii.size(), 2U);
  EXPECT_NEAR(grid->radii[1], 6.5e-3, 1e-12);
  EXPECT_EQ(grid->ratios, (std::vector<double>{10, 100}));
  EXPECT_EQ(grid->depths, thin_grid(Detail::Coarse).depths);
  struct Refusal {
    const char* text;
    const char* sentence;
  };
  for (const auto& [text, sentence] :
       std::vector<Refusal>{{"radius_mm 4 6.5\nwidth_mm 3 4", "line 2: \"width_mm\" is no axis"},
                            {"ratio 10 x", "line 1: \"x\" is no number above 0"},
                            {"ratio 10", "line 1: ratio is not two or more rising numbers"},
                            {"depth_mm 5 5", "is not two or more rising numbers"}}) {
    const auto refused = with_axes(thin_grid(Detail::Coarse), text);
    ASSERT_FALSE(refused) << text;
    EXPECT_NE(refused.error().text.find(sentence), std::string::npos) << refused.error().text;
  }
}

TEST(DatabaseGridTest, WhatCannotBeReadAgainIsRefusedBeforehand) {
  const auto refusal = [](const char* text) {
    const auto grid = with_axes(thin_grid(Detail::Coarse), text);
    const auto ok = check(*grid);
    return ok ? std::string{} : ok.error().text;
  };
  EXPECT_NE(refusal("radius_mm 4 14").find("an inclusion of radius 14 mm fits at fewer than two"),
            std::string::npos);
  EXPECT_NE(refusal("indentation_mm 1 7").find("expected at most 4.8 mm"), std::string::npos);
  EXPECT_NE(refusal("ratio 0.5 10").find("not above 1"), std::string::npos);
  EXPECT_EQ(refusal("radius_mm 4 6"), "");
}

TEST(DatabaseGridTest, TheForecastGrowsWithGridAndMesh) {
  const Forecast coarse = forecast(thin_grid(Detail::Coarse), Detail::Coarse, true);
  const Forecast normal = forecast(default_grid(), Detail::Normal, true);
  const Forecast fine = forecast(default_grid(), Detail::Fine, true);
  EXPECT_EQ(normal.curves, 1416U);
  EXPECT_NEAR(normal.work, 470 * 2 + 415, 15);
  EXPECT_NEAR(normal.error_share, 1.2e-3, 1e-9);
  EXPECT_LT(coarse.work, 0.3 * normal.work);
  EXPECT_GT(coarse.error_share, 4 * normal.error_share);
  EXPECT_GT(fine.work, 2 * normal.work);
  const std::string text = forecast_text(normal, 2);
  EXPECT_EQ(text,
            "1416 curves and 288 balls beside their axis; about 12 min on 2 processors, a file of "
            "about 132 kB, interpolation within about 0.12 % of the force");
}

TEST(DatabaseGridTest, TheShapesAxesCoverTheGrid) {
  for (const DepthGrid& grid : {default_grid(), thin_grid(Detail::Coarse)}) {
    const ShapeTable axes = shape_axes(grid, Detail::Normal);
    EXPECT_NEAR(axes.depths.back(), grid.depths.back(), 1e-9);
    EXPECT_EQ(axes.radii, grid.radii);
    EXPECT_EQ(axes.ratios.back(), grid.ratios.back());
    EXPECT_EQ(axes.indentations.back(), grid.indentations.back());
  }
}

}  // namespace
}  // namespace palp::fem
