#include "common/plot/line_plot.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp::plot {
namespace {

TEST(LinePlotTest, DrawsEveryCurveAndLeavesOutWhatIsNoNumber) {
  const std::string svg = curves_svg({.title = "t", .x_name = "x", .y_name = "y"},
                                     {{.name = "one", .x = {1, 2}, .y = {1, std::nan("")}},
                                      {.name = "two", .x = {1, 2}, .y = {0, 3}}});
  EXPECT_NE(svg.find(">one<"), std::string::npos);
  EXPECT_NE(svg.find(">two<"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
}

TEST(LinePlotTest, ACurveWithoutNameHasNoPlaceInTheLegend) {
  const Curve points{.name = "", .x = {1, 2}, .y = {1, 2}, .mark = Mark::Points};
  const std::string svg = curves_svg({.title = "t"}, {points});
  std::size_t circles = 0;
  for (auto at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1)) {
    ++circles;
  }
  EXPECT_EQ(circles, 2U);
}

TEST(LinePlotTest, EmptyPlotsAndSinglePointsAreDrawn) {
  for (const std::string& svg : {curves_svg({.title = "t"}, {}),
                                 curves_svg({.title = "t"}, {{.name = "p", .x = {1}, .y = {1}}})}) {
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
  }
}

TEST(LinePlotTest, TicksAreRoundAndCoverTheRange) {
  const auto ticks = round_ticks(0.0594, 0.0921, 5);
  EXPECT_LE(ticks.front(), 0.0594);
  EXPECT_GE(ticks.back(), 0.0921);
  EXPECT_GE(ticks.size(), 4U);
  EXPECT_LE(ticks.size(), 9U);
  EXPECT_NEAR(ticks[1] - ticks[0], 0.01, 1e-12);
  EXPECT_EQ(round_ticks(0, 4, 5).back(), 4);
}

TEST(LinePlotTest, NumbersBelowALogarithmicAxisDoNotRunIntoEachOther) {
  const auto drawn = [](std::vector<double> x) {
    std::vector<double> y(x.size(), 1);
    return curves_svg({.x_logarithmic = true}, {{.x = std::move(x), .y = std::move(y)}});
  };
  const std::string apart = drawn({12, 30, 100});
  EXPECT_NE(apart.find(">12<"), std::string::npos);
  EXPECT_NE(apart.find(">30<"), std::string::npos);
  const std::string close = drawn({12, 12.5, 30, 100});
  EXPECT_EQ(close.find(">12.5<"), std::string::npos);
  EXPECT_NE(close.find(">20<"), std::string::npos);
  EXPECT_NE(drawn({12, 12.5}).find(">12<"), std::string::npos) << "no round number between";
}

}  // namespace
}  // namespace palp::plot
