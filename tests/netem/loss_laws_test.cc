#include "netem/loss_laws.h"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

namespace palp::netem {
namespace {

ChanceProcess process(double share, double correlation) {
  return {Chance{share, correlation}, RandomStream{7, 3}};
}

TEST(ChanceProcessTest, WhoIsToldThatSomePassedSaysWhatWhoWasAskedSays) {
  for (const auto& [share, correlation] : {std::pair{0.02, 0.0}, {0.3, 0.25}, {0.5, 0.9}}) {
    ChanceProcess asked = process(share, correlation);
    ChanceProcess told = process(share, correlation);
    for (int k = 0; k < 20'000;) {
      const std::uint64_t quiet = told.quiet();
      for (std::uint64_t i = 0; i < quiet; ++i, ++k) ASSERT_FALSE(asked.next()) << k;
      told.skip(quiet);
      ASSERT_EQ(told.next(), asked.next()) << k;
      ++k;
    }
  }
}

TEST(ChanceProcessTest, NeverAndAlwaysAreExact) {
  ChanceProcess never = process(0, 0.5);
  ChanceProcess always = process(1, 0);
  ChanceProcess stuck = process(0.5, 1);
  const bool first = stuck.next();
  for (int k = 0; k < 10'000; ++k) {
    EXPECT_FALSE(never.next());
    EXPECT_TRUE(always.next());
    EXPECT_EQ(stuck.next(), first);
  }
}

/// Goal: a change in mid-run does not bend the share. Method: the law is set anew before each
/// datagram, as on a ramp; the share of hits lies within four standard errors.
TEST(ChanceProcessTest, SetAnewForEachDatagramItStillHitsItsShare) {
  constexpr int kCount = 100'000;
  constexpr double kShare = 0.07;
  ChanceProcess chance = process(kShare, 0.3);
  int hits = 0;
  for (int k = 0; k < kCount; ++k) {
    chance.change({kShare, k % 2 == 0 ? 0.3 : 0.2});
    hits += chance.next() ? 1 : 0;
  }
  const double error = std::sqrt(kShare * (1 - kShare) / kCount);
  EXPECT_NEAR(static_cast<double>(hits) / kCount, kShare, 4 * error);
}

TEST(ChanceProcessTest, TheSameLawSaidAgainChangesNothing) {
  ChanceProcess one = process(0.2, 0.3);
  ChanceProcess other = process(0.2, 0.3);
  for (int k = 0; k < 1000; ++k) {
    other.change({0.2, 0.3});
    ASSERT_EQ(one.next(), other.next()) << k;
  }
}

TEST(ChanceProcessTest, RunsAreAsLongAsTheCorrelationMakesThem) {
  constexpr double kShare = 0.1;
  constexpr double kCorrelation = 0.4;
  ChanceProcess chance = process(kShare, kCorrelation);
  int hits = 0;
  int runs = 0;
  bool before = false;
  for (int k = 0; k < 400'000; ++k) {
    const bool hit = chance.next();
    hits += hit ? 1 : 0;
    runs += hit && !before ? 1 : 0;
    before = hit;
  }
  const double stays = kShare + kCorrelation * (1 - kShare);
  const double mean = 1 / (1 - stays);
  const double spread = std::sqrt(stays) / (1 - stays);
  EXPECT_NEAR(static_cast<double>(hits) / runs, mean, 4 * spread / std::sqrt(runs));
}

}  // namespace
}  // namespace palp::netem
