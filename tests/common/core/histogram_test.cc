#include "common/core/histogram.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp {
namespace {

TEST(HistogramTest, IsZeroWhileEmpty) {
  const Histogram histogram;
  EXPECT_EQ(histogram.count(), 0U);
  EXPECT_EQ(histogram.quantile(0.5), Duration{});
  EXPECT_EQ(histogram.mean(), Duration{});
}

TEST(HistogramTest, IsExactWhenAllSpansAreEqual) {
  Histogram histogram;
  for (int i = 0; i < 10; ++i) histogram.record(Duration{50'000'123});
  for (const double share : {0.0, 0.01, 0.5, 0.99, 1.0}) {
    EXPECT_EQ(histogram.quantile(share), Duration{50'000'123});
  }
  EXPECT_EQ(histogram.mean(), Duration{50'000'123});
  EXPECT_EQ(histogram.deviation(), Duration{});
}

TEST(HistogramTest, DeviationIsTheRootMeanSquareOfTheDistancesToTheMean) {
  Histogram histogram;
  EXPECT_EQ(histogram.deviation(), Duration{});
  for (int i = 0; i < 500; ++i) {
    histogram.record(Duration{50'000'000});
    histogram.record(Duration{50'006'000});
  }
  EXPECT_EQ(histogram.mean(), Duration{50'003'000});
  EXPECT_EQ(histogram.deviation(), Duration{3'000});
}

RC_GTEST_PROP(HistogramTest, QuantilesAreWithinACellOfTheSortedSpans, ()) {
  auto spans = *rc::gen::nonEmpty(rc::gen::container<std::vector<std::int64_t>>(
      rc::gen::inRange<std::int64_t>(0, 1'000'000'000'000)));
  const double share = *rc::gen::elementOf(std::vector<double>{0.01, 0.1, 0.5, 0.9, 0.99, 1.0});
  Histogram histogram;
  for (const std::int64_t span : spans) histogram.record(Duration{span});
  std::sort(spans.begin(), spans.end());
  const auto rank = static_cast<std::size_t>(
      std::max(0.0, std::ceil(share * static_cast<double>(spans.size())) - 1));
  const auto exact = static_cast<double>(spans[rank]);
  const auto found = static_cast<double>(histogram.quantile(share).count());
  RC_ASSERT(std::abs(found - exact) <= exact / 128 + 1);
  RC_ASSERT(histogram.quantile(0) >= histogram.min());
  RC_ASSERT(histogram.quantile(1) == histogram.max());
}

TEST(HistogramTest, QuantilesSplitTheCountAsAsked) {
  Histogram histogram;
  for (int i = 0; i < 990; ++i) histogram.record(Duration{10});
  for (int i = 0; i < 10; ++i) histogram.record(Duration{100'000});
  EXPECT_LE(histogram.quantile(0.5), Duration{11});
  EXPECT_LE(histogram.quantile(0.99), Duration{11});
  EXPECT_GE(histogram.quantile(0.991), Duration{99'000});
  EXPECT_EQ(histogram.quantile(1.0), Duration{100'000});
}

TEST(HistogramTest, CountsWhatLiesOutsideAtItsEdges) {
  Histogram histogram;
  histogram.record(Duration{-5});
  EXPECT_EQ(histogram.max(), Duration{});
  histogram.record(std::chrono::hours{100});
  EXPECT_EQ(histogram.count(), 2U);
  EXPECT_EQ(histogram.max(), Duration{(std::int64_t{1} << 40) - 1});
}

}  // namespace
}  // namespace palp
