#include "study/closed_loop/felt_trial.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

namespace palp::study {
namespace {

Condition condition(const std::string& coupling,
                    double round_trip_ms,
                    Feedback feedback = Feedback::Force) {
  const std::string path = "delay_ms: " + std::to_string(round_trip_ms / 2);
  return {.name = coupling,
          .coupling = coupling,
          .up = path,
          .down = path,
          .grip = "mid",
          .feedback = feedback};
}

FeltSetting setting(const std::vector<double>& ln_stiffness, std::size_t taps = 3) {
  FeltSetting out{.seed = 3};
  for (const double one : ln_stiffness) out.places.push_back({one, std::vector(taps, 4e-3)});
  return out;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(FeltTrialTest, BothIntervalsAreFeltTapByTap) {
  const FeltTrial felt = FeltSession::make(condition("mmt", 20))->feel(setting({0, 0.3}));
  EXPECT_EQ(felt.intervals[0].ln_slopes.size(), 3U);
  EXPECT_EQ(felt.intervals[1].ln_slopes.size(), 3U);
  EXPECT_EQ(felt.taps, 6);
  EXPECT_GT(felt.contact, 1);
  EXPECT_GT(felt.force_max, 0.3);
  EXPECT_NEAR(felt.duration, 12, 2);
  EXPECT_GT(mean(felt.intervals[1].ln_slopes) - mean(felt.intervals[0].ln_slopes), 0.15);
}

TEST(FeltTrialTest, TheOwnFingerFeelsTheTissueAndMmtMuchTheSame) {
  const auto session = FeltSession::make(condition("mmt", 2));
  const FeltSetting both = setting({-0.2, 0.2});
  const FeltTrial own = session->touch(both);
  const FeltTrial felt = session->feel(both);
  const double difference = mean(own.intervals[1].ln_slopes) - mean(own.intervals[0].ln_slopes);
  EXPECT_GT(difference, 0.2);
  EXPECT_LT(difference, 0.4);
  for (std::size_t interval = 0; interval < 2; ++interval) {
    ASSERT_EQ(own.intervals[interval].ln_slopes.size(), 3U);
    EXPECT_NEAR(
        felt.intervals[interval].ln_slopes.back(), own.intervals[interval].ln_slopes.back(), 0.1);
  }
}

TEST(FeltTrialTest, WithoutForceNothingIsFeltThoughTheTipTouches) {
  const FeltTrial felt =
      FeltSession::make(condition("mmt", 20, Feedback::None))->feel(setting({0, 1}));
  EXPECT_TRUE(felt.intervals[0].ln_slopes.empty());
  EXPECT_TRUE(felt.intervals[1].ln_slopes.empty());
  EXPECT_EQ(felt.force_max, 0);
  EXPECT_EQ(felt.taps, 6);
}

// A force that is drawn is that of the tip, whatever the hand is given: over the depth that the
// hand went to it grows as the stiffness does, and a hand that is given no force goes as deep as it
// aims.
TEST(FeltTrialTest, WhatIsDrawnIsTheTipsForce) {
  for (const double round_trip_ms : {2.0, 200.0}) {
    const auto session = FeltSession::make(condition("mmt", round_trip_ms, Feedback::Drawn));
    const FeltTrial felt = session->feel(setting({0, 0.5}));
    EXPECT_EQ(felt.force_max, 0);
    for (const FeltInterval& one : felt.intervals) {
      EXPECT_TRUE(one.ln_slopes.empty());
      EXPECT_EQ(one.ln_drawn.size(), 3U);
    }
    EXPECT_NEAR(mean(felt.intervals[1].ln_drawn) - mean(felt.intervals[0].ln_drawn), 0.5, 0.12)
        << "steps of 50 mN";
    const double plain = 4e-3 * std::exp(mean(felt.intervals[0].ln_drawn));
    EXPECT_NEAR(plain, 0.48, 0.06) << "1897 d^1.5";
  }
  const auto both = FeltSession::make(condition("mmt", 2, Feedback::Both))->feel(setting({0, 0.5}));
  for (const FeltInterval& one : both.intervals) {
    EXPECT_EQ(one.ln_slopes.size(), 3U);
    EXPECT_EQ(one.ln_drawn.size(), 3U);
  }
}

// The estimator finds a shallow ball where it lies, and none in plain tissue.
TEST(FeltTrialTest, TheEstimatorTellsTheDepthOfABall) {
  const Study study = *parse_study(
      "task: \"detect2\" depth { top_mm: 8 contrast_ln: 0.2 } depth { top_mm: 20 contrast_ln: 0.03 "
      "} "
      "ball { radius_mm: 8 ratio: 100 } condition { name: \"one\" feedback: \"depth\" up { "
      "delay_ms: "
      "10 } down { delay_ms: 10 } }",
      "study");
  const auto session = FeltSession::make(study.conditions[0], *LevelCurves::make(study));
  ASSERT_TRUE(session);
  for (const std::size_t stronger : {0U, 1U}) {
    FeltSetting at = setting({0, 0});
    at.places[stronger].ln_stiffness = 0.2;
    const FeltTrial felt = session->feel(at);
    EXPECT_EQ(felt.force_max, 0);
    ASSERT_TRUE(felt.intervals[stronger].ball_depth);
    EXPECT_NEAR(*felt.intervals[stronger].ball_depth, 8e-3, 3e-3);
    EXPECT_FALSE(felt.intervals[1 - stronger].ball_depth);
  }
}

TEST(FeltTrialTest, ByTheFirstTapsNobodyJudges) {
  Condition some = condition("mmt", 20);
  const auto all = FeltSession::make(some);
  some.unjudged = 1;
  const auto later = FeltSession::make(some);
  EXPECT_EQ(later->taps(), 3);
  EXPECT_EQ(later->judged(), 2);
  const FeltTrial every = all->feel(setting({0, 0.3}));
  const FeltTrial last = later->feel(setting({0, 0.3}));
  for (std::size_t interval = 0; interval < 2; ++interval) {
    const std::vector<double>& slopes = every.intervals[interval].ln_slopes;
    EXPECT_EQ(last.intervals[interval].ln_slopes,
              std::vector<double>(slopes.begin() + 1, slopes.end()));
  }
  EXPECT_EQ(later->touch(setting({0, 0.3})).intervals[0].ln_slopes.size(), 2U);
}

// As many places as intervals, each with its own tissue: what one feels like does not depend on
// what lies at the others.
TEST(FeltTrialTest, AnyNumberOfPlacesIsFeltEachWithItsOwnTissue) {
  const auto session = FeltSession::make(condition("mmt", 2));
  const auto alone = [&](double ln_stiffness) {
    return session->touch(setting({ln_stiffness})).intervals.at(0).ln_slopes;
  };
  const std::vector<double> tissues{0.1, 0.4, -0.2, 0, 0.3, -0.1, 0.2, 0.05};
  const FeltTrial own = session->touch(setting(tissues));
  const FeltTrial felt = session->feel(setting(tissues));
  ASSERT_EQ(own.intervals.size(), tissues.size());
  ASSERT_EQ(felt.intervals.size(), tissues.size());
  EXPECT_EQ(felt.taps, 24);
  for (std::size_t i = 0; i < tissues.size(); ++i) {
    EXPECT_NEAR(mean(own.intervals[i].ln_slopes), mean(alone(tissues[i])), 1e-3) << i;
    EXPECT_NEAR(felt.intervals[i].ln_slopes.back(), own.intervals[i].ln_slopes.back(), 0.1) << i;
  }
}

TEST(FeltTrialTest, OnePlaceIsATrialToo) {
  const FeltTrial felt = FeltSession::make(condition("mmt", 20))->feel(setting({0.2}));
  ASSERT_EQ(felt.intervals.size(), 1U);
  EXPECT_EQ(felt.intervals[0].ln_slopes.size(), 3U);
  EXPECT_EQ(felt.taps, 3);
}

TEST(FeltTrialTest, SameSeedSameFeeling) {
  const auto session = FeltSession::make(condition("tdpa", 20));
  FeltSetting one = setting({0, 0.2});
  const auto felt = session->feel(one).intervals[1].ln_slopes;
  EXPECT_EQ(session->feel(one).intervals[1].ln_slopes, felt);
  one.seed = 4;
  EXPECT_NE(session->feel(one).intervals[1].ln_slopes, felt);
}

TEST(FeltTrialTest, AConditionThatIsNoneIsRefused) {
  Condition none = condition("mmt", 20);
  none.up = "spec: \"delay for ever\"";
  EXPECT_FALSE(FeltSession::make(none));
}

/// A delay of one interval, felt in it and not in the other.
FeltSetting delayed(double ms, std::size_t which) {
  FeltSetting out = setting({0, 0}, 2);
  out.places[which].delay = ms;
  return out;
}

TEST(FeltTrialTest, ADelayIsFeltInItsIntervalWhereALawShowsIt) {
  Condition stiff = condition("direct", 2);
  stiff.taps = 2;
  const auto direct = FeltSession::make(stiff);
  for (const std::size_t which : {0U, 1U}) {
    const FeltTrial felt = direct->feel(delayed(60, which));
    EXPECT_GT(*felt.intervals[which].lag, 30) << which;
    EXPECT_LT(*felt.intervals[1 - which].lag, 6) << which;
    EXPECT_EQ(felt.taps, 4);
  }
  // A model of the tissue at the hand hides it, once it is there.
  Condition later = condition("mmt", 2);
  later.taps = 2;
  later.unjudged = 1;
  const FeltTrial hidden = FeltSession::make(later)->feel(delayed(60, 1));
  EXPECT_LT(*hidden.intervals[1].lag, 6);
  const FeltTrial none =
      FeltSession::make(condition("direct", 2, Feedback::None))->feel(delayed(60, 1));
  EXPECT_FALSE(none.intervals[1].lag);
}

}  // namespace
}  // namespace palp::study
