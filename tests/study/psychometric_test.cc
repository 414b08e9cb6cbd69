#include "study/psychometric.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "common/core/random.h"

namespace palp::study {
namespace {

TEST(PsychometricTest, EqualStimuliAreGuessed) {
  for (int m = 2; m <= 8; ++m) EXPECT_NEAR(forced_choice_share(0, m), 1.0 / m, 1e-9) << m;
}

// Hacker and Ratcliff 1979, table 1: shares right for d' = 1 and 2 in 2 and 3 intervals.
TEST(PsychometricTest, AgreesWithPublishedTablesOfForcedChoice) {
  EXPECT_NEAR(forced_choice_share(1, 2), 0.760, 5e-4);
  EXPECT_NEAR(forced_choice_share(1, 3), 0.634, 5e-4);
  EXPECT_NEAR(forced_choice_share(2, 2), 0.921, 5e-4);
  EXPECT_NEAR(forced_choice_share(2, 3), 0.866, 5e-4);
}

// Others far below the stronger one do not matter, and each that is nearer costs answers.
TEST(PsychometricTest, TheOthersMayStandAtDifferentHeights) {
  EXPECT_NEAR(forced_choice_share(std::array{1.0, 20.0, 20.0}), forced_choice_share(1, 2), 1e-9);
  EXPECT_NEAR(forced_choice_share(std::array{1.0, 1.0}), forced_choice_share(1, 3), 1e-12);
  EXPECT_LT(forced_choice_share(std::array{1.0, 0.5}), forced_choice_share(1, 3));
  EXPECT_GT(forced_choice_share(std::array{1.0, 1.5}), forced_choice_share(1, 3));
}

// The integral for m intervals, of which two-interval answers have a closed form.
TEST(PsychometricTest, SharesGrowWithTheSignalAndFallWithTheIntervals) {
  for (int m = 2; m < 8; ++m) {
    double before = 0;
    for (double d = 0; d < 5; d += 0.25) {
      const double share = forced_choice_share(d, m);
      EXPECT_GT(share, before);
      EXPECT_GT(share, forced_choice_share(d, m + 1));
      before = share;
    }
  }
}

TEST(PsychometricTest, OneJndIsToldApartHalfOfTheTimeAfterChance) {
  for (const int m : {2, 3, 4}) {
    const Task task{.intervals = m};
    const double chance = 1.0 / m;
    EXPECT_NEAR(answer_share(task, {.jnd = 0.2}, 0.2), chance + (1 - chance) / 2, 1e-9);
  }
}

// Of rankings and searches too; and who feels nothing is right as often as a guess is.
TEST(PsychometricTest, EveryTaskHasItsChanceAndItsJnd) {
  const Task rank{.intervals = 3, .ranks = true};
  const Task search{.intervals = 1, .places = 7.3};
  const Task delay{.delays = true};
  EXPECT_DOUBLE_EQ(chance(rank), 1.0 / 6);
  EXPECT_DOUBLE_EQ(chance(search), 1 / 7.3);
  EXPECT_DOUBLE_EQ(chance({.two_sided = true, .yes_no = true}), 0.5);
  for (const Task& task : {rank, search, delay, Task{}, Task{.intervals = 4}}) {
    for (const double lapse : {0.0, 0.06}) {
      const ObserverTraits traits{.jnd = 0.2, .lapse = lapse};
      EXPECT_NEAR(answer_share(task, traits, 0), chance(task), 1e-9);
      EXPECT_NEAR(answer_share(task, traits, 0.2),
                  lapse * chance(task) + (1 - lapse) * (1 + chance(task)) / 2,
                  1e-9);
      EXPECT_NEAR(answer_share(task, traits, 4), 1 - lapse * (1 - chance(task)), 1e-6);
    }
  }
}

// Against as many draws of three stimuli.
TEST(PsychometricTest, OrdersAreAsOftenRightAsDrawsAre) {
  for (const auto& [first, second] : {std::pair{0.5, 0.5}, {1.2, 0.3}, {0.0, 2.0}}) {
    constexpr std::uint64_t kDraws = 40'000;
    std::uint64_t right = 0;
    for (std::uint64_t i = 0; i < kDraws; ++i) {
      const double low = random_normal(3, 1, i);
      const double middle = first + random_normal(3, 2, i);
      const double high = first + second + random_normal(3, 3, i);
      right += low < middle && middle < high ? 1 : 0;
    }
    EXPECT_NEAR(order_share(first, second), static_cast<double>(right) / kDraws, 0.0075);
  }
}

TEST(PsychometricTest, TwoSidedAnswersAreEvenAroundThePse) {
  const Task task{.two_sided = true};
  const ObserverTraits traits{.jnd = 0.15, .pse = 0.1, .lapse = 0.04};
  EXPECT_DOUBLE_EQ(answer_share(task, traits, 0.1), 0.5);
  for (const double off : {0.05, 0.15, 0.6}) {
    EXPECT_NEAR(
        answer_share(task, traits, 0.1 + off) + answer_share(task, traits, 0.1 - off), 1, 1e-12);
  }
  EXPECT_NEAR(answer_share(task, {.jnd = 0.15}, 0.15), 0.75, 1e-9);
}

TEST(PsychometricTest, LapsesAreGuesses) {
  const Task task{.intervals = 3};
  EXPECT_NEAR(answer_share(task, {.jnd = 0.1, .lapse = 0.3}, 5), 0.7 + 0.3 / 3, 1e-9);
  EXPECT_NEAR(answer_share(task, {.jnd = 0.1, .lapse = 1}, 5), 1.0 / 3, 1e-9);
}

// Information is what an answer tells: none at equality, and scaled answers tell the same.
TEST(PsychometricTest, TheBoundDoesNotDependOnTheJndAndFallsWithTheRoot) {
  const Task task;
  EXPECT_NEAR(jnd_information(task, {.jnd = 0.1}, 0), 0, 1e-12);
  const double bound = jnd_bound(task, {.jnd = 0.1, .lapse = 0.02}, 60);
  EXPECT_NEAR(jnd_bound(task, {.jnd = 0.3, .lapse = 0.02}, 60), bound, 1e-6);
  EXPECT_NEAR(jnd_bound(task, {.jnd = 0.1, .lapse = 0.02}, 240), bound / 2, 1e-9);
  EXPECT_GT(jnd_bound(task, {.jnd = 0.1, .lapse = 0.05}, 60), bound);
}

TEST(PsychometricTest, PoolingKeepsEveryAnswer) {
  const std::array<Answers, 4> answers{{{0.2, 1, 1}, {0.1, 0, 1}, {0.2, 0, 1}, {0.1, 1, 2}}};
  const auto out = pooled(answers);
  ASSERT_EQ(out.size(), 2U);
  EXPECT_EQ(out[0].yes, 1U);
  EXPECT_EQ(out[0].trials, 3U);
  EXPECT_EQ(out[1].yes, 1U);
  EXPECT_EQ(out[1].trials, 2U);
}

TEST(PsychometricTest, LevelsAreEvenInTheirLogarithm) {
  const auto levels = even_levels(0.02, 1.28, 7);
  EXPECT_DOUBLE_EQ(levels.front(), 0.02);
  EXPECT_NEAR(levels.back(), 1.28, 1e-12);
  for (std::size_t i = 1; i < levels.size(); ++i) EXPECT_NEAR(levels[i] / levels[i - 1], 2, 1e-12);
}

}  // namespace
}  // namespace palp::study
