#include "netem/model/normal_draw.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace palp::netem {
namespace {

TEST(NormalDrawTest, IsTheQuantileOfItsBits) {
  const NormalDraw normal;
  double worst = 0;
  for (std::uint64_t i = 0; i < 200'000; ++i) {
    const std::uint64_t bits = random_bits(1, 2, i);
    const double exact = normal_quantile((static_cast<double>(bits >> 11U) + 0.5) * 0x1.0p-53);
    worst = std::max(worst, std::abs(normal.at(bits) - exact));
  }
  EXPECT_LT(worst, 3e-5);
  EXPECT_LT(normal.at(0), -8);
  EXPECT_GT(normal.at(~std::uint64_t{0}), 8);
}

}  // namespace
}  // namespace palp::netem
