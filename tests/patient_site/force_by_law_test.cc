#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "patient_site/motion_gate.h"

namespace palp::patient {
namespace {

constexpr Duration kTick = std::chrono::milliseconds{1};

/// A tissue [N/m], and a stage with a servo of 20 Hz as the simulated one has, behind a bus that
/// takes its time to it and back.
struct Site {
  double stiffness{};
  int late{};              ///< [ms], of the bus, each way
  int every{1};            ///< [ms], it asks the stage
  double force_highest{};  ///< [N]
  double force_least{};    ///< [N], of the last second
  double force_most{};     ///< [N], likewise

  /// The law asks for 8 mm, and for no more than `most` [N].
  void press(double most) {
    StageFacts stage;
    stage.rate = 1e3 / every;
    stage.lag += 1e-3 * (late + 0.5 * every);
    MotionGate gate{{}, {.stage = stage, .sensor = {.pole = 1e5, .lag = 1e-3 * late}}};
    gate.begin(-2e-3, {});
    std::deque<double> asked(static_cast<std::size_t>(late), -2e-3);
    std::deque<double> read(static_cast<std::size_t>(late), 0);
    const double omega = 2 * std::numbers::pi * 20;  // [rad/s]
    double tip = -2e-3;
    double told = tip;
    double target = tip;
    double speed = 0;
    for (int tick = 0; tick < 3000; ++tick) {
      const double force = stiffness * std::max(0.0, tip);
      force_highest = std::max(force_highest, force);
      if (tick == 2000) force_least = force_most = force;
      force_least = std::min(force_least, force);
      force_most = std::max(force_most, force);
      read.push_back(force);
      if (tick % every == 0) told = tip;
      gate.feel(told, read.front());
      const MotionRequest request{.state = SiteState::Engaged,
                                  .position = 8e-3,
                                  .tip = told,
                                  .contact_force = read.front(),
                                  .force_most = most};
      asked.push_back(gate.pass(request, kTick).position);
      if (tick % every == 0) target = asked.front();
      asked.pop_front();
      read.pop_front();
      for (int step = 0; step < 10; ++step) {
        const double pull = omega * omega * (target - tip) - 2 * 0.9 * omega * speed;
        speed += 1e-4 * std::clamp(pull, -8.0, 8.0);
        tip += 1e-4 * speed;
      }
    }
  }
};

TEST(ForceByLawTest, ALawsOwnLimitHoldsInTissueOfAnyStiffness) {
  for (const double stiffness : {300.0, 600.0, 1000.0, 1500.0, 2000.0}) {
    for (const double most : {0.5, 1.0, 2.0}) {
      Site site{.stiffness = stiffness};
      site.press(most);
      // What one reading cannot foresee: the way of the lag at the 50 mm/s of a first contact.
      EXPECT_LE(site.force_highest, most + 0.25) << stiffness << " N/m, " << most << " N";
      EXPECT_NEAR(site.force_least, most - std::min(0.15, most / 2), 0.05) << stiffness;
      EXPECT_LE(site.force_most - site.force_least, 0.05) << "it does not hunt";
    }
  }
}

/// A tip that comes again as soon as its force has fallen hammers at the limit: by the time that a
/// late stage shows what it was sent to, it was sent too far.
TEST(ForceByLawTest, AtALateStageTheTipDoesNotComeAgainAndAgain) {
  for (const int late : {5, 15, 30}) {
    for (const double stiffness : {100.0, 300.0, 600.0, 1000.0}) {
      Site site{.stiffness = stiffness, .late = late, .every = 10};
      site.press(0.6);
      EXPECT_LE(site.force_most - site.force_least, 0.05) << stiffness << " N/m, " << late << " ms";
      EXPECT_GE(site.force_least, 0.35) << stiffness << " N/m, " << late << " ms";
    }
  }
}

TEST(ForceByLawTest, NoLawRaisesTheGatesOwn) {
  for (const double most :
       {10.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    Site site{.stiffness = 1500};
    site.press(most);
    EXPECT_LE(site.force_highest, 3);
    EXPECT_GE(site.force_least, 2.7);
  }
}

}  // namespace
}  // namespace palp::patient
