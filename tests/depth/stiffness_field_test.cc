#include "depth/stiffness_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/core/random.h"

// Goal: what near places show of one another is counted once, under each guess.
// Method: closed forms of one and two places, and laws of any covariance for many.
namespace palp::depth {
namespace {

constexpr double kSpread = 0.05;

std::vector<Place> places_of(std::uint64_t seed, std::size_t count, double half) {
  const RandomStream random{seed, 1};
  std::vector<Place> out;
  for (std::size_t i = 0; i < count; ++i) {
    out.push_back(
        {half * (2 * random.uniform(2 * i) - 1), half * (2 * random.uniform(2 * i + 1) - 1)});
  }
  return out;
}

/// What is shown, weighed by the inverse of the covariance: a' C^-1 b.
double product(const StiffnessField& field,
               std::size_t guess,
               const std::vector<double>& own,
               const std::vector<double>& a,
               const std::vector<double>& b) {
  std::vector<double> rows;
  for (std::size_t i = 0; i < a.size(); ++i) {
    rows.push_back(a[i]);
    rows.push_back(b[i]);
  }
  const auto whitened = field.whiten(own, 2, rows);
  const auto white = whitened.of(guess);
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += white[2 * i] * white[2 * i + 1];
  return sum;
}

/// How well the mean of the tissue is known from these places.
double information(const StiffnessField& field, std::size_t guess, std::size_t count) {
  const std::vector<double> ones(count, 1);
  return product(field, guess, std::vector<double>(count, 1e-4), ones, ones);
}

TEST(StiffnessFieldTest, GuessesAreAPriorThatMostlyIsTheSpreadGiven) {
  const StiffnessField field{{{0, 0}}, kSpread};
  double all = 0;
  double whole = 0;
  for (std::size_t i = 0; i < StiffnessField::kGuesses; ++i) {
    all += field.guess(i).share;
    if (field.guess(i).spread == kSpread) whole += field.guess(i).share;
    EXPECT_LE(field.guess(i).spread, 2 * kSpread);
  }
  EXPECT_NEAR(all, 1, 1e-12);
  EXPECT_GT(whole, 0.6);
  const FieldGuess& plain = field.guess(StiffnessField::kIndependent);
  EXPECT_EQ(plain.spread, kSpread);
  EXPECT_EQ(plain.length, 0);
}

TEST(StiffnessFieldTest, TwoPlacesAreWeighedByTheirCovariance) {
  const StiffnessField field{{{0, 0}, {7e-3, 0}}, kSpread};
  const std::vector<double> own{1e-4, 3e-4};
  for (std::size_t guess = 0; guess < StiffnessField::kGuesses; ++guess) {
    const FieldGuess& one = field.guess(guess);
    const double variance = one.spread * one.spread;
    const double shared = variance * one.correlation({0, 0}, {7e-3, 0});
    const double determinant = (variance + own[0]) * (variance + own[1]) - shared * shared;
    const auto whitened = field.whiten(own, 1, {0.02, -0.01});
    EXPECT_NEAR(whitened.log_determinant[guess], std::log(determinant), 1e-9);
    const auto rows = whitened.of(guess);
    const double form = (0.02 * 0.02 * (variance + own[1]) + 0.01 * 0.01 * (variance + own[0]) +
                         2 * 0.02 * 0.01 * shared) /
                        determinant;
    EXPECT_NEAR(rows[0] * rows[0] + rows[1] * rows[1], form, 1e-9 * form);
  }
}

/// The more alike places are, the less a second one tells of the tissue's mean.
TEST(StiffnessFieldTest, PlacesSideBySideTellLessThanPlacesApart) {
  for (std::size_t guess = 0; guess < StiffnessField::kGuesses; ++guess) {
    double before = 0;
    for (const double apart : {2e-3, 5e-3, 10e-3, 40e-3, 200e-3}) {
      const StiffnessField field{{{0, 0}, {apart, 0}}, kSpread};
      const double now = information(field, guess, 2);
      EXPECT_GE(now, before);
      before = now;
    }
    const double alone = information(StiffnessField{{{0, 0}}, kSpread}, guess, 1);
    EXPECT_NEAR(before, 2 * alone, 1e-6 * alone);  // far apart: independent
  }
}

RC_GTEST_PROP(StiffnessFieldTest, TheOrderOfPlacesDoesNotMatter, (std::uint64_t seed)) {
  auto places = places_of(seed, 9, 15e-3);
  const RandomStream random{seed, 2};
  std::vector<double> own;
  std::vector<double> a;
  std::vector<double> b;
  for (std::size_t i = 0; i < places.size(); ++i) {
    own.push_back(1e-4 * (1 + random.uniform(3 * i)));
    a.push_back(random.normal(3 * i + 1));
    b.push_back(random.normal(3 * i + 2));
  }
  const StiffnessField one{places, kSpread};
  std::reverse(places.begin(), places.end());
  const StiffnessField other{places, kSpread};
  const auto reversed = [](std::vector<double> values) {
    std::reverse(values.begin(), values.end());
    return values;
  };
  for (std::size_t guess = 0; guess < StiffnessField::kGuesses; ++guess) {
    const double first = product(one, guess, own, a, b);
    const double second = product(other, guess, reversed(own), reversed(a), reversed(b));
    RC_ASSERT(std::abs(first - second) <= 1e-7 * (std::abs(first) + 1));
  }
}

RC_GTEST_PROP(StiffnessFieldTest, OneMorePlaceLeavesNothingMoreOpen, (std::uint64_t seed)) {
  auto places = places_of(seed, 8, 20e-3);
  const std::vector<Place> others = places_of(seed + 1, 20, 30e-3);
  const StiffnessField more{places, kSpread};
  places.pop_back();
  const StiffnessField fewer{places, kSpread};
  const std::vector<double> own(8, 1e-4);
  const std::vector<double> shown(8, 0.01);
  for (std::size_t guess = 0; guess < StiffnessField::kGuesses; ++guess) {
    const auto after = more.told(guess, own, shown, others);
    const auto before =
        fewer.told(guess, {own.begin(), own.end() - 1}, {shown.begin(), shown.end() - 1}, others);
    const double all = more.guess(guess).spread * more.guess(guess).spread;
    for (std::size_t i = 0; i < others.size(); ++i) {
      RC_ASSERT(after[i].variance <= before[i].variance + 1e-12);
      RC_ASSERT(before[i].variance <= all + 1e-12);
    }
  }
}

/// Who touches one spot again and again makes a chain of places, each near the next.
TEST(StiffnessFieldTest, PlacesHoweverNearHaveACovariance) {
  const StiffnessField field{{{0, 0}, {0.7e-3, 0}, {1.4e-3, 0}, {1.4e-3, 0.7e-3}}, kSpread};
  const auto whitened = field.whiten(std::vector<double>(4, 1e-4), 1, {0.01, 0, -0.01, 0.02});
  for (std::size_t guess = 0; guess < StiffnessField::kGuesses; ++guess) {
    EXPECT_TRUE(std::isfinite(whitened.log_determinant[guess])) << guess;
    for (const double one : whitened.of(guess)) EXPECT_TRUE(std::isfinite(one)) << guess;
  }
}

TEST(StiffnessFieldTest, ATouchedPlaceIsKnownAndAFarOneIsNot) {
  const StiffnessField field{{{0, 0}, {9e-3, 0}}, kSpread};
  const std::vector<double> own(2, 1e-9);
  for (std::size_t guess = 0; guess < StiffnessField::kGuesses; ++guess) {
    const auto told = field.told(guess, own, {0.03, -0.02}, {{0, 0}, {9e-3, 0}, {0.5, 0}});
    const double all = field.guess(guess).spread * field.guess(guess).spread;
    EXPECT_NEAR(told[0].mean, 0.03, 1e-4);
    EXPECT_NEAR(told[1].mean, -0.02, 1e-4);
    EXPECT_LT(told[0].variance, 2e-9);
    EXPECT_NEAR(told[2].mean, 0, 1e-9);
    EXPECT_NEAR(told[2].variance, all, 1e-9);
  }
}

}  // namespace
}  // namespace palp::depth
