#include "patient_site/force_ceiling.h"

#include <deque>

#include <gtest/gtest.h>

namespace palp::patient {
namespace {

constexpr double kTick = 1e-3;  // [s]

TEST(ForceCeilingTest, BoundsNothingBeforeARetreatAndNothingThatIsLessDeep) {
  ForceCeiling ceiling;
  EXPECT_EQ(ceiling.bound(5e-3, 2, kTick), 5e-3);
  ceiling.hit(2e-3);
  EXPECT_EQ(ceiling.bound(1e-3, 2, kTick), 1e-3);
  EXPECT_LT(ceiling.bound(5e-3, 2, kTick), 2.1e-3);
  ceiling.forget();
  EXPECT_EQ(ceiling.bound(5e-3, 2, kTick), 5e-3);
}

TEST(ForceCeilingTest, GoesNoDeeperWhereTheForceIsThatOfRest) {
  ForceCeiling ceiling{{.limit = 3, .margin = 0.3}};
  ceiling.hit(2e-3);
  for (const double force : {2.7, 2.9, 4.0}) EXPECT_EQ(ceiling.bound(5e-3, force, kTick), 2e-3);
}

TEST(ForceCeilingTest, ALimitBelowItsMarginIsOneToo) {
  for (const double limit : {0.1, 0.2, 0.3}) {
    ForceCeiling ceiling{{.limit = limit}};
    ceiling.hit(2e-3);
    EXPECT_EQ(ceiling.bound(5e-3, limit, kTick), 2e-3) << limit;
    EXPECT_LE(ceiling.bound(5e-3, 0, kTick), 2e-3 + 11e-6) << limit;
  }
}

TEST(ForceCeilingTest, ComesToRestBelowTheLimitOnAnyTissueHoweverLateTheForceIs) {
  const ForceCeilingConfig config;
  for (const double stiffness : {50.0, 300.0, 1500.0, 3000.0}) {
    ForceCeiling ceiling{config};
    std::deque<double> late(40, 0.0);  // 40 ms of stage and sensor
    ceiling.hit(0);
    double highest = 0;
    double position = 0;
    for (int tick = 0; tick < 60'000; ++tick) {
      late.push_back(stiffness * position);
      position = ceiling.bound(1, late.front(), kTick);
      late.pop_front();
      highest = std::max(highest, stiffness * position);
    }
    EXPECT_LE(highest, config.limit) << stiffness;
    EXPECT_NEAR(stiffness * position, config.limit - config.margin, 0.05) << stiffness;
  }
}

}  // namespace
}  // namespace palp::patient
