#include "judge/drag_bump.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp::judge {
namespace {

/// [N], 0.3 N and a bump of `height` [N] about `middle` [s].
double bump(double t, double height, double middle) {
  return 0.3 + height * std::exp(-25 * (t - middle) * (t - middle));
}

/// 2 s of a drag, and what follows; the tip lets go at `lifted` [s].
DragBump dragged(double felt, double late, double touched, double lifted = 9) {
  DragBump drag;
  for (int ms = 0; ms < 6000; ++ms) {
    const double t = 1e-3 * ms;
    const bool dragging = t >= 1 && t < 3;
    drag.look(t, dragging, bump(t, felt, 2 + late), t < lifted ? bump(t, touched, 2) : 0);
  }
  return drag;
}

TEST(DragBumpTest, ComparesTheLargestForces) {
  const DragBump drag = dragged(0.2, 0.25, 0.25);
  EXPECT_NEAR(drag.error(), 0.5 / 0.55 - 1, 0.005);
  EXPECT_NEAR(drag.felt(), 0.5, 0.003);
}

TEST(DragBumpTest, SaysHowLateTheFeltOneIs) {
  EXPECT_NEAR(dragged(0.2, 0.25, 0.2).shift(), 0.25, 0.01);
  EXPECT_NEAR(dragged(0.1, 0.25, 0.2).shift(), 0.25, 0.01) << "a smaller one is no earlier one";
}

TEST(DragBumpTest, ABumpThatIsFeltAfterTheDragCounts) {
  EXPECT_NEAR(dragged(0.2, 1.2, 0.2).error(), 0, 0.005);
  EXPECT_LT(dragged(0.2, 3.2, 0.2).error(), -0.1) << "a path delays no longer than this";
}

TEST(DragBumpTest, IsOverWhereTheTipLetsGo) {
  EXPECT_LT(dragged(0.2, 1.2, 0.2, 2.5).error(), -0.3);
}

TEST(DragBumpTest, WithoutABumpThereIsNoAnswer) {
  EXPECT_TRUE(std::isnan(DragBump{}.error()));
  EXPECT_TRUE(std::isnan(DragBump{}.shift()));
  EXPECT_TRUE(std::isnan(dragged(0.2, 0.2, 0.02).error()));
  EXPECT_TRUE(std::isnan(dragged(0.2, 0.2, 0.02).felt()));
}

}  // namespace
}  // namespace palp::judge
