#include "common/core/denormals.h"

#include <limits>

#include <gtest/gtest.h>

namespace palp {
namespace {

/// Computed at run time: the compiler must not fold it.
double quarter_of_smallest_normal() {
  volatile double smallest = std::numeric_limits<double>::min();
  volatile double quarter = smallest * 0.25;
  return quarter;
}

TEST(DenormalFlushTest, TinyResultsAreZeroWhileItLivesAndOnlyThen) {
  EXPECT_NE(quarter_of_smallest_normal(), 0.0);
  {
    const DenormalFlush flush;
    EXPECT_EQ(quarter_of_smallest_normal(), 0.0);
  }
  EXPECT_NE(quarter_of_smallest_normal(), 0.0);
}

}  // namespace
}  // namespace palp
