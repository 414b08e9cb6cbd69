#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/core/place.h"
#include "common/coupling/contact_model.h"
#include "tests/common/coupling/sensed_tip.h"

namespace palp::coupling {
namespace {

/// A tip that goes where it is told, in a tissue with a kink that lets go on the way out: none of
/// the estimator's shapes has either, and its transducer has neither noise nor steps.
class TipInKinkedTissue {
 public:
  void go(double to, double speed) {
    const double step = std::copysign(1e-3 * speed, to - position_);
    while (std::abs(to - position_) > std::abs(step)) meet(position_ + step);
    meet(to);
  }
  void stay(int ticks) {
    for (int tick = 0; tick < ticks; ++tick) meet(position_);
  }
  void new_place(const Place& place, double stiffer) {
    tip_.new_place(place);
    stiffer_ = stiffer;
  }
  /// Told, over true: of the way from 1.2 to 3.2 mm.
  [[nodiscard]] double stiffness() const {
    const ContactModel told = contact_model(tip_.told());
    return (told.force(3.2e-3 - told.surface) - told.force(1.2e-3 - told.surface)) /
           (elastic(3.2e-3) - elastic(1.2e-3));
  }

 private:
  [[nodiscard]] double elastic(double depth) const {
    return stiffer_ * (200 * std::max(0.0, depth) + 400 * std::max(0.0, depth - 2.9e-3));
  }
  void meet(double position) {
    const bool out = position < position_;
    position_ = position;
    tip_.meets(position, (out ? 0.85 : 1) * elastic(position));
  }

  SensedTip tip_;
  double position_{-3e-3};
  double stiffer_{1};
};

TEST(ContactEstimatorTest, WithoutNoiseNoFewReadingsSayWhatATissueIsLikeBelowThem) {
  TipInKinkedTissue tip;
  tip.stay(1000);
  for (int tap = 0; tap < 3; ++tap) {
    tip.go(3.5e-3, 15e-3);
    tip.go(-3e-3, 15e-3);
  }
  tip.new_place(kSiteB, 1.3);
  tip.go(1e-3, 15e-3);
  tip.go(-3e-3, 15e-3);
  tip.go(1e-3, 10e-3);
  tip.stay(3000);
  EXPECT_NEAR(tip.stiffness(), 1, 0.3);
}

}  // namespace
}  // namespace palp::coupling
