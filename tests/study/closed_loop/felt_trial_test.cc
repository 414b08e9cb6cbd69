#include "study/closed_loop/felt_trial.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

namespace palp::study {
namespace {

Condition condition(const std::string& coupling, double round_trip_ms, bool force = true) {
  const std::string path = "delay_ms: " + std::to_string(round_trip_ms / 2);
  return {.name = coupling,
          .coupling = coupling,
          .up = path,
          .down = path,
          .grip = "mid",
          .force = force};
}

FeltSetting setting(double first, double second, int taps = 3) {
  FeltSetting out{.ln_stiffness = {first, second}, .seed = 3};
  for (auto& depth : out.depth) depth.assign(static_cast<std::size_t>(taps), 4e-3);
  return out;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(FeltTrialTest, BothIntervalsAreFeltTapByTap) {
  const FeltTrial felt = FeltSession::make(condition("mmt", 20))->feel(setting(0, 0.3));
  EXPECT_EQ(felt.ln_slopes[0].size(), 3U);
  EXPECT_EQ(felt.ln_slopes[1].size(), 3U);
  EXPECT_EQ(felt.taps, 6);
  EXPECT_GT(felt.contact, 1);
  EXPECT_GT(felt.force_max, 0.3);
  EXPECT_NEAR(felt.duration, 12, 2);
  EXPECT_GT(mean(felt.ln_slopes[1]) - mean(felt.ln_slopes[0]), 0.15);
}

TEST(FeltTrialTest, TheOwnFingerFeelsTheTissueAndMmtMuchTheSame) {
  const auto session = FeltSession::make(condition("mmt", 2));
  const FeltSetting both = setting(-0.2, 0.2);
  const FeltTrial own = session->touch(both);
  const FeltTrial felt = session->feel(both);
  const double difference = mean(own.ln_slopes[1]) - mean(own.ln_slopes[0]);
  EXPECT_GT(difference, 0.2);
  EXPECT_LT(difference, 0.4);
  for (std::size_t interval = 0; interval < 2; ++interval) {
    ASSERT_EQ(own.ln_slopes[interval].size(), 3U);
    EXPECT_NEAR(felt.ln_slopes[interval].back(), own.ln_slopes[interval].back(), 0.1);
  }
}

TEST(FeltTrialTest, WithoutForceNothingIsFeltThoughTheTipTouches) {
  const FeltTrial felt = FeltSession::make(condition("mmt", 20, false))->feel(setting(0, 1));
  EXPECT_TRUE(felt.ln_slopes[0].empty());
  EXPECT_TRUE(felt.ln_slopes[1].empty());
  EXPECT_EQ(felt.force_max, 0);
  EXPECT_EQ(felt.taps, 6);
}

TEST(FeltTrialTest, SameSeedSameFeeling) {
  const auto session = FeltSession::make(condition("tdpa", 20));
  FeltSetting one = setting(0, 0.2);
  const auto felt = session->feel(one).ln_slopes;
  EXPECT_EQ(session->feel(one).ln_slopes, felt);
  one.seed = 4;
  EXPECT_NE(session->feel(one).ln_slopes, felt);
}

TEST(FeltTrialTest, AConditionThatIsNoneIsRefused) {
  Condition none = condition("mmt", 20);
  none.up = "spec: \"delay for ever\"";
  EXPECT_FALSE(FeltSession::make(none));
}

}  // namespace
}  // namespace palp::study
