// Goal: the map of eq. (1) says what its loop's gain says. Method: with delay alone in the loop the
// closed form (small gain) decides for every delay at once; some cells of the map are run.

#include "lab/report/stability_map.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "lab/plan/plan.h"
#include "lab/run/run.h"

namespace palp::lab {
namespace {

struct Grip {
  double mass{};       ///< [kg], of the hand
  double damping{};    ///< [N s/m]
  double stiffness{};  ///< [N/m]
};
constexpr Grip kLight{0.01, 1, 80};
constexpr Grip kMid{0.04, 4, 300};
constexpr Grip kFirm{0.12, 10, 900};

/// Largest gain of the loop through hand, stage (20 Hz, damping 0.9), tissue up to 500 N/m and
/// transducer (20 Hz), over all frequencies: below 1 no delay makes it unstable.
double loop_gain(const Grip& grip, double spring) {
  constexpr double kServo = 2 * std::numbers::pi * 20;
  double most = 0;
  for (int step = 0; step < 870; ++step) {  // 0.02 to 114 Hz
    const double omega = 2 * std::numbers::pi * 0.02 * std::pow(1.01, step);
    const std::complex<double> s{0, omega};
    const auto stage = kServo * kServo / (s * s + 1.8 * kServo * s + kServo * kServo);
    const auto sensor = 1.0 / (1.0 + s / kServo);
    const std::complex<double> hand{grip.stiffness + spring - (0.075 + grip.mass) * omega * omega,
                                    omega * (grip.damping + 0.05)};
    for (int level = 0; level <= 20; ++level) {
      const double tissue = 25.0 * level;
      most = std::max(most, std::abs((tissue * sensor - spring) * stage / hand));
    }
  }
  return most;
}

bool is_unstable(const std::string& grip, const std::string& spring, const std::string& trip) {
  const Plan plan = make_map({});
  for (const Case& one : plan.cases) {
    if (one.labels[0] != spring || one.labels[1] != trip || one.labels[6] != grip) continue;
    const auto scenario = make_case(plan, one);
    if (!scenario) throw std::runtime_error{scenario.error().text};
    return simulate(*scenario).metrics.unstable;
  }
  throw std::runtime_error{"no such cell"};
}

TEST(StabilityMapTest, EquationOneIsStableAtAnyDelayWhereItsLoopGainIsBelowOne) {
  ASSERT_LT(loop_gain(kFirm, 1600), 1);
  EXPECT_FALSE(is_unstable("firm", "1600", "500"));
  EXPECT_FALSE(is_unstable("firm", "1600", "1000"));
  ASSERT_LT(loop_gain(kMid, 200), 1);
  EXPECT_FALSE(is_unstable("mid", "200", "200"));
}

TEST(StabilityMapTest, SomeDelayLosesItWhereTheGainIsAboveOne) {
  ASSERT_GT(loop_gain(kLight, 25), 1);
  EXPECT_TRUE(is_unstable("light", "25", "20"));
  ASSERT_GT(loop_gain(kMid, 1600), 1);
  EXPECT_TRUE(is_unstable("mid", "1600", "100"));
}

TEST(StabilityMapTest, AShardLeavesOpenWhatItDidNotRunAndMovesNothing) {
  const Plan plan = make_map({});
  std::vector<CaseResult> results;
  for (const Case& one : plan.cases) {
    if (one.index % 3 != 2) continue;
    CaseResult result;
    result.index = one.index;
    result.labels = one.labels;
    result.unstable = one.labels[0] == "400";
    results.push_back(std::move(result));
  }
  const auto json = nlohmann::json::parse(map_report(plan, results, {}));
  ASSERT_EQ(json["grips"].size(), 4U);
  ASSERT_EQ(json["k_p_n_per_m"].size(), 8U);
  ASSERT_EQ(json["rtt_ms"].size(), 14U);
  EXPECT_TRUE(std::is_sorted(json["rtt_ms"].begin(), json["rtt_ms"].end()));
  std::size_t index = 0;
  for (const auto& grip : json["stable"]) {
    for (std::size_t s = 0; s < 8; ++s) {
      for (const auto& cell : grip.at(s)) {
        if (index++ % 3 == 2) {
          EXPECT_EQ(cell, json["k_p_n_per_m"][s] != 400);
        } else {
          EXPECT_TRUE(cell.is_null());
        }
      }
    }
  }
  EXPECT_EQ(index, plan.cases.size());
  EXPECT_NE(map_text(results).find("light k_p 0          ? ? S"), std::string::npos)
      << map_text(results);
}

}  // namespace
}  // namespace palp::lab
