#include "study/formula_participant.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "study/orders.h"
#include "tests/study/study_fixture.h"

namespace palp::study {
namespace {

TEST(FormulaParticipantTest, AnswersByTheFunctionOnBothSidesAlike) {
  const Study study = test::small_study();
  const PeopleTraits people{.weber = 0.15, .spread = 0, .lapse = 0};
  const Observer observer = formula_participants(study, people);
  std::array<int, 2> right{};
  constexpr std::size_t kTrials = 1000;
  for (std::size_t i = 0; i < 2 * kTrials; ++i) {
    const TrialAsk ask{.number = i, .level = std::log1p(0.15), .stronger = i % 2};
    right[i % 2] += observer({0, 0}, ask)->chosen == ask.stronger ? 1 : 0;
  }
  for (const int count : right) EXPECT_NEAR(count / double{kTrials}, 0.75, 0.055);
}

// At one JND half of what is left to chance is right: two of three.
TEST(FormulaParticipantTest, OfThreeChoosesWronglyEitherOther) {
  Study study = test::small_study();
  study.task.intervals = 3;
  const PeopleTraits people{.weber = 0.15, .spread = 0, .lapse = 0};
  const Observer observer = formula_participants(study, people);
  std::array<int, 3> further{};
  constexpr std::size_t kTrials = 3000;
  for (std::size_t i = 0; i < kTrials; ++i) {
    const TrialAsk ask{.number = i, .level = std::log1p(0.15), .stronger = i % 3};
    const TrialOutcome out = *observer({0, 0}, ask);
    ++further[(out.chosen + 3 - ask.stronger) % 3];
    ASSERT_EQ(out.taps, 9);
  }
  EXPECT_NEAR(further[0] / double{kTrials}, 2.0 / 3, 0.035);
  EXPECT_NEAR(further[1] / double{kTrials}, 1.0 / 6, 0.028);
}

TEST(FormulaParticipantTest, DoesAllTapsOfItsConditionAndPractisesWithTheAnswerTold) {
  const Study study = test::small_study();
  const Observer observer = formula_participants(study, PeopleTraits{});
  const TrialOutcome three = *observer({0, 0}, {.level = 0.2});
  EXPECT_EQ(three.taps, 6);
  EXPECT_EQ(observer({0, 1}, {.level = 0.2})->taps, 2);
  const TrialOutcome told = *observer({0, 0}, {.kind = TrialKind::Practice, .level = 0.2});
  EXPECT_NEAR(told.duration - three.duration, 1, 0.01);
  EXPECT_GT(three.response_time, 0.1);
}

TEST(FormulaParticipantTest, PeopleDiffer) {
  const PeopleTraits people;
  double squares = 0;
  for (std::size_t i = 0; i < 400; ++i) {
    const double ln = drawn_ln_jnd(people, 1, i) - std::log(std::log1p(people.weber));
    squares += ln * ln / 400;
  }
  EXPECT_NEAR(std::sqrt(squares), people.spread, 0.04);
}

// Neighbours are mistaken before the outer ones are: a wrong order is mostly one exchange away.
TEST(FormulaParticipantTest, OrdersThreeByWhatSeemsStiffer) {
  Study study = test::small_study();
  study.task = {.intervals = 3, .ranks = true};
  const PeopleTraits people{.weber = 0.15, .spread = 0, .lapse = 0};
  const Observer observer = formula_participants(study, people);
  std::array<int, 4> agreeing{};  // pairs out of order
  constexpr std::size_t kTrials = 3000;
  for (std::size_t i = 0; i < kTrials; ++i) {
    const TrialAsk ask{.number = i, .level = std::log1p(0.15), .stronger = i % 6};
    const TrialOutcome out = *observer({0, 0}, ask);
    ++agreeing[static_cast<std::size_t>(
        std::lround(1.5 * (1 - kendall_tau(ask.stronger, out.chosen))))];
    ASSERT_EQ(out.taps, 9);
  }
  EXPECT_NEAR(agreeing[0] / double{kTrials}, 7.0 / 12, 0.036);
  EXPECT_GT(agreeing[1], 4 * agreeing[2]);
  EXPECT_GT(agreeing[2], agreeing[3]);
}

TEST(FormulaParticipantTest, FindsABallAsOftenAsTheFunctionSaysAndSaysAPlaceThatFits) {
  const Study study = *parse_study(
      "task: \"locate\" condition { name: \"one\" } ball { radius_mm: 8 ratio: 100 } depth { "
      "top_mm: 5 "
      "contrast_ln: 0.4 } depth { top_mm: 9 contrast_ln: 0.2 }",
      "s");
  const PeopleTraits people{.weber = 0.15, .spread = 0, .lapse = 0};
  const Observer observer = formula_participants(study, people);
  int found = 0;
  constexpr std::size_t kTrials = 2000;
  for (std::size_t i = 0; i < kTrials; ++i) {
    const TrialAsk ask{.number = i, .level = std::log1p(0.15), .hidden = {15e-3, -19e-3}};
    const TrialOutcome out = *observer({0, 0}, ask);
    found += out.chosen == 0 ? 1 : 0;
    ASSERT_EQ(out.chosen == 0, out.error <= study.search.within);
    ASSERT_LT(out.error, std::hypot(35e-3, 39e-3));
    ASSERT_GT(out.path, 0.1);
  }
  EXPECT_NEAR(found / double{kTrials}, (1 + chance(study.task)) / 2, 0.045);
}

}  // namespace
}  // namespace palp::study
