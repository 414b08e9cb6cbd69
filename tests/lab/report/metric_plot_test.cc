#include "lab/report/metric_plot.h"

#include <string>

#include <gtest/gtest.h>

#include "judge/metric_table.h"

namespace palp::lab {
namespace {

std::string drawn(const std::vector<std::string>& labels,
                  const std::vector<CaseResult>& results,
                  const std::string& metric,
                  const std::string& title) {
  return plot::figure_svg(metric_plot(labels, results, metric, title), plot::kStyles.front());
}

CaseResult result(std::vector<std::string> labels, double value) {
  CaseResult one;
  one.labels = std::move(labels);
  one.values.assign(judge::metric_table().size(), value);
  return one;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

TEST(MetricPlotTest, RepeatsArePointsAndTheLineGoesThroughTheirMedians) {
  const std::vector<CaseResult> results{result({"20"}, 0.1),
                                        result({"20"}, 0.3),
                                        result({"20"}, 0.2),
                                        result({"100"}, 0.2),
                                        result({"100"}, 0.2),
                                        result({"100"}, 0.5)};
  const std::string svg = drawn({"rtt_ms"}, results, "tap_a_error", "title");
  EXPECT_EQ(count(svg, "<circle"), 6U);
  const auto line = svg.find(" points=\"");
  ASSERT_NE(line, std::string::npos);
  const std::string points = svg.substr(line, svg.find("\"/>", line) - line);
  EXPECT_EQ(count(points, ","), 2U) << points;
  // Both medians are 0.2: the line is level.
  const auto first = points.find(',');
  const auto second = points.find(',', first + 1);
  EXPECT_EQ(points.substr(first, points.find(' ', first) - first),
            points.substr(second, points.find(' ', second) - second));
}

TEST(MetricPlotTest, RunsAlongTheFirstLabelThatIsANumber) {
  const std::vector<CaseResult> results{result({"light", "20"}, 0.1),
                                        result({"light", "50"}, 0.1),
                                        result({"firm", "20"}, 0.1),
                                        result({"firm", "50"}, 0.1)};
  const std::string svg = drawn({"grip", "servo_hz"}, results, "tap_a_error", "title");
  EXPECT_EQ(count(svg, "<polyline"), 2U);
  EXPECT_NE(svg.find(">bandwidth of the stage [Hz]<"), std::string::npos);
  EXPECT_NE(svg.find(">firm<"), std::string::npos);
}

TEST(MetricPlotTest, ANumberInTheLegendHasItsNameAndUnit) {
  const std::string svg = drawn({"rtt_ms", "coupling.mmt.memory_s", "loss"},
                                {result({"20", "1", "0"}, 0.1), result({"50", "2", "0.1"}, 0.2)},
                                "tap_a_error",
                                "title");
  EXPECT_NE(svg.find(">memory = 2 s, share of lost datagrams = 0.1<"), std::string::npos) << svg;
}

TEST(MetricPlotTest, WordsAloneStandByTheirCaseEachAsAPoint) {
  std::vector<CaseResult> results{result({"light"}, 0.1), result({"firm"}, 0.2)};
  results[1].index = 1;
  const std::string svg = drawn({"grip"}, results, "tap_a_error", "title");
  EXPECT_EQ(count(svg, "<circle"), 2U);
  EXPECT_NE(svg.find(">case<"), std::string::npos);
  EXPECT_NE(svg.find(">firm<"), std::string::npos);
}

TEST(MetricPlotTest, ALabelThatIsTheSameInAllCasesIsNoAxisIfAnotherIs) {
  const std::vector<CaseResult> results{result({"20", "1"}, 0.1), result({"20", "2"}, 0.2)};
  const std::string svg = drawn({"rtt_ms", "memory_s"}, results, "tap_a_error", "title");
  EXPECT_NE(svg.find(">memory [s]<"), std::string::npos);
}

TEST(MetricPlotTest, SharesAreInPercentAndAxesAreInWords) {
  const plot::Figure figure =
      metric_plot({"rtt_ms"}, {result({"20"}, 0.25), result({"50"}, 0.5)}, "tap_a_error", "t");
  ASSERT_EQ(figure.panels.size(), 1U);
  EXPECT_EQ(figure.panels[0].axes.x_name, "round trip [ms]");
  EXPECT_EQ(figure.panels[0].axes.y_name, "error of the stiffness felt, taps at A [%]");
  EXPECT_EQ(figure.panels[0].curves.at(0).y, (std::vector<double>{25, 50}));
  EXPECT_EQ(axis_words("coupling.mmt.memory_s"), "memory [s]");
  EXPECT_EQ(axis_words("grip"), "grip");
}

TEST(MetricPlotTest, NothingToShowIsStillAPicture) {
  for (const auto& none : {std::vector<CaseResult>{}, {result({"20"}, judge::kUndefined)}}) {
    const std::string svg = drawn({"rtt_ms"}, none, "tap_a_error", "nothing");
    EXPECT_NE(svg.find("<svg"), std::string::npos);
    EXPECT_NE(svg.find(">nothing<"), std::string::npos);
  }
}

TEST(MetricPlotTest, ManyCurvesBecomePoints) {
  std::vector<CaseResult> results;
  results.reserve(40);
  for (int i = 0; i < 40; ++i) {
    results.push_back(result({std::to_string(i + 1), std::to_string(i)}, 0.01 * i));
  }
  const std::string svg = drawn({"rtt_ms", "seed"}, results, "tap_a_error", "title");
  EXPECT_EQ(count(svg, "<polyline"), 0U);
  EXPECT_EQ(count(svg, "<circle"), 40U);
}

}  // namespace
}  // namespace palp::lab
