#include "common/core/random.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <set>

#include <gtest/gtest.h>

// All draws are functions of fixed numbers, so each check gives the same answer on every run. A
// statistic of a true random sequence stays within four of its standard errors with 99.994 %.
namespace palp {
namespace {

constexpr double kStandardErrors = 4;
constexpr std::uint64_t kCount = 40'000;
constexpr std::uint64_t kSeed = 2022;

TEST(RandomTest, SameThreeNumbersGiveTheSameDraw) {
  for (std::uint64_t i = 0; i < 100; ++i) {
    EXPECT_EQ(random_bits(kSeed, 3, i), random_bits(kSeed, 3, i));
    EXPECT_EQ(random_normal(kSeed, 3, i), random_normal(kSeed, 3, i));
  }
}

TEST(RandomTest, SeedStreamAndIndexAreNotInterchangeable) {
  std::set<std::uint64_t> draws;
  for (std::uint64_t seed = 0; seed < 16; ++seed) {
    for (std::uint64_t stream = 0; stream < 16; ++stream) {
      for (std::uint64_t index = 0; index < 16; ++index) {
        draws.insert(random_bits(seed, stream, index));
      }
    }
  }
  EXPECT_EQ(draws.size(), 16U * 16U * 16U);
}

TEST(RandomTest, AStreamIsTheGeneratorWithTheFirstTwoNumbersSet) {
  const RandomStream stream{kSeed, 7};
  for (std::uint64_t index = 0; index < 100; ++index) {
    EXPECT_EQ(stream.bits(index), random_bits(kSeed, 7, index));
    EXPECT_EQ(stream.uniform(index), random_uniform(kSeed, 7, index));
    EXPECT_EQ(stream.normal(index), random_normal(kSeed, 7, index));
  }
}

TEST(RandomTest, TheMiddleOfACellIsNeverTheEndOfTheInterval) {
  EXPECT_GT(random_middle(0), 0);
  EXPECT_LT(random_middle(~std::uint64_t{0}), 1);
  EXPECT_TRUE(std::isfinite(normal_quantile(random_middle(~std::uint64_t{0}))));
}

using Argument = std::function<std::uint64_t(std::uint64_t base, std::uint64_t changed)>;

/// Flips each bit of one argument; each of the 64 bits of the draw must flip with probability 1/2.
void expect_avalanche(const Argument& draw) {
  std::array<int, 64> flips{};
  constexpr std::uint64_t kTrials = 100;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    for (int bit = 0; bit < 64; ++bit) {
      const std::uint64_t difference = draw(trial, trial) ^ draw(trial, trial ^ (1ULL << bit));
      for (std::size_t out = 0; out < 64; ++out) {
        flips[out] += static_cast<int>((difference >> out) & 1);
      }
    }
  }
  const double trials = 64.0 * static_cast<double>(kTrials);
  const double standard_error = std::sqrt(trials) / 2;
  for (const int count : flips) {
    EXPECT_NEAR(count, trials / 2, kStandardErrors * standard_error);
  }
}

TEST(RandomTest, OneBitOfTheSeedChangesHalfTheBits) {
  expect_avalanche([](auto base, auto changed) { return random_bits(changed, base, 7); });
}

TEST(RandomTest, OneBitOfTheStreamChangesHalfTheBits) {
  expect_avalanche([](auto base, auto changed) { return random_bits(base, changed, 7); });
}

TEST(RandomTest, OneBitOfTheIndexChangesHalfTheBits) {
  expect_avalanche([](auto base, auto changed) { return random_bits(base, 7, changed); });
}

TEST(RandomTest, EachBitIsSetHalfTheTime) {
  std::array<int, 64> ones{};
  for (std::uint64_t i = 0; i < kCount; ++i) {
    const std::uint64_t bits = random_bits(kSeed, 1, i);
    for (std::size_t bit = 0; bit < 64; ++bit) ones[bit] += static_cast<int>((bits >> bit) & 1);
  }
  const double count = static_cast<double>(kCount);
  for (const int set : ones) {
    EXPECT_NEAR(set, count / 2, kStandardErrors * std::sqrt(count) / 2);
  }
}

TEST(RandomTest, UniformHasTheMomentsOfTheUniformDistribution) {
  const double count = static_cast<double>(kCount);
  double sum = 0;
  double squares = 0;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    const double u = random_uniform(kSeed, 2, i);
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    sum += u;
    squares += (u - 0.5) * (u - 0.5);
  }
  EXPECT_NEAR(sum / count, 0.5, kStandardErrors * std::sqrt(1.0 / 12 / count));
  // Var((u - 1/2)^2) = 1/80 - 1/144 = 1/180.
  EXPECT_NEAR(squares / count, 1.0 / 12, kStandardErrors * std::sqrt(1.0 / 180 / count));
}

