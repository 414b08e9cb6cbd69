#include "common/coupling/surface_swing.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp::coupling {
namespace {

constexpr double kPeriod = 1e-3;

/// 20 s of contact with a surface that moves as `displacement`(t), seen every 5 ms.
template <class Displacement>
SurfaceSwing watch(const Displacement& displacement) {
  SurfaceSwing swing{kPeriod};
  for (int tick = 0; tick < 20'000; ++tick) {
    swing.step();
    if (tick % 5 == 0) swing.see(displacement(kPeriod * tick), 1);
  }
  return swing;
}

TEST(SurfaceSwingTest, FindsABreathAtAnyPaceAndForeseesIt) {
  for (const double pace : {0.17, 0.25, 0.33}) {
    const double rate = 6.283185307 * pace;
    const auto breath = [rate](double t) { return 0.3e-3 + 1e-3 * std::sin(rate * t + 0.4); };
    const Swing found = watch(breath).swing();
    EXPECT_NEAR(found.rate / rate, 1, 0.03) << pace;
    for (const double ahead : {0.0, 0.1, 0.25}) {
      const double coming = breath(20 + ahead) - 0.3e-3;
      EXPECT_NEAR(found.after(ahead), coming, 0.12e-3) << pace << " Hz, " << ahead << " s ahead";
    }
  }
}

TEST(SurfaceSwingTest, SaysNothingOfASurfaceThatStandsStillOrOnlyDrifts) {
  EXPECT_EQ(watch([](double) { return 0.3e-3; }).swing().now, 0);
  EXPECT_EQ(watch([](double t) { return 0.05e-3 * std::sin(1.5 * t); }).swing().now, 0);
}

TEST(SurfaceSwingTest, AnotherPlaceBreathesWithTheSameBreath) {
  const auto breath = [](double t) { return 1e-3 * std::sin(1.6 * t); };
  SurfaceSwing swing = watch(breath);
  const Swing before = swing.swing();
  swing.new_mean();
  for (int tick = 0; tick < 4000; ++tick) {
    swing.step();
    if (tick > 2000 && tick % 5 == 0) swing.see(2e-3 + breath(20 + kPeriod * tick), 1);
  }
  EXPECT_NE(before.now, 0);
  EXPECT_NEAR(swing.swing().now, breath(24), 0.15e-3);
}

}  // namespace
}  // namespace palp::coupling
