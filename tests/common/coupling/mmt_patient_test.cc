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

  /// The hand stays, and is given what the tissue has where the drag began, while the tip goes on
  /// at 20 mm/s and the tissue there becomes `harder` [-] within half a second.
  void drag(double harder, int ticks) {
    const double felt = stiff(hand_);
    for (int i = 0; i < ticks; ++i) {
      place_.x += 20e-6;
      growth_ = 1 + (harder - 1) * std::min(1.0, i / 500.0);
      step(0, felt, 0);
    }
  }
  /// Nobody presses.
  void travel(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      place_.x += 20e-6;
      step(0, 0, 0);
    }
  }
  void forget_force() { force_most_ = 0; }

  /// The hand goes to `position` [m] at 20 mm/s and stays, and is given `share` [-] of the force
  /// that the tissue has there.
  void follow(double position, double share, int ticks, double risen = 0) {
    for (int i = 0; i < ticks; ++i) {
      const double way = std::clamp(position - hand_, -20e-6, 20e-6);
      step(way, share * stiff(hand_ + way), risen);
    }
  }
  [[nodiscard]] double tip() const { return tip_; }
  [[nodiscard]] double force_most() const { return force_most_; }
  /// [N], of the law: no harder is the tip to press.
  [[nodiscard]] double force_asked() const { return force_asked_; }

 private:
  /// The hand goes on by `way` [m] and is given `felt` [N].
  void step(double way, double felt, double risen) {
    hand_ += way;
    Incoming heard;
    heard.fresh = true;
    heard.number = ++number_;
    heard.sample = {hand_, way / 1e-3, felt, std::monostate{}};
    const std::array arrived{heard};
    PatientInput in;
    in.now = TimePoint{std::chrono::milliseconds{number_}};
    in.state = SiteState::Engaged;
    in.position = tip_;
    in.contact_force = pole_.step(growth_ * stiff(tip_ + risen));
    in.place = place_;
    in.arrived = arrived;
    in.round_trip = std::chrono::milliseconds{200};
    const PatientOutput out = law_.step(in, std::chrono::milliseconds{1});
    force_asked_ = out.force_most;
    tip_ += 0.1 * (out.target_position - tip_);
    force_most_ = std::max(force_most_, growth_ * stiff(tip_ + risen));
  }

  MmtPatient law_;
  LowPass pole_{20, 1e-3};
  double hand_{-3e-3};
  double tip_{-3e-3};
  Place place_;
  double growth_{1};
  double force_most_{};
  double force_asked_{};
  std::uint64_t number_{};
};

TEST(MmtPatientTest, TheTipPressesLittleHarderThanTheHandHasFelt) {
  Tip tip;
  const MmtConfig config;
  const double none = config.unfelt + config.braked_beyond;  // [N]
  tip.follow(-3e-3, 0, 1000);
  EXPECT_DOUBLE_EQ(tip.force_asked(), none) << "in the air, before anything was felt";
  tip.follow(1e-3, 1, 1000);
  EXPECT_DOUBLE_EQ(tip.force_asked(), none + (1 + config.unfelt_share) * stiff(1e-3));
  tip.follow(-3e-3, 0, 1000);
  EXPECT_DOUBLE_EQ(tip.force_asked(), none);
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

TEST(MmtPatientTest, ADraggedTipGivesWayToWhatIsHarderBeforeTheHandFeelsIt) {
  Tip tip;
  tip.follow(-3e-3, 0, 1000);
  tip.follow(1e-3, 1, 1000);
  const double felt = stiff(1e-3);  // [N]
  tip.forget_force();
  tip.drag(1.6, 600);
  const MmtConfig config;
  ASSERT_LT(1.6 * felt, config.unfelt + (1 + config.unfelt_share) * felt)
      << "a tip that stays would press all of it";
  EXPECT_LT(tip.force_most(), 1.15 * felt);
  EXPECT_LT(tip.tip(), 0.8e-3);
  tip.follow(1e-3, 1.6, 800);
  EXPECT_NEAR(tip.tip(), 1e-3, 20e-6) << "the hand feels it: the drag is over";
}

TEST(MmtPatientTest, ATipThatTravelsInTheAirIsNotDragged) {
  Tip tip;
  tip.follow(-3e-3, 0, 1000);
  tip.follow(1e-3, 1, 1000);
  tip.follow(-3e-3, 1, 1000);
  tip.travel(1000);
  tip.follow(1e-3, 0, 205);  // down in 0.2 s, and nothing was felt yet
  tip.follow(1e-3, 0, 60);
  EXPECT_GT(stiff(tip.tip()), 0.9 * MmtConfig{}.unfelt) << "as far as a first tap goes";
}

TEST(MmtPatientTest, TheTipGivesWayToASurfaceThatRisesAgainstItAndDoesNotSwing) {
  Tip tip;
  tip.follow(-3e-3, 0, 1000);
  tip.follow(1e-3, 1, 1000);
  const double felt = stiff(1e-3);
  for (int step = 1; step <= 20; ++step) tip.follow(1e-3, 1, 50, 0.1e-3 * step);
  EXPECT_LT(tip.force_most(), 2) << "the model takes it for a soft tissue far above";
  ASSERT_GT(stiff(3e-3), 3);
  tip.follow(1e-3, 1, 2000, 2e-3);
  const MmtConfig config;
  EXPECT_LT(stiff(tip.tip() + 2e-3), 1.05 * (config.unfelt + (1 + config.unfelt_share) * felt));
  const double rest = tip.tip();
  tip.follow(1e-3, 1, 30, 2e-3);
  EXPECT_NEAR(tip.tip(), rest, 20e-6);
  tip.follow(1e-3, 1, 2000);
  EXPECT_NEAR(tip.tip(), 1e-3, 20e-6) << "when the surface is back, so is the tip";
}

}  // namespace
}  // namespace palp::coupling
