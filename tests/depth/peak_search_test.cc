// Goal: a peak is found wherever it lies in its range, its ends included, without asking beyond.
// Method: parabolas with known tops.
#include "depth/peak_search.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace palp::depth {
namespace {

constexpr PeakRange kRange{1, 3};

/// Log-likelihood of a normal peak of standard deviation 0.1; nothing may ask outside the range.
auto peak_at(double top) {
  return [top](double at) {
    EXPECT_GE(at, kRange.low - 1e-12);
    EXPECT_LE(at, kRange.high + 1e-12);
    return -0.5 * (at - top) * (at - top) / 0.01;
  };
}

TEST(PeakSearchTest, FindsAPeakNearTheGuess) {
  for (double top = 1.05; top < 2.95; top += 0.05) {
    for (const double off : {-0.1, 0.02, 0.1}) {
      const PeakGuess guess{.at = std::clamp(top + off, 1.0, 3.0), .width = 0.2, .doublings = 1};
      const auto peak = search(kRange, guess, peak_at(top));
      ASSERT_TRUE(peak) << top;
      EXPECT_NEAR(peak->at, top, 0.03) << off;  // 0.05 of the log-likelihood
    }
  }
}

TEST(PeakSearchTest, APeakOutsideTheRangeIsItsEnd) {
  const PeakGuess low{.at = 1.02, .width = 0.2, .doublings = 1};
  const auto first = search(kRange, low, peak_at(0.7));
  ASSERT_TRUE(first);
  EXPECT_EQ(first->at, 1);
  const PeakGuess high{.at = 3, .width = 0.2, .doublings = 0};
  const auto last = search(kRange, high, peak_at(3.4));
  ASSERT_TRUE(last);
  EXPECT_EQ(last->at, 3);
}

TEST(PeakSearchTest, APeakJustInsideAnEndIsFoundFromTheEnd) {
  for (const double off : {0.06, 0.08, 0.1, 0.14}) {
    const auto first = search(kRange, {1, 0.2, 1}, peak_at(1 + off));
    ASSERT_TRUE(first);
    EXPECT_NEAR(first->at, 1 + off, 0.02);
    const auto last = search(kRange, {3, 0.2, 1}, peak_at(3 - off));
    ASSERT_TRUE(last);
    EXPECT_NEAR(last->at, 3 - off, 0.02);
  }
}

TEST(PeakSearchTest, GivesUpWhereThePeakIsFar) {
  EXPECT_FALSE(search(kRange, {1.2, 0.1, 0}, peak_at(2.1)));
  const auto found = search(kRange, {1.2, 0.1, 3}, peak_at(2.1));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->at, 2.1, 0.02);
}

}  // namespace
}  // namespace palp::depth
