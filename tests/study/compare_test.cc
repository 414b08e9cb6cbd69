#include "study/compare.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "common/core/random.h"

namespace palp::study {
namespace {

TEST(CompareTest, TheRatioOfEqualMeasuresIsOne) {
  const RatioStatement equal = ratio_of({-1.9, 0.2}, {-1.9, 0.2});
  EXPECT_DOUBLE_EQ(equal.ratio, 1);
  EXPECT_DOUBLE_EQ(equal.larger, 0.5);
  const RatioStatement other = ratio_of({-1.9, 0.3}, {-1.9 + std::log(2), 0.4});
  EXPECT_NEAR(other.ratio, 2, 1e-12);
  EXPECT_NEAR(std::log(other.high / other.low), 2 * 1.959964 * 0.5, 1e-5);
  // Turned round, it is the inverse.
  const RatioStatement back = ratio_of({-1.9 + std::log(2), 0.4}, {-1.9, 0.3});
  EXPECT_NEAR(back.ratio, 0.5, 1e-12);
  EXPECT_NEAR(back.larger, 1 - other.larger, 1e-12);
}

// Student's sleep data (1908), the example of most textbooks: t = 4.0621, p = 0.002833, interval
// 0.700 to 2.460.
TEST(CompareTest, AgreesWithStudentsSleepData) {
  const std::array<double, 10> gained{1.2, 2.4, 1.3, 1.3, 0.0, 1.0, 1.8, 0.8, 4.6, 1.4};
  const PairedTest found = paired_test(gained, 0.5);
  EXPECT_NEAR(found.mean, 1.58, 1e-12);
  EXPECT_NEAR(found.p, 0.002833, 1e-6);
  EXPECT_NEAR(found.low, 0.7001142, 1e-6);
  EXPECT_NEAR(found.high, 2.4598858, 1e-6);
  EXPECT_GT(found.equivalent, 0.9);
  // Nine of nine differences that are not 0 are positive: 2 / 2^9.
  EXPECT_NEAR(found.p_ranks, 2.0 / 512, 1e-12);
}

// Two people with the very same difference prove nothing of all others.
TEST(CompareTest, DifferencesThatAreAllAlikeAreNotTested) {
  for (const double value : {0.0, 0.1}) {
    const PairedTest found = paired_test(std::array{value, value, value}, 0.15);
    EXPECT_NEAR(found.mean, value, 1e-12);
    for (const double none : {found.low, found.high, found.p, found.hedges_g, found.equivalent}) {
      EXPECT_TRUE(std::isnan(none));
    }
  }
  const auto adjusted = holm_adjusted(std::array{0.02, std::nan(""), 0.03});
  EXPECT_DOUBLE_EQ(adjusted[0], 0.04);
  EXPECT_TRUE(std::isnan(adjusted[1]));
  EXPECT_DOUBLE_EQ(adjusted[2], 0.04);
}

TEST(CompareTest, SignsTurnedTurnTheMeanAndNothingElse) {
  std::vector<double> values;
  std::vector<double> turned;
  for (std::uint64_t i = 0; i < 30; ++i) {
    values.push_back(0.1 + 0.3 * random_normal(1, 1, i));
    turned.push_back(-values.back());
  }
  const PairedTest one = paired_test(values, 0.15);
  const PairedTest other = paired_test(turned, 0.15);
  EXPECT_DOUBLE_EQ(one.mean, -other.mean);
  EXPECT_DOUBLE_EQ(one.p, other.p);
  EXPECT_DOUBLE_EQ(one.p_ranks, other.p_ranks);
  EXPECT_NEAR(one.equivalent, other.equivalent, 1e-12);
  EXPECT_NEAR(one.low, -other.high, 1e-12);
}

// Where nothing differs, 5 in 100 tests say so, by either test; four standard errors.
TEST(CompareTest, ErrsAsOftenAsItSays) {
  for (const std::size_t n : {8U, 25U}) {
    int t = 0;
    int ranks = 0;
    int held = 0;
    constexpr int kRuns = 2000;
    for (std::uint64_t run = 0; run < kRuns; ++run) {
      std::vector<double> values;
      for (std::uint64_t i = 0; i < n; ++i) values.push_back(random_normal(7, n, run * 100 + i));
      const PairedTest found = paired_test(values, 0.15);
      t += found.p < 0.05 ? 1 : 0;
      ranks += found.p_ranks < 0.05 ? 1 : 0;
      held += found.low <= 0 && found.high >= 0 ? 1 : 0;
    }
    const double error = 4 * std::sqrt(0.05 * 0.95 / kRuns);
    EXPECT_NEAR(t / double{kRuns}, 0.05, error) << n;
    EXPECT_EQ(held, kRuns - t);
    EXPECT_LT(ranks / double{kRuns}, 0.05 + error) << n;
    EXPECT_GT(ranks / double{kRuns}, 0.02) << n;
  }
}

TEST(CompareTest, ExactMeasuresGiveTheGroupsMeanAndSpread) {
  std::vector<Measured> people;
  for (std::uint64_t i = 0; i < 60; ++i)
    people.push_back({0.3 + 0.2 * random_normal(3, 1, i), 0.01});
  const GroupPosterior found = group_posterior(people);
  double mean = 0;
  for (const Measured& one : people) mean += one.value / 60;
  EXPECT_NEAR(found.mean, mean, 0.003);
  EXPECT_NEAR(found.tau, 0.2, 0.05);
  EXPECT_GT(found.above, 0.999);
}

TEST(CompareTest, ACarelessMeasureCountsLess) {
  const std::array<Measured, 3> people{{{0.1, 0.05}, {0.1, 0.05}, {2.0, 5.0}}};
  EXPECT_NEAR(group_posterior(people).mean, 0.1, 0.05);
}

TEST(CompareTest, HolmKeepsTheOrderAndNeverLowers) {
  const std::array<double, 4> p{0.01, 0.04, 0.03, 0.005};
  const auto adjusted = holm_adjusted(p);
  EXPECT_NEAR(adjusted[3], 0.02, 1e-12);
  EXPECT_NEAR(adjusted[0], 0.03, 1e-12);
  EXPECT_NEAR(adjusted[2], 0.06, 1e-12);
  EXPECT_NEAR(adjusted[1], 0.06, 1e-12);
}

// Cohen 1988 and tables since: 34 pairs find half a standard deviation in 80 of 100 cases.
TEST(CompareTest, NeedsAsManyParticipantsAsTablesSay) {
  EXPECT_EQ(participants_needed(0.5, 1), 34);
  EXPECT_EQ(participants_needed(0.8, 1), 15);
  EXPECT_EQ(participants_needed(0.5, 1, 0.9), 44);
  EXPECT_EQ(participants_needed(50, 1), 2);
}

}  // namespace
}  // namespace palp::study
