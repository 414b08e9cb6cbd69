#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include <gtest/gtest.h>

#include "common/core/filters.h"
#include "common/coupling/mmt.h"

/// Goal: the tip presses little harder than the hand has felt so far, and follows the hand as it
/// feels.
/// Method: the patient's half with a stage that goes where it is sent within 10 ms, on Hertz's law
/// ten times as stiff as expected, at a surface that may rise.
namespace palp::coupling {
namespace {

double stiff(double depth) { return depth > 0 ? 18'970 * depth * std::sqrt(depth) : 0; }

class Tip {
 public:
  Tip() : law_{MmtConfig{}} { law_.begin_epoch(tip_); }

  /// The hand goes to `position` [m] at 20 mm/s and stays, and is given `share` [-] of the force
  /// that the tissue has there.
  void follow(double position, double share, int ticks, double risen = 0) {
    for (int i = 0; i < ticks; ++i) {
      const double before = hand_;
      hand_ += std::clamp(position - hand_, -20e-6, 20e-6);
      Incoming heard;
      heard.fresh = true;
      heard.number = ++number_;
      heard.sample = {hand_, (hand_ - before) / 1e-3, share * stiff(hand_), std::monostate{}};
      const std::array arrived{heard};
      PatientInput in;
      in.now = TimePoint{std::chrono::milliseconds{number_}};
      in.state = SiteState::Engaged;
      in.position = tip_;
      in.contact_force = pole_.step(stiff(tip_ + risen));
      in.arrived = arrived;
      in.round_trip = std::chrono::milliseconds{200};
      const double target = law_.step(in, std::chrono::milliseconds{1}).target_position;
      tip_ += 0.1 * (target - tip_);
      force_most_ = std::max(force_most_, stiff(tip_ + risen));
    }
  }
  [[nodiscard]] double tip() const { return tip_; }
  [[nodiscard]] double force_most() const { return force_most_; }

 private:
  MmtPatient law_;
  LowPass pole_{20, 1e-3};
  double hand_{-3e-3};
  double tip_{-3e-3};
  double force_most_{};
  std::uint64_t number_{};
};

TEST(MmtPatientTest, TheTipWaitsWhereTheHandHasNotFeltTheTissueYet) {
  Tip tip;
  tip.follow(-3e-3, 0, 1000);
  tip.follow(4e-3, 0, 1000);
  ASSERT_GT(stiff(4e-3), 4.5);
  EXPECT_LT(tip.force_most(), 2) << "with the lag of the sensor, and before it knows the tissue";
  EXPECT_NEAR(stiff(tip.tip()), MmtConfig{}.unfelt, 0.1);
}

TEST(MmtPatientTest, TheTipIsWhereTheHandIsOnceItFeels) {
  Tip tip;
  tip.follow(-3e-3, 0, 1000);
  tip.follow(1e-3, 0, 500);
  tip.follow(1e-3, 1, 500);
  EXPECT_NEAR(tip.tip(), 1e-3, 20e-6);
  tip.follow(2e-3, 1, 500);
  EXPECT_NEAR(tip.tip(), 2e-3, 20e-6);
}

TEST(MmtPatientTest, TheTipGivesWayToASurfaceThatRisesAgainstItAndDoesNotSwing) {
  Tip tip;
  tip.follow(-3e-3, 0, 1000);
  tip.follow(1e-3, 1, 1000);
  const double felt = stiff(1e-3);
  for (int step = 1; step <= 20; ++step) tip.follow(1e-3, 1, 50, 0.1e-3 * step);
  ASSERT_GT(stiff(3e-3), 3);
  tip.follow(1e-3, 1, 2000, 2e-3);
  EXPECT_LT(stiff(tip.tip() + 2e-3), 1.05 * (0.8 + 1.3 * felt));
  const double rest = tip.tip();
  tip.follow(1e-3, 1, 30, 2e-3);
  EXPECT_NEAR(tip.tip(), rest, 20e-6);
  tip.follow(1e-3, 1, 2000);
  EXPECT_NEAR(tip.tip(), 1e-3, 20e-6) << "when the surface is back, so is the tip";
}

}  // namespace
}  // namespace palp::coupling
