#include "lab/report/impedance_report.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace palp::lab {
namespace {

using testing::HasSubstr;

/// A hand feels a spring of `shown` [N/m] and a damper of 2 N s/m; the air is a damper of 0.5.
ImpedanceRow row_of(const std::string& coupling, double frequency, double shown, bool linear) {
  const double rate = 2 * std::numbers::pi * frequency;
  return {.coupling = coupling,
          .round_trip = 0.02,
          .frequency = frequency,
          .free_air = 0.5,
          .tissues = {Impedance{2, -shown / rate}},
          .stability = {.hand = 1, .tissue = 1, .margin = 0.5},
          .linear = linear};
}

ImpedanceStudy sample() {
  return {.stiffnesses = {200},
          .rows = {row_of("direct", 1, 180, true),
                   row_of("direct", 5, 150, true),
                   row_of("mmt", 1, 199, false),
                   row_of("mmt", 5, 198, false)}};
}

TEST(ImpedanceReportTest, TakesAnImpedanceApartIntoSpringAndDamper) {
  const ImpedanceStudy study = sample();
  const ShownParts parts = shown_parts(study.rows[1].tissues[0], 5);
  EXPECT_NEAR(parts.spring, 150, 1e-9);
  EXPECT_NEAR(parts.damper, 2, 1e-12);
  const double ratio = std::abs(study.rows[1].tissues[0]) / 0.5;
  EXPECT_NEAR(width_db(study.rows[1]), 20 * std::log10(ratio), 1e-12);
}

TEST(ImpedanceReportTest, OfALawThatIsNotLinearTheCriterionSaysNothing) {
  const auto json = nlohmann::json::parse(impedance_json(sample()));
  EXPECT_EQ(json["schema"], "palp.impedance/1");
  EXPECT_EQ(json["rows"][0]["llewellyn"]["absolutely_stable"], false);
  EXPECT_EQ(json["rows"][0]["llewellyn"]["margin"], 0.5);
  EXPECT_EQ(json["rows"][2]["llewellyn"]["absolutely_stable"], nullptr);
  EXPECT_NEAR(json["rows"][2]["tissues"][0]["shown_n_per_m"], 199, 1e-9);
  EXPECT_THAT(impedance_table(sample()), HasSubstr("not linear"));
}

TEST(ImpedanceReportTest, EachImpedanceIsALineAndEachLawAPanel) {
  const std::string csv = impedance_csv(sample());
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 4 * 2);
  const plot::Figure figure = impedance_figure(sample());
  ASSERT_EQ(figure.panels.size(), 2U);
  for (const plot::Panel& panel : figure.panels) {
    EXPECT_EQ(panel.curves.size(), 3U) << "tissue felt, tissue itself, air";
    EXPECT_EQ(panel.curves[0].x, (std::vector<double>{1, 5}));
  }
}

}  // namespace
}  // namespace palp::lab
