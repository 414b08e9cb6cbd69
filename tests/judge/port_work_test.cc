#include "judge/port_work.h"

#include <cmath>
#include <initializer_list>

#include <gtest/gtest.h>

namespace palp::judge {
namespace {

constexpr double kStiffness = 200;  ///< [N/m]
constexpr double kDepth = 4e-3;     ///< [m]

/// In and out of a spring that pushes back more weakly on the way out.
template <class Add>
double stroke(int samples, const Add& add) {
  PortWork port;
  for (int i = 0; i <= 2 * samples; ++i) {
    const double position = kDepth * (1 - std::abs(i - samples) / static_cast<double>(samples));
    add(port, position, kStiffness * position * (i > samples ? 0.5 : 1));
  }
  return port.work();
}

TEST(PortWorkTest, WhatASpringTakesItGivesBack) {
  PortWork port;
  for (const double position : {0.0, 1e-3, 4e-3, 2e-3, 3e-3, 0.0}) {
    port.add_reading(position, kStiffness * position);
  }
  EXPECT_NEAR(port.work(), 0, 1e-15);
}

TEST(PortWorkTest, AStrokeThatComesBackWeakerLeavesTheLoopsArea) {
  const double area = 0.5 * 0.5 * kStiffness * kDepth * kDepth;
  const auto reading = [](PortWork& port, double x, double f) { port.add_reading(x, f); };
  const auto applied = [](PortWork& port, double x, double f) { port.add_applied(x, f); };
  EXPECT_NEAR(stroke(1000, reading), area, 2e-3 * area);
  EXPECT_NEAR(stroke(10, reading), area, 0.1 * area) << "few samples take away none";
  EXPECT_NEAR(stroke(1000, applied), area, 5e-3 * area);
}

TEST(PortWorkTest, AnAppliedForceWorksOnTheWayBehindIt) {
  PortWork port;
  port.add_applied(0, 7);
  port.add_applied(3e-3, 2);
  port.add_applied(9e-3, 0);
  EXPECT_DOUBLE_EQ(port.work(), 6e-3);
}

}  // namespace
}  // namespace palp::judge
