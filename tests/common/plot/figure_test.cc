#include "common/plot/figure.h"

#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "common/plot/svg_text.h"

namespace palp::plot {
namespace {

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

std::string drawn(Panel panel, const char* style = "screen") {
  return figure_svg({.title = "t", .panels = {std::move(panel)}}, *style_of(style));
}

/// [pt], the attribute's value in the first element that begins so after `from`.
double number_in(const std::string& svg, const std::string& element, const std::string& name) {
  const auto at = svg.find(element);
  if (at == std::string::npos) return std::nan("");
  const auto value = svg.find(' ' + name + "=\"", at);
  return std::strtod(svg.c_str() + value + name.size() + 3, nullptr);
}

/// [pt], where a word is written: its "x" or "y".
double place_of(const std::string& svg, const std::string& word, const std::string& name) {
  const auto at = svg.find('>' + word + '<');
  if (at == std::string::npos) return std::nan("");
  return number_in(svg.substr(svg.rfind("<text", at)), "<text", name);
}
double height_of(const std::string& svg, const std::string& word) {
  return place_of(svg, word, "y");
}

TEST(FigureTest, DrawsEveryCurveAndLeavesOutWhatIsNoNumber) {
  const std::string svg = drawn({.axes = {.x_name = "x", .y_name = "y"},
                                 .curves = {{.name = "one", .x = {1, 2}, .y = {1, std::nan("")}},
                                            {.name = "two", .x = {1, 2}, .y = {0, 3}}}});
  EXPECT_NE(svg.find(">one<"), std::string::npos);
  EXPECT_NE(svg.find(">two<"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
}

TEST(FigureTest, WhatIsNoNumberIsAGapInALine) {
  const std::string svg =
      drawn({.curves = {{.x = {1, 2, 3, 4, 5}, .y = {1, 1, std::nan(""), 2, 2}}}});
  EXPECT_EQ(count(svg, "<polyline"), 2U);
}

TEST(FigureTest, ACurveWithoutNameHasNoPlaceInTheLegend) {
  const std::string svg = drawn({.curves = {{.x = {1, 2}, .y = {1, 2}, .mark = Mark::Points}}});
  EXPECT_EQ(count(svg, "<circle"), 2U);
}

TEST(FigureTest, TheLegendStandsAboveTheAxesWhateverItsLength) {
  for (const Style& style : kStyles) {
    Panel panel{.axes = {.y_name = "y"}};
    for (int i = 0; i < 7; ++i) {
      panel.curves.push_back(
          {.name = "a name of some length " + std::to_string(i), .x = {0, 1}, .y = {0, 1.0 + i}});
    }
    const std::string svg = figure_svg({.panels = {panel}}, style);
    double highest = INFINITY;
    for (auto at = svg.find(" points=\""); at != std::string::npos;
         at = svg.find(" points=\"", at + 1)) {
      double x = 0;
      double y = 0;
      const auto last = svg.rfind(' ', svg.find("\"/>", at) - 2);
      ASSERT_EQ(std::sscanf(svg.c_str() + last, "%lf,%lf", &x, &y), 2);
      highest = std::min(highest, y);
    }
    double row = 0;
    double end = 0;
    for (const Curve& curve : panel.curves) {
      const double height = height_of(svg, curve.name);
      const double begin = place_of(svg, curve.name, "x");
      EXPECT_LT(height, highest) << style.name << " " << curve.name;
      EXPECT_TRUE(height > row || begin > end) << "beside the name before: " << curve.name;
      row = height;
      end = begin + width_of(curve.name, style.text);
      EXPECT_LT(end, style.width);
    }
  }
}

TEST(FigureTest, PanelsBelowEachOtherShareTheirLeftEnd) {
  const Panel small{.curves = {{.x = {0, 1}, .y = {0, 1}}}};
  const Panel large{.curves = {{.x = {0, 1}, .y = {0, 100'000}}}};
  const std::string svg = figure_svg({.panels = {small, large}}, kStyles.front());
  const auto second = svg.find("<polyline", svg.find("<polyline") + 1);
  const double one = std::strtod(svg.c_str() + svg.find(" points=\"") + 9, nullptr);
  const double other = std::strtod(svg.c_str() + svg.find(" points=\"", second) + 9, nullptr);
  EXPECT_EQ(one, other);
  EXPECT_GT(place_of(svg, "100000", "x"), width_of("100000", kStyles.front().text));
}

TEST(FigureTest, ALongLineKeepsItsPeaksAndLosesWhatNobodySees) {
  Curve line;
  for (int i = 0; i < 100'000; ++i) {
    line.x.push_back(i);
    line.y.push_back(i == 31'415 ? 7 : i == 92'653 ? -3 : 0);
  }
  const std::string svg = drawn({.axes = {.y_from = -3, .y_to = 7}, .curves = {line}}, "single");
  EXPECT_LT(svg.size(), 60'000U);
  double low = -INFINITY;
  double high = INFINITY;
  const char* at = svg.c_str() + svg.find(" points=\"") + 9;
  double x = 0;
  double y = 0;
  int read = 0;
  for (; std::sscanf(at, "%lf,%lf %n", &x, &y, &read) == 2; at += read) {
    low = std::max(low, y);
    high = std::min(high, y);
  }
  EXPECT_NEAR(low - high, style_of("single")->panel_height, 30) << "both peaks are drawn";
}

TEST(FigureTest, EmptyFiguresAndSinglePointsAreDrawn) {
  for (const std::string& svg : {figure_svg({}, kStyles.front()),
                                 drawn({}),
                                 drawn({.curves = {{.name = "p", .x = {1}, .y = {1}}}}),
                                 drawn({.axes = {.x_name = "x", .x_logarithmic = true}})}) {
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
  }
}

TEST(FigureTest, NumbersBelowALogarithmicAxisDoNotRunIntoEachOther) {
  const auto of = [](std::vector<double> x) {
    std::vector<double> y(x.size(), 1);
    return drawn({.axes = {.x_name = "x", .x_logarithmic = true},
                  .curves = {{.x = std::move(x), .y = std::move(y)}}});
  };
  const std::string apart = of({12, 30, 100});
  EXPECT_NE(apart.find(">12<"), std::string::npos);
  EXPECT_NE(apart.find(">30<"), std::string::npos);
  const std::string close = of({12, 12.5, 30, 100});
  EXPECT_EQ(close.find(">12.5<"), std::string::npos);
  EXPECT_NE(close.find(">20<"), std::string::npos);
  const std::string narrow = drawn({.axes = {.x_name = "x", .x_logarithmic = true},
                                    .curves = {{.x = {1, 500, 1000}, .y = {1, 1, 1}}}},
                                   "single");
  EXPECT_NE(narrow.find(">1000<"), std::string::npos);
  EXPECT_EQ(narrow.find(">500<"), std::string::npos) << "not even 1, 2 and 5 have room";
  EXPECT_NE(of({12, 12.5}).find(">12<"), std::string::npos) << "no round number between";
}

TEST(FigureTest, CellsAreSquaresBesideTheNamesOfTheirClasses) {
  const std::string svg = drawn(
      {.axes = {.x_name = "column", .x_classes = {"left", "right"}, .y_classes = {"up", "down"}},
       .curves = {{.x = {0, 1}, .y = {0, 1}, .mark = Mark::Cells, .colour = kGreen}}});
  EXPECT_EQ(count(svg, "fill=\"#009e73\""), 2U);
  EXPECT_LT(height_of(svg, "up"), height_of(svg, "down"));
  EXPECT_NE(svg.find(">right<"), std::string::npos);
}

TEST(FigureTest, NamesOfClassesThatWouldRunIntoEachOtherAreLeftOut) {
  Axes axes{.x_name = "x", .y_classes = {"row"}};
  for (int i = 0; i < 20; ++i) axes.x_classes.push_back(std::to_string(10'000 + i));
  const std::string wide = drawn({.axes = axes}, "screen");
  const std::string narrow = drawn({.axes = axes}, "single");
  EXPECT_NE(narrow.find(">10000<"), std::string::npos);
  EXPECT_EQ(narrow.find(">10001<"), std::string::npos);
  EXPECT_GT(count(wide, ">100"), count(narrow, ">100"));
}

TEST(FigureTest, AnIntervalReachesFromItsLowToItsHighEnd) {
  const std::string svg = drawn({.axes = {.y_from = 0, .y_to = 10},
                                 .curves = {{.x = {1},
                                             .y = {5},
                                             .mark = Mark::Intervals,
                                             .colour = kGreen,
                                             .low = {0},
                                             .high = {10}}}});
  const auto bar = svg.rfind("<line", svg.find("#009e73"));
  ASSERT_NE(bar, std::string::npos);
  const double low = number_in(svg.substr(bar), "<line", "y1");
  const double high = number_in(svg.substr(bar), "<line", "y2");
  EXPECT_NEAR(low - high, style_of("screen")->panel_height, 0.2);
}

TEST(FigureTest, AnAxisThatIsTooShortHasItsNameInTwoRows) {
  const Panel panel{.axes = {.y_name = "error of the stiffness felt, taps at A [%]"}};
  EXPECT_NE(drawn(panel).find(">error of the stiffness felt, taps at A [%]<"), std::string::npos);
  const std::string narrow = drawn(panel, "single");
  EXPECT_NE(narrow.find(">error of the stiffness<"), std::string::npos);
  EXPECT_NE(narrow.find(">felt, taps at A [%]<"), std::string::npos);
}

TEST(FigureTest, APaperHasACaptionInPlaceOfATitle) {
  EXPECT_NE(drawn({}).find(">t<"), std::string::npos);
  EXPECT_EQ(drawn({}, "double").find(">t<"), std::string::npos);
}

}  // namespace
}  // namespace palp::plot
