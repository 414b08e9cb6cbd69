#include "study/closed_loop/felt_observer.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp::study {
namespace {

std::array<std::vector<double>, 2> felt(double difference) {
  return {std::vector<double>(3, 5.0), std::vector<double>(3, 5.0 + difference)};
}

double share_second(const std::array<std::vector<double>, 2>& what, const Judgement& judgement) {
  constexpr std::uint64_t kTrials = 4000;
  double seconds = 0;
  for (std::uint64_t i = 0; i < kTrials; ++i)
    seconds += judge_second(what, judgement, 1, i) ? 1 : 0;
  return seconds / double{kTrials};
}

// With the own finger and three taps the Weber fraction is the one that was asked for.
TEST(JudgementTest, HasTheWeberFractionItIsMadeFor) {
  for (const double weber : {0.08, 0.15, 0.22, 0.45}) {
    const Judgement judgement = judgement_of(weber, 0, 1);
    EXPECT_NEAR(judgement.jnd(3, 1), std::log1p(weber), 1e-9);
    EXPECT_NEAR(share_second(felt(std::log1p(weber)), judgement), 0.75, 0.03);
    EXPECT_NEAR(share_second(felt(-std::log1p(weber)), judgement), 0.25, 0.03);
    EXPECT_NEAR(share_second(felt(0), judgement), 0.5, 0.03);
  }
}

TEST(JudgementTest, OneTapIsLessCertainAndHalfOfADifferenceDoublesTheJnd) {
  const Judgement judgement = judgement_of(0.15, 0, 1);
  EXPECT_GT(judgement.jnd(1, 1), 1.1 * judgement.jnd(3, 1));
  EXPECT_DOUBLE_EQ(judgement.jnd(3, 0.5), 2 * judgement.jnd(3, 1));
}

TEST(JudgementTest, WhereNothingWasFeltItIsACoin) {
  const Judgement judgement = judgement_of(0.15, 0, 1);
  auto what = felt(3);
  EXPECT_GT(share_second(what, judgement), 0.99);
  what[0].clear();
  EXPECT_NEAR(share_second(what, judgement), 0.5, 0.03);
}

TEST(JudgementTest, PeopleKnowWhatTheirOwnFingerShows) {
  EXPECT_NEAR(share_second(felt(0.5 * std::log1p(0.15)), judgement_of(0.15, 0, 0.5)), 0.75, 0.03);
}

TEST(SettingTest, TheStrongerOneIsWhereTheScheduleSaysAndTapsVary) {
  const TrialAsk ask{.level = 0.3, .stronger = 0};
  const FeltSetting first = setting_of(ask, false, 3, 0.1, 7);
  EXPECT_EQ(first.ln_stiffness, (std::array{0.3, 0.0}));
  EXPECT_EQ(setting_of({.level = 0.3, .stronger = 1}, false, 3, 0.1, 7).ln_stiffness,
            (std::array{0.0, 0.3}));
  EXPECT_EQ(setting_of({.level = -0.3, .stronger = 0}, true, 3, 0.1, 7).ln_stiffness,
            (std::array{0.0, -0.3}));
  ASSERT_EQ(first.depth[0].size(), 3U);
  EXPECT_NE(first.depth[0][0], first.depth[0][1]);
  EXPECT_NE(first.depth[0][0], first.depth[1][0]);
  EXPECT_NEAR(first.depth[0][0], 4e-3, 1.3e-3);
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

TEST(FeltParticipantsTest, FeelTwoPlacesAndNoMore) {
  const Study study = *parse_study("intervals: 3 condition { name: \"one\" }", "study");
  EXPECT_FALSE(FeltParticipants::make(study, {}));
}

}  // namespace
}  // namespace palp::study
