#include "study/closed_loop/felt_observer.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/core/random.h"

namespace palp::study {
namespace {

constexpr Task kTwo{};
constexpr Task kYesNo{.two_sided = true, .yes_no = true};

/// Three taps at each place.
std::vector<FeltInterval> felt(const std::vector<double>& above) {
  std::vector<FeltInterval> out;
  out.reserve(above.size());
  for (const double one : above) out.push_back({.ln_slopes = std::vector<double>(3, 5.0 + one)});
  return out;
}

/// Of `choice`.
double share(const std::vector<FeltInterval>& what,
             const Task& task,
             const Judgement& judgement,
             std::size_t choice = 1) {
  constexpr std::uint64_t kTrials = 4000;
  double count = 0;
  for (std::uint64_t i = 0; i < kTrials; ++i) {
    count += chosen(what, task, judgement, 1, i) == choice ? 1 : 0;
  }
  return count / double{kTrials};
}

// With the own finger and three taps the Weber fraction is the one that was asked for.
TEST(JudgementTest, HasTheWeberFractionItIsMadeFor) {
  for (const double weber : {0.08, 0.15, 0.22, 0.45}) {
    const Judgement judgement = judgement_of(weber, 0, 1);
    EXPECT_NEAR(judgement.jnd(kTwo, 3, 1), std::log1p(weber), 1e-9);
    EXPECT_NEAR(share(felt({0, std::log1p(weber)}), kTwo, judgement), 0.75, 0.03);
    EXPECT_NEAR(share(felt({0, -std::log1p(weber)}), kTwo, judgement), 0.25, 0.03);
    EXPECT_NEAR(share(felt({0, 0}), kTwo, judgement), 0.5, 0.03);
  }
}

// Signal detection with one and the same noise: of m intervals half way from 1/m to 1 are right at
// the JND, and each wrong one is chosen alike.
TEST(JudgementTest, OfManyIntervalsTheJndIsHalfWayFromChance) {
  const Judgement judgement = judgement_of(0.15, 0, 1);
  for (const int intervals : {3, 4, 8}) {
    const Task task{.intervals = intervals};
    std::vector<double> above(static_cast<std::size_t>(intervals), 0.0);
    EXPECT_NEAR(share(felt(above), task, judgement), 1.0 / intervals, 0.03);
    above[1] = judgement.jnd(task, 3, 1);
    EXPECT_NEAR(share(felt(above), task, judgement), 0.5 + 0.5 / intervals, 0.03) << intervals;
    EXPECT_NEAR(share(felt(above), task, judgement, 2), 0.5 / intervals, 0.02) << intervals;
  }
  EXPECT_GT(judgement.jnd({.intervals = 3}, 3, 1), judgement.jnd(kTwo, 3, 1))
      << "two of three is harder than three of four";
}

// Yes or no by the noise of one judgement: d' is the contrast over it, and the criterion stands
// where it was put.
TEST(JudgementTest, YesOrNoHasTheSensitivityAndTheCriterionItIsMadeFor) {
  Judgement judgement = judgement_of(0.15, 0, 1);
  judgement.plain = 5;
  for (const double criterion : {0.0, 0.5, 1.0}) {
    judgement.criterion = criterion;
    for (const double d_prime : {0.5, 1.0, 2.0}) {
      const double hits = share(felt({d_prime * judgement.sd(3)}), kYesNo, judgement);
      const double alarms = share(felt({0}), kYesNo, judgement);
      EXPECT_NEAR(normal_quantile(hits) - normal_quantile(alarms), d_prime, 0.12);
      EXPECT_NEAR(-normal_quantile(alarms), criterion, 0.08);
    }
  }
  EXPECT_NEAR(judgement.jnd(kYesNo, 3, 1), std::log1p(0.15) / std::sqrt(2.0), 1e-9)
      << "one judgement, not two";
}

TEST(JudgementTest, OneTapIsLessCertainAndHalfOfADifferenceDoublesTheJnd) {
  const Judgement judgement = judgement_of(0.15, 0, 1);
  EXPECT_GT(judgement.jnd(kTwo, 1, 1), 1.1 * judgement.jnd(kTwo, 3, 1));
  EXPECT_DOUBLE_EQ(judgement.jnd(kTwo, 3, 0.5), 2 * judgement.jnd(kTwo, 3, 1));
}

TEST(JudgementTest, WhereNothingWasFeltItIsAGuess) {
  const Judgement judgement = judgement_of(0.15, 0, 1);
  auto two = felt({0, 3});
  EXPECT_GT(share(two, kTwo, judgement), 0.99);
  two[0].ln_slopes.clear();
  EXPECT_NEAR(share(two, kTwo, judgement), 0.5, 0.03);
  auto three = felt({0, 3, 0});
  three[2].ln_slopes.clear();
  EXPECT_NEAR(share(three, {.intervals = 3}, judgement), 1.0 / 3, 0.03);
  EXPECT_NEAR(share({{}}, kYesNo, judgement), 0.5, 0.03);
}

/// The same, felt and drawn.
std::vector<FeltInterval> both(const std::vector<double>& above) {
  auto out = felt(above);
  for (FeltInterval& one : out) one.ln_drawn = one.ln_slopes;
  return out;
}

// Where the judgement itself has no part in it, noises of force, reading and place are all there
// is.
TEST(JudgementTest, EachCueHasItsOwnNoiseAndTogetherTheyHaveLess) {
  const double weber = 0.15;
  Judgement hand = judgement_of(weber, 0, 1);
  Judgement drawn = hand;
  drawn.feedback = Feedback::Drawn;
  Judgement two = hand;
  two.feedback = Feedback::Both;
  const double per_sd = std::sqrt(2.0) * kQuartile;
  const double judged = hand.judgement_sd * hand.judgement_sd;
  EXPECT_NEAR(drawn.sd(3),
              std::sqrt((std::pow(0.03 / per_sd, 2) + std::pow(0.08 / per_sd, 2)) / 3 + judged),
              1e-12);
  EXPECT_LT(drawn.sd(3), hand.sd(3)) << "3 % are less than 7 %";
  EXPECT_LT(two.sd(3), drawn.sd(3));
  EXPECT_GT(two.sd(3), std::sqrt(judged)) << "what both have in common stays";
  for (Judgement judgement : {hand, drawn, two}) {
    for (const bool exactly : {false, true}) {
      judgement.reads_exactly = exactly;
      const double jnd = judgement.jnd(kTwo, 3, 1);
      EXPECT_NEAR(share(both({0, jnd}), kTwo, judgement), 0.75, 0.03);
    }
  }
  drawn.reads_exactly = two.reads_exactly = true;
  EXPECT_NEAR(drawn.sd(3), std::hypot(0.03, 0.08) / per_sd / std::sqrt(3.0), 1e-12);
  EXPECT_LT(two.sd(3), drawn.sd(3));
}

// Cues that say different things: what is told lies between, nearer to the more reliable one.
TEST(JudgementTest, CuesCountByTheirReliability) {
  Judgement judgement = judgement_of(0.15, 0, 1);
  judgement.feedback = Feedback::Both;
  const FeltInterval apart{.ln_slopes = {5, 5, 5}, .ln_drawn = {6, 6, 6}};
  const double share_drawn = 0.07 * 0.07 / (0.07 * 0.07 + 0.03 * 0.03);
  EXPECT_NEAR(*impression(apart, judgement), 5 + share_drawn, 1e-9);
  judgement.feedback = Feedback::Force;
  EXPECT_DOUBLE_EQ(*impression(apart, judgement), 5);
  judgement.feedback = Feedback::Drawn;
  EXPECT_DOUBLE_EQ(*impression(apart, judgement), 6);
  EXPECT_FALSE(impression({.ln_slopes = {5}}, judgement)) << "nothing is drawn, nothing is read";
  judgement.feedback = Feedback::Both;
  EXPECT_DOUBLE_EQ(*impression({.ln_slopes = {5}}, judgement), 5);
  EXPECT_DOUBLE_EQ(*impression({.ln_drawn = {6}}, judgement), 6);
}

// By the estimator: a ball before none, the less deep one before the deeper, else a guess; and yes
// where there is one.
TEST(JudgementTest, WhatTheEstimatorSaysIsAnswered) {
  Judgement judgement = judgement_of(0.15, 0, 1);
  judgement.feedback = Feedback::Depth;
  judgement.plain = kNoBall;
  judgement.criterion = 1;
  const FeltInterval none{};
  const FeltInterval deep{.ball_depth = 15e-3};
  const FeltInterval shallow{.ball_depth = 8e-3};
  EXPECT_EQ(share({none, deep}, kTwo, judgement), 1);
  EXPECT_EQ(share({shallow, deep}, kTwo, judgement), 0);
  EXPECT_NEAR(share({none, none}, kTwo, judgement), 0.5, 0.03);
  EXPECT_EQ(share({deep}, kYesNo, judgement), 1);
  EXPECT_EQ(share({none}, kYesNo, judgement), 0);
}

TEST(JudgementTest, PeopleKnowWhatTheirOwnFingerShows) {
  EXPECT_NEAR(
      share(felt({0, 0.5 * std::log1p(0.15)}), kTwo, judgement_of(0.15, 0, 0.5)), 0.75, 0.03);
}

std::vector<double> tissues(const FeltSetting& setting) {
  std::vector<double> out;
  for (const FeltPlace& one : setting.places) out.push_back(one.ln_stiffness);
  return out;
}

TEST(SettingTest, TheStrongerOneIsWhereTheScheduleSaysAndTapsVary) {
  const TrialAsk ask{.level = 0.3, .stronger = 0};
  const FeltSetting first = setting_of(ask, kTwo, 3, 0.1, 7);
  EXPECT_EQ(tissues(first), (std::vector{0.3, 0.0}));
  EXPECT_EQ(tissues(setting_of({.level = 0.3, .stronger = 1}, kTwo, 3, 0.1, 7)),
            (std::vector{0.0, 0.3}));
  EXPECT_EQ(tissues(setting_of({.level = 0.3, .stronger = 2}, {.intervals = 3}, 3, 0.1, 7)),
            (std::vector{0.0, 0.0, 0.3}));
  EXPECT_EQ(tissues(setting_of({.level = -0.3, .stronger = 0}, {.two_sided = true}, 3, 0.1, 7)),
            (std::vector{0.0, -0.3}));
  EXPECT_EQ(tissues(setting_of({.level = 0.3, .stronger = 1}, kYesNo, 3, 0.1, 7)),
            (std::vector{0.3}));
  ASSERT_EQ(first.places[0].depth.size(), 3U);
  EXPECT_NE(first.places[0].depth[0], first.places[0].depth[1]);
  EXPECT_NE(first.places[0].depth[0], first.places[1].depth[0]);
  EXPECT_NEAR(first.places[0].depth[0], 4e-3, 1.3e-3);
}

TEST(FeltParticipantsTest, TellAGreatDifferenceAndNoneWithoutForce) {
  const Study study = *parse_study(
      "condition { name: \"force\" } condition { name: \"none\" feedback: \"none\" }", "study");
  const auto observer = FeltParticipants::make(study, {.lapse = 0});
  ASSERT_TRUE(observer);
  int right = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const TrialAsk ask{.number = i, .level = 1, .stronger = (i + 1) % 2};
    const TrialOutcome out = observer->answer({0, 0}, ask);
    right += out.chosen == ask.stronger ? 1 : 0;
    EXPECT_EQ(out.taps, 6);
    EXPECT_EQ(observer->answer({0, 1}, ask).force_max, 0);
  }
  EXPECT_EQ(right, 6);
}

// What plain tissue feels like, and so what lies above it, is known under each condition by itself.
TEST(FeltParticipantsTest, SayYesToAGreatBallAndNoToNone) {
  const Study study = *parse_study(
      "task: \"detect\" method: \"constant\" depth { top_mm: 5 contrast_ln: 1 } depth { top_mm: 9 "
      "contrast_ln: 0.3 } condition { name: \"one\" } condition { name: \"direct\" coupling: "
      "\"direct\" up { delay_ms: 10 } down { delay_ms: 10 } }",
      "study");
  const auto observer = FeltParticipants::make(study, {.weber = 0.08, .lapse = 0});
  ASSERT_TRUE(observer);
  for (std::size_t condition = 0; condition < 2; ++condition) {
    int alarms = 0;
    for (std::size_t i = 0; i < 12; ++i) {
      const TrialOutcome ball = observer->answer({i, condition}, {.level = 1, .stronger = 1});
      EXPECT_EQ(ball.chosen, 1U) << condition << " " << i;
      EXPECT_EQ(ball.taps, 3);
      alarms += observer->answer({i, condition}, {.number = 1, .level = 0}).chosen == 1 ? 1 : 0;
    }
    EXPECT_LE(alarms, 6) << "cautious ones: 2 of 12, and scatter from session to session";
  }
}

TEST(FeltParticipantsTest, FindTheStiffestOfThree) {
  const Study study = *parse_study("intervals: 3 condition { name: \"one\" }", "study");
  const auto observer = FeltParticipants::make(study, {.lapse = 0});
  ASSERT_TRUE(observer);
  for (std::size_t i = 0; i < 6; ++i) {
    const TrialAsk ask{.number = i, .level = 1, .stronger = i % 3};
    const TrialOutcome out = observer->answer({0, 0}, ask);
    EXPECT_EQ(out.chosen, ask.stronger);
    EXPECT_EQ(out.taps, 9);
  }
}

// A ball's levels are contrasts of its own depths, and none of them lies at +-0.2: what a hand
// makes of a difference is measured in plain tissue, whatever a study asks about.
TEST(FeltObserverTest, TheHandsOwnGainDoesNotDependOnTheStudysDepths) {
  const Condition condition{.name = "both",
                            .coupling = "mmt",
                            .up = "delay_ms: 1",
                            .down = "delay_ms: 1",
                            .grip = "mid",
                            .feedback = Feedback::Both};
  const auto gains = [&](const std::string& depths) {
    const Study study = *parse_study(
        "task: \"detect2\" ball { radius_mm: 8 ratio: 100 } condition { "
        "name: \"one\" } " +
            depths,
        "s");
    const auto session = FeltSession::make(condition, *LevelCurves::make(study));
    const Judgement judgement = judgement_for(*session, study.task, 0.15, 0);
    return std::pair{judgement.own_gain, judgement.drawn_gain};
  };
  const auto few =
      gains("depth { top_mm: 5 contrast_ln: 0.4248 } depth { top_mm: 20 contrast_ln: 0.027 }");
  const auto more = gains(
      "depth { top_mm: 5 contrast_ln: 0.4248 } depth { top_mm: 8 contrast_ln: 0.2062 } "
      "depth { top_mm: 20 contrast_ln: 0.027 }");
  EXPECT_EQ(few, more);
  const auto plain = FeltSession::make(condition);
  EXPECT_EQ(few.first, judgement_for(*plain, {}, 0.15, 0).own_gain);
  EXPECT_GT(few.first, 0.5);
  EXPECT_LT(few.first, 1.2);
}

TEST(FeltObserverTest, OrdersAreChosenByWhatSeemsStiffer) {
  const Task rank{.intervals = 3, .ranks = true};
  const Judgement judgement = judgement_of(0.15, 0, 1);
  const auto of = [](double level) { return FeltInterval{.ln_slopes = {level, level, level}}; };
  int right = 0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const double jnd = judgement.jnd(rank, 3, 1);
    right += chosen({of(jnd), of(-jnd), of(0)}, rank, judgement, 4, i) == 3 ? 1 : 0;
  }
  EXPECT_NEAR(right / 2000.0, 7.0 / 12, 0.045);
}

