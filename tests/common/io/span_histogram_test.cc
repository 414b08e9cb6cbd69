#include "common/io/span_histogram.h"

#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp::io {
namespace {

using std::chrono::microseconds;
using std::chrono::nanoseconds;

TEST(SpanHistogramTest, IsZeroWhileEmpty) {
  const SpanHistogram histogram;
  EXPECT_EQ(histogram.quantile(0.5), Duration{0});
  EXPECT_EQ(histogram.total(), 0U);
}

RC_GTEST_PROP(SpanHistogramTest, QuantileIsNeverBelowAndAtMostOneCellAbove, ()) {
  const auto value = *rc::gen::inRange<std::int64_t>(0, std::numeric_limits<std::int64_t>::max());
  SpanHistogram histogram;
  histogram.add(Duration{value});
  const std::int64_t told = histogram.quantile(1.0).count();
  RC_ASSERT(told >= value);
  RC_ASSERT(static_cast<double>(told - value) <= static_cast<double>(value) / 31.0);
}

TEST(SpanHistogramTest, HoldsTheLongestSpanAndTakesNegativeOnesAsZero) {
  SpanHistogram histogram;
  histogram.add(Duration::max());
  EXPECT_EQ(histogram.quantile(1.0), Duration::max());
  histogram.add(Duration{-5});
  EXPECT_EQ(histogram.quantile(0.5), Duration{0});
}

TEST(SpanHistogramTest, QuantilesSplitTheCountAsAsked) {
  SpanHistogram histogram;
  for (int i = 0; i < 990; ++i) {
    histogram.add(nanoseconds{10});
  }
  for (int i = 0; i < 10; ++i) {
    histogram.add(microseconds{100});
  }
  EXPECT_EQ(histogram.quantile(0.5), nanoseconds{10});
  EXPECT_EQ(histogram.quantile(0.99), nanoseconds{10});
  EXPECT_GE(histogram.quantile(0.991), microseconds{100});
  EXPECT_LE(histogram.quantile(1.0), microseconds{104});
}

}  // namespace
}  // namespace palp::io
