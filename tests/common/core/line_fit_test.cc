#include "common/core/line_fit.h"

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp {
namespace {

RC_GTEST_PROP(LineFitTest, FindsTheSlopeOfAnyLineFarFromTheOrigin, ()) {
  const double slope = *rc::gen::inRange(-1000, 1000) * 0.01;
  const double offset = *rc::gen::inRange(-1000, 1000) * 10.0;
  const double first = *rc::gen::inRange(-1000, 1000) * 1.0;
  LineFit fit;
  for (int i = 0; i < 20; ++i) fit.add(first + i * 1e-3, offset + slope * i * 1e-3);
  RC_ASSERT(fit.count() == 20);
  RC_ASSERT(std::abs(fit.slope() - slope) < 1e-6);
}

TEST(LineFitTest, WeighsEveryPointAlike) {
  LineFit fit;
  for (const double y : {0.0, 1.0, 0.0, 1.0}) fit.add(static_cast<double>(fit.count()), y);
  EXPECT_NEAR(fit.slope(), 0.2, 1e-12);  // sum of dx dy = 1, of dx^2 = 5
}

}  // namespace
}  // namespace palp
