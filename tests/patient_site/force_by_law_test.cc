#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "patient_site/motion_gate.h"

namespace palp::patient {
namespace {

constexpr Duration kTick = std::chrono::milliseconds{1};

/// A tissue [N/m], and a stage that follows its target after some ticks, both as they are.
struct Site {
  double stiffness{};
  std::size_t lag{15};
  double force_highest{};  ///< [N]
  double force_last{};     ///< [N]
  int turns{};             ///< of the command, from in to out

  /// The law asks for 8 mm, and for no more than `most` [N].
  void press(double most) {
    MotionGate gate{
        {}, {.stage = {.lag = 1e-3 * static_cast<double>(lag)}, .sensor = {.pole = 1e5, .lag = 0}}};
    gate.begin(-2e-3, {});
    std::deque<double> stage(lag, -2e-3);
    double last = -2e-3;
    bool outwards = false;
    for (int tick = 0; tick < 3000; ++tick) {
      const double tip = stage.front();
      force_last = stiffness * std::max(0.0, tip);
      force_highest = std::max(force_highest, force_last);
      gate.feel(tip, force_last);
      const MotionRequest request{.state = SiteState::Engaged,
                                  .position = 8e-3,
                                  .tip = tip,
                                  .contact_force = force_last,
                                  .force_most = most};
      const double command = gate.pass(request, kTick).position;
      turns += command < last && !outwards ? 1 : 0;
      outwards = command < last;
      last = command;
      stage.push_back(command);
      stage.pop_front();
    }
  }
};

TEST(ForceByLawTest, ALawsOwnLimitHoldsInTissueOfAnyStiffness) {
  for (const double stiffness : {150.0, 300.0, 600.0, 1500.0, 2000.0}) {
    for (const double most : {0.5, 1.0, 2.0}) {
      Site site{.stiffness = stiffness};
      site.press(most);
      // What one reading cannot foresee: the way of the lag at the 50 mm/s of a first contact.
      EXPECT_LE(site.force_highest, most + 0.6) << stiffness << " N/m, " << most << " N";
      EXPECT_NEAR(site.force_last, most - std::min(0.15, most / 2), 0.05) << stiffness;
      EXPECT_LE(site.turns, 2) << "it does not hunt";
    }
  }
}

TEST(ForceByLawTest, NoLawRaisesTheGatesOwn) {
  for (const double most :
       {10.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    Site site{.stiffness = 1500};
    site.press(most);
    EXPECT_LE(site.force_highest, 3);
    EXPECT_GE(site.force_last, 2.7);
  }
}

}  // namespace
}  // namespace palp::patient