TEST(FeltObserverTest, ADelayIsJudgedByHowLateTheForceIs) {
  Judgement judgement = judgement_of(0.15, 0, 1);
  judgement.delays = true;
  const Task delay{.delays = true};
  const double jnd = level_unit(delay) * std::log1p(0.15);
  int right = 0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const std::vector<FeltInterval> felt{{.ln_slopes = {9, 9, 9}, .lag = 12},
                                         {.ln_slopes = {1, 1, 1}, .lag = 12 + jnd}};
    right += chosen(felt, delay, judgement, 4, i) == 1 ? 1 : 0;
  }
  EXPECT_NEAR(right / 2000.0, 0.75, 0.04);
}

// With force the ball is found where the hand goes over it, without none is.
TEST(FeltObserverTest, ASearchSaysThePlaceThatIsStiffest) {
  const Study study = *parse_study(
      "task: \"locate\" ball { radius_mm: 8 ratio: 100 } depth { top_mm: 5 contrast_ln: 0.4248 } "
      "depth { "
      "top_mm: 10 contrast_ln: 0.132 } condition { name: \"force\" taps: 2 } condition { name: "
      "\"none\" "
      "taps: 2 feedback: \"none\" }",
      "s");
  const auto felt = FeltParticipants::make(study, {.weber = 0.08, .spread = 0, .lapse = 0});
  ASSERT_TRUE(felt) << felt.error().text;
  std::array<int, 2> found{};
  for (std::size_t i = 0; i < 5; ++i) {
    TrialAsk ask{.number = i, .level = 0.4248, .stronger = 0};
    ask.hidden = {-16e-3 + 8e-3 * static_cast<double>(i), 13e-3 - 6e-3 * static_cast<double>(i)};
    for (std::size_t condition = 0; condition < 2; ++condition) {
      const TrialOutcome out = felt->answer({0, condition}, ask);
      found[condition] += out.chosen == 0 ? 1 : 0;
      EXPECT_EQ(out.chosen == 0, out.error <= study.search.within);
      EXPECT_GT(out.path, 0.1);
      EXPECT_GT(out.force_mean, 0.1);
    }
  }
  EXPECT_GE(found[0], 4);
  EXPECT_LE(found[1], 3);
}

}  // namespace
}  // namespace palp::study
