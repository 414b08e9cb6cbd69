#include "study/answer_posterior.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "common/core/random.h"

namespace palp::study {
namespace {

const AnswerTable& forced_choice() {
  static const AnswerTable table{{}, {}, {}, even_levels(0.02, 1.2, 25)};
  return table;
}

TEST(AnswerPosteriorTest, BeginsAsThePrior) {
  const Marginal begin = AnswerPosterior{forced_choice()}.ln_jnd();
  EXPECT_NEAR(begin.median, std::log(0.15), 0.03);
  EXPECT_NEAR(begin.sd, 1, 0.05);
}

TEST(AnswerPosteriorTest, TheOrderOfAnswersDoesNotMatter) {
  AnswerPosterior one{forced_choice()};
  AnswerPosterior other{forced_choice()};
  for (std::size_t i = 0; i < 25; ++i) {
    one.told(i, i % 3 != 0);
    other.told(24 - i, (24 - i) % 3 != 0);
  }
  for (std::size_t i = 0; i < one.weights().size(); ++i) {
    ASSERT_NEAR(one.weights()[i], other.weights()[i], 1e-14);
  }
}

TEST(AnswerPosteriorTest, MistakesAtAnEasyLevelRaiseTheJnd) {
  AnswerPosterior posterior{forced_choice()};
  const double before = posterior.ln_jnd().median;
  for (int i = 0; i < 4; ++i) posterior.told(18, false);
  EXPECT_GT(posterior.ln_jnd().median, before + 0.5);
}

TEST(AnswerPosteriorTest, WeightsStayOne) {
  AnswerPosterior posterior{forced_choice()};
  for (std::size_t i = 0; i < 500; ++i) posterior.told(i % 25, random_bits(1, 2, i) % 4 != 0);
  const auto weights = posterior.weights();
  EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1, 1e-12);
}

// The expectation over the answer, done by telling both answers.
TEST(AnswerPosteriorTest, ExpectedEntropyIsTheMeanOverBothAnswers) {
  const AnswerTable table{{}, {}, {.jnd_count = 15, .lapse_count = 4}, even_levels(0.02, 1.2, 5)};
  AnswerPosterior posterior{table};
  for (const std::size_t level : {4U, 3U, 3U, 2U}) posterior.told(level, level != 2);
  const auto entropy = [&](const AnswerPosterior& of) {
    double sum = 0;
    for (std::size_t i = 0; i < 15; ++i) {
      const double p =
          std::accumulate(of.weights().begin() + static_cast<std::ptrdiff_t>(4 * i),
                          of.weights().begin() + static_cast<std::ptrdiff_t>(4 * i + 4),
                          0.0);
      sum -= p * std::log(p);
    }
    return sum;
  };
  for (std::size_t level = 0; level < 5; ++level) {
    double right = 0;
    for (std::size_t i = 0; i < posterior.weights().size(); ++i) {
      right += posterior.weights()[i] * table.shares(level)[i];
    }
    AnswerPosterior after_right = posterior;
    AnswerPosterior after_wrong = posterior;
    after_right.told(level, true);
    after_wrong.told(level, false);
    EXPECT_NEAR(posterior.expected_entropy(level),
                right * entropy(after_right) + (1 - right) * entropy(after_wrong),
                1e-9);
  }
}

TEST(AnswerPosteriorTest, TwoSidedAnswersFindTheBias) {
  const Task task{.two_sided = true};
  std::vector<double> levels;
  for (int i = -13; i <= 13; ++i) levels.push_back(0.05 * i);
  const AnswerTable table{task, {}, {.jnd_count = 31, .lapse_count = 4}, levels};
  AnswerPosterior posterior{table};
  const ObserverTraits truth{.jnd = 0.15, .pse = -0.2, .lapse = 0};
  for (std::size_t round = 0; round < 40; ++round) {
    for (std::size_t level = 0; level < levels.size(); ++level) {
      posterior.told(
          level,
          random_uniform(3, 1, round * 27 + level) < answer_share(task, truth, levels[level]));
    }
  }
  EXPECT_NEAR(posterior.pse().mean, -0.2, 3 * posterior.pse().sd);
  EXPECT_LT(posterior.pse().sd, 0.02);
  EXPECT_NEAR(posterior.ln_jnd().mean, std::log(0.15), 3 * posterior.ln_jnd().sd);
}

TEST(AnswerPosteriorTest, NearestLevelIsNearest) {
  const AnswerTable table{{}, {}, {.jnd_count = 3, .lapse_count = 2}, {0.1, 0.2, 0.4}};
  EXPECT_EQ(table.nearest(0), 0U);
  EXPECT_EQ(table.nearest(0.16), 1U);
  EXPECT_EQ(table.nearest(0.29), 1U);
  EXPECT_EQ(table.nearest(0.31), 2U);
  EXPECT_EQ(table.nearest(9), 2U);
}

}  // namespace
}  // namespace palp::study
