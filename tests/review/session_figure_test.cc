#include "review/session_figure.h"

#include <gtest/gtest.h>

namespace palp::review {
namespace {

judge::RunTick tick_of(int ms) {
  judge::RunTick tick;
  tick.at = 1e-3 * ms;
  tick.hand = 2e-3;
  tick.tip = ms < 10 ? judge::kUndefined : 1e-3;
  tick.hand_force = 0.5;
  tick.contact_force = 0.4;
  tick.force_true = 0.3;
  return tick;
}

TEST(SessionFigureTest, ShowsWhereHandAndTipWereAndWhatWasFeltAndTouched) {
  SessionFigure seen{{}};
  for (int ms = 0; ms < 100; ++ms) seen.see(tick_of(ms));
  const plot::Figure figure = seen.figure();
  ASSERT_EQ(figure.panels.size(), 2U);
  const auto& places = figure.panels[0].curves;
  const auto& forces = figure.panels[1].curves;
  ASSERT_TRUE(places.size() == 3 && forces.size() == 3);
  EXPECT_EQ(places[1].x.size(), 100U);
  EXPECT_NEAR(places[1].y[50], 2, 1e-12) << "[mm]";
  EXPECT_NEAR(places[2].y[50], 1, 1e-12);
  EXPECT_FALSE(places[2].y[5] == places[2].y[5]) << "nothing was heard of the tip yet";
  EXPECT_NEAR(forces[1].y[50], 0.5, 1e-12) << "[N]";
  EXPECT_NEAR(forces[2].y[50], 0.4, 1e-12);
  EXPECT_NEAR(forces[0].y[50], 0.3, 1e-12);
}

TEST(SessionFigureTest, ShowsItsSpanAloneTickByTickHoweverLongTheSession) {
  SessionFigure seen{{.from = 50, .to = 51}};
  for (int ms = 0; ms < 100'000; ++ms) seen.see(tick_of(ms));
  const plot::Figure figure = seen.figure();
  ASSERT_EQ(figure.panels.size(), 2U);
  const auto& time = figure.panels[0].curves[1].x;
  ASSERT_EQ(time.size(), 1000U);
  EXPECT_EQ(time.front(), 50);
  EXPECT_LT(time.back(), 51);
}

TEST(SessionFigureTest, ALawThatNobodyKnowsIsNotInTheLegend) {
  SessionFigure known{{}};
  SessionFigure unknown{{}};
  for (int ms = 0; ms < 20; ++ms) {
    judge::RunTick tick = tick_of(ms);
    known.see(tick);
    tick.force_true = judge::kUndefined;
    unknown.see(tick);
  }
  EXPECT_FALSE(known.figure().panels[1].curves[0].name.empty());
  EXPECT_TRUE(unknown.figure().panels[1].curves[0].name.empty());
}

TEST(SessionFigureTest, OfNothingThereIsNoPanel) {
  SessionFigure seen{{.from = 5}};
  seen.see(tick_of(0));
  EXPECT_TRUE(seen.figure().panels.empty());
}

}  // namespace
}  // namespace palp::review
