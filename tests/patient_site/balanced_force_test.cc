#include "patient_site/balanced_force.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp::patient {
namespace {

struct Found {
  double force{};  ///< [N]
  int answers{};
};

template <typename Tissue>
Found find(double pressed, double yield, double guess, const Tissue& tissue) {
  Found found;
  found.force = balanced_force(
      [&](double force) {
        ++found.answers;
        return tissue(std::max(0.0, pressed - yield * force));
      },
      guess);
  return found;
}

/// F/c + F/k = x, however much stiffer the tissue is than what yields.
TEST(BalancedForceTest, SpringsInARowShareTheWay) {
  constexpr double kPressed = 3e-3;
  constexpr double kYield = 1e-4;
  for (const double product : {1e-3, 0.1, 1.0, 10.0, 100.0, 1e4}) {
    const double stiffness = product / kYield;
    for (const double guess : {0.0, 1e-3, 1.0, 100.0}) {
      const Found found =
          find(kPressed, kYield, guess, [&](double depth) { return stiffness * depth; });
      EXPECT_NEAR(found.force, kPressed / (1 / stiffness + kYield), 1e-9) << product;
      EXPECT_LE(found.answers, 7) << product << ", " << guess;
    }
  }
}

TEST(BalancedForceTest, AKinkOrASteepRiseTakesAFewAnswersMore) {
  constexpr double kYield = 1e-3;
  const auto kinked = [](double d) { return d < 1e-3 ? 100 * d : 0.1 + 1e5 * (d - 1e-3); };
  const auto steep = [](double d) { return 0.05 * std::expm1(d / 0.4e-3); };
  for (double pressed = 0; pressed < 6e-3; pressed += 0.17e-3) {
    const Found one = find(pressed, kYield, 0.05, kinked);
    EXPECT_NEAR(one.force, kinked(std::max(0.0, pressed - kYield * one.force)), 1e-9);
    const Found other = find(pressed, kYield, 0, steep);
    EXPECT_NEAR(other.force, steep(std::max(0.0, pressed - kYield * other.force)), 1e-9);
    EXPECT_LE(std::max(one.answers, other.answers), 40) << pressed;
  }
}

/// Flat on both sides of a cliff, where a slope alone leads across and back for ever.
TEST(BalancedForceTest, AForceThatRisesAtOnceAndThenNoMoreIsFound) {
  const auto cliff = [](double d) { return 1 + std::tanh((d - 2e-3) / 0.02e-3); };
  for (double pressed = 2.1e-3; pressed < 3.9e-3; pressed += 0.09e-3) {
    for (const double guess : {0.0, 1.0, 2.0}) {
      const Found found = find(pressed, 1e-3, guess, cliff);
      EXPECT_NEAR(found.force, cliff(pressed - 1e-3 * found.force), 1e-9) << pressed;
    }
  }
}

TEST(BalancedForceTest, InTheAirOneAnswerIsEnough) {
  const Found found = find(-1e-3, 1e-3, 0, [](double depth) { return 1e3 * depth; });
  EXPECT_EQ(found.force, 0);
  EXPECT_EQ(found.answers, 1);
  EXPECT_EQ(find(-1e-3, 1e-3, 2, [](double depth) { return 1e3 * depth; }).force, 0);
}

/// A tissue that bursts: there may be three balances, and one of them it is.
TEST(BalancedForceTest, AForceThatFallsWithTheDepthEndsToo) {
  const auto bursting = [](double d) {
    return d < 2e-3 ? 1e3 * d : std::max(0.2, 2 - 4e3 * (d - 2e-3));
  };
  for (double pressed = 0; pressed < 6e-3; pressed += 0.07e-3) {
    for (const double guess : {0.0, 0.5, 2.0, 5.0}) {
      const Found found = find(pressed, 1e-3, guess, bursting);
      EXPECT_NEAR(found.force, bursting(std::max(0.0, pressed - 1e-3 * found.force)), 1e-8)
          << pressed << ", " << guess;
    }
  }
}

}  // namespace
}  // namespace palp::patient