TEST(RandomTest, NormalHasTheMomentsOfTheNormalDistribution) {
  const double count = static_cast<double>(kCount);
  std::array<double, 5> moments{};
  for (std::uint64_t i = 0; i < kCount; ++i) {
    const double z = random_normal(kSeed, 3, i);
    ASSERT_LT(std::abs(z), 8.3);
    for (int k = 1; k <= 4; ++k) moments[static_cast<std::size_t>(k)] += std::pow(z, k) / count;
  }
  // Var(z^k) = E z^2k - (E z^k)^2, with E z^2, z^4, z^6, z^8 = 1, 3, 15, 105.
  EXPECT_NEAR(moments[1], 0, kStandardErrors * std::sqrt(1 / count));
  EXPECT_NEAR(moments[2], 1, kStandardErrors * std::sqrt(2 / count));
  EXPECT_NEAR(moments[3], 0, kStandardErrors * std::sqrt(15 / count));
  EXPECT_NEAR(moments[4], 3, kStandardErrors * std::sqrt(96 / count));
}

double correlation(const std::function<double(std::uint64_t)>& a,
                   const std::function<double(std::uint64_t)>& b) {
  double sum = 0;
  for (std::uint64_t i = 0; i < kCount; ++i) sum += (a(i) - 0.5) * (b(i) - 0.5);
  return sum / static_cast<double>(kCount) * 12;
}

TEST(RandomTest, StreamsSeedsAndNeighboursAreUncorrelated) {
  const double limit = kStandardErrors / std::sqrt(static_cast<double>(kCount));
  const auto base = [](std::uint64_t i) { return random_uniform(kSeed, 1, i); };
  for (std::uint64_t stream = 2; stream < 8; ++stream) {
    const auto other = [=](std::uint64_t i) { return random_uniform(kSeed, stream, i); };
    EXPECT_NEAR(correlation(base, other), 0, limit) << "stream " << stream;
  }
  for (std::uint64_t seed = kSeed + 1; seed < kSeed + 7; ++seed) {
    const auto other = [=](std::uint64_t i) { return random_uniform(seed, 1, i); };
    EXPECT_NEAR(correlation(base, other), 0, limit) << "seed " << seed;
  }
  for (std::uint64_t lag = 1; lag < 7; ++lag) {
    const auto later = [=](std::uint64_t i) { return random_uniform(kSeed, 1, i + lag); };
    EXPECT_NEAR(correlation(base, later), 0, limit) << "lag " << lag;
  }
}

TEST(NormalQuantileTest, IsTheInverseOfTheCumulativeDistribution) {
  for (double p = 1e-300; p < 0.5; p *= 1.7) {
    const double z = normal_quantile(p);
    // An error dz of the quantile is a relative error of about |z| dz of p, and dz ~ 1e-16 |z|.
    EXPECT_NEAR(normal_cdf(z) / p, 1, 1e-15 * (20 + z * z)) << "p = " << p;
  }
  for (double p = 0.5; p < 1; p += 0.001) {
    EXPECT_NEAR(normal_cdf(normal_quantile(p)), p, 1e-15) << "p = " << p;
  }
}

TEST(NormalQuantileTest, IsOddAboutOneHalf) {
  EXPECT_EQ(normal_quantile(0.5), 0);
  for (double p = 0x1.0p-40; p < 0.5; p *= 2) {  // 1 - p is exact
    EXPECT_EQ(normal_quantile(1 - p), -normal_quantile(p)) << "p = " << p;
  }
}

TEST(NormalQuantileTest, RisesAcrossTheJointsOfItsThreeRanges) {
  double last = normal_quantile(1e-14);
  for (double p = 1.1e-14; p < 0.5; p *= 1.01) {
    const double z = normal_quantile(p);
    EXPECT_GT(z, last) << "p = " << p;
    last = z;
  }
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-14);  // any statistical table
}

}  // namespace
}  // namespace palp
