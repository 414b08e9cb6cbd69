#include "netem/model/loss_laws.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <gmock/gmock.h>
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

/// Goal: on a ramp runs stay as long as the correlation makes them. Method: a law that moves by a
/// hair with each datagram; the shares of hits and of hits behind hits lie within four standard
/// errors (runs of 14 and 33: a hundredth of the datagrams is as good as independent).
TEST(ChanceProcessTest, OnARampItKeepsItsCorrelation) {
  constexpr int kCount = 400'000;
  ChanceProcess chance = process(0.3, 0.9);
  int hits = 0;
  int behind = 0;
  bool before = false;
  for (int k = 0; k < kCount; ++k) {
    chance.lean({0.3 + 1e-9 * k, 0.9});
    const bool hit = chance.next();
    hits += hit ? 1 : 0;
    behind += hit && before ? 1 : 0;
    before = hit;
  }
  EXPECT_NEAR(static_cast<double>(hits) / kCount, 0.3, 4 * std::sqrt(0.21 / (kCount / 100.0)));
  EXPECT_NEAR(static_cast<double>(behind) / hits, 0.93, 4 * std::sqrt(0.93 * 0.07 / hits));
}

TEST(ChanceProcessTest, LeantFromNeverItBeginsToHitAndLeantToNeverItStops) {
  ChanceProcess chance = process(0, 0);
  EXPECT_FALSE(chance.next());
  chance.lean({1, 0});
  (void)chance.next();  // this one was decided before
  EXPECT_TRUE(chance.next());
  chance.lean({0, 0});
  EXPECT_FALSE(chance.next());
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

/// Goal: who is told that some passed says what who was asked says, of the chains too.
template <class Process>
void told_says_what_asked_says(Process asked, Process told) {
  for (int k = 0; k < 20'000;) {
    const std::uint64_t quiet = std::min<std::uint64_t>(told.quiet(), 1000);
    for (std::uint64_t i = 0; i < quiet; ++i, ++k) ASSERT_EQ(asked.next(), 0) << k;
    told.skip(quiet);
    ASSERT_EQ(told.next(), asked.next()) << k;
    ++k;
  }
}

TEST(FourStateProcessTest, WhoIsToldThatSomePassedSaysWhatWhoWasAskedSays) {
  const FourStateLaw law{.p13 = 0.02, .p31 = 0.2, .p32 = 0.3, .p23 = 0.1, .p14 = 0.01};
  told_says_what_asked_says(FourStateProcess{law, RandomStream{7, 3}},
                            FourStateProcess{law, RandomStream{7, 3}});
}

TEST(GemodelProcessTest, WhoIsToldThatSomePassedSaysWhatWhoWasAskedSays) {
  const GemodelLaw law{.to_bad = 0.02, .to_good = 0.3};
  told_says_what_asked_says(GemodelProcess{law, RandomStream{7, 3}},
                            GemodelProcess{law, RandomStream{7, 3}});
}

/// Goal: drawn run by run, the chain is still the one of the words. Method: the matrix of the
/// chain, stepped datagram by datagram on a generator of the test's own, gives share and mean
/// length of the runs of losses; both within four standard errors.
TEST(FourStateProcessTest, LosesWhatTheChainStepByStepLoses) {
  const FourStateLaw law{.p13 = 0.03, .p31 = 0.2, .p32 = 0.3, .p23 = 0.1, .p14 = 0.02};
  constexpr int kCount = 400'000;
  FourStateProcess process{law, RandomStream{7, 3}};
  const RandomStream steps{8, 4};
  int state = 1;
  std::array<int, 2> losses{};
  std::array<int, 2> runs{};
  std::array<bool, 2> before{};
  for (std::uint64_t k = 0; k < kCount; ++k) {
    const double draw = steps.uniform(k);
    if (state == 1) {
      state = draw < law.p14 ? 4 : draw < law.p14 + law.p13 ? 3 : 1;
    } else if (state == 3) {
      state = draw < law.p32 ? 2 : draw < law.p32 + law.p31 ? 1 : 3;
    } else {
      state = state == 4 ? 1 : draw < law.p23 ? 3 : 2;
    }
    const std::array<bool, 2> lost{process.next(), state >= 3};
    for (std::size_t i = 0; i < 2; ++i) {
      losses[i] += lost[i] ? 1 : 0;
      runs[i] += lost[i] && !before[i] ? 1 : 0;
      before[i] = lost[i];
    }
  }
  // A run and the quiet behind it renew the process: counts of runs spread like a Poisson's.
  EXPECT_NEAR(runs[0], runs[1], 4 * std::sqrt(2.0 * runs[1]));
  const double mean = static_cast<double>(losses[1]) / runs[1];
  EXPECT_NEAR(static_cast<double>(losses[0]) / runs[0], mean, 4 * mean * std::sqrt(2.0 / runs[1]));
}

TEST(GemodelProcessTest, SpendsItsTimeAsTheStepsSay) {
  const GemodelLaw law{.to_bad = 0.01, .to_good = 0.2, .loss_bad = 0.8, .loss_good = 0.1};
  GemodelProcess process{law, RandomStream{7, 3}};
  constexpr int kCount = 400'000;
  int bad = 0;
  int stays = 0;
  bool before = false;
  EXPECT_EQ(process.next(), 0.1);  // the first is good
  for (int k = 0; k < kCount; ++k) {
    const bool is_bad = process.next() > 0.5;
    bad += is_bad ? 1 : 0;
    stays += is_bad && !before ? 1 : 0;
    before = is_bad;
  }
  const double stay = 1 / law.to_good;
  EXPECT_NEAR(static_cast<double>(bad) / stays, stay, 4 * stay / std::sqrt(stays));
  const double expected = kCount / (stay + 1 / law.to_bad);
  EXPECT_NEAR(stays, expected, 4 * std::sqrt(expected));
}

/// Goal: a law that is set in mid-run is felt at once, not when what the old one planned is over.
/// Method: from once in a million seconds to ten times a second; within a second it must act.
TEST(LossLawsTest, WhatComesInTimeFeelsANewRateAtOnce) {
  const RandomStream one{7, 3};
  const RandomStream other{7, 4};
  BurstProcess burst{one};
  GilbertTimeProcess gilbert{one, other};
  StallProcess stall{one, other};
  const auto set = [&](double rate, TimePoint at) {
    burst.change({.rate = rate, .length = std::chrono::milliseconds{1}}, at);
    gilbert.change({.good = from_seconds(1 / rate), .bad = std::chrono::milliseconds{1}}, at);
    stall.change({.rate = rate, .median = std::chrono::milliseconds{1}}, at);
  };
  set(1e-6, TimePoint{});
  std::array<int, 3> hits{};
  const auto ask = [&](TimePoint at) {
    hits[0] += burst.next(at) ? 1 : 0;
    hits[1] += gilbert.next(at) > 0 ? 1 : 0;
    hits[2] += stall.next(at) > at ? 1 : 0;
  };
  TimePoint at{};
  for (; at < TimePoint{std::chrono::seconds{1}}; at += std::chrono::microseconds{100}) ask(at);
  EXPECT_THAT(hits, ::testing::Each(0));
  set(10, at);
  for (; at < TimePoint{std::chrono::seconds{3}}; at += std::chrono::microseconds{100}) ask(at);
  EXPECT_THAT(hits, ::testing::Each(::testing::Gt(0)));
}

}  // namespace
}  // namespace palp::netem
