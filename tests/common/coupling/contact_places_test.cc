#include <algorithm>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "common/core/place.h"
#include "common/coupling/contact_estimator.h"
#include "common/coupling/contact_model.h"

namespace palp::coupling {
namespace {

double hertz(double depth) { return depth > 0 ? 1897 * depth * std::sqrt(depth) : 0; }

/// A tip that taps on tissues as stiff as it is told.
class Palpation {
 public:
  void tap(double stiffer) {
    for (int tick = 0; tick < 3000; ++tick) {
      step(tick < 500 ? -1e-3 : 2e-3 - 2e-3 * std::cos(0.01 * tick), stiffer);
    }
    for (int tick = 0; tick < 300; ++tick) step(-5e-3, stiffer);
  }
  void stay(double position, int ticks, double stiffer) {
    for (int tick = 0; tick < ticks; ++tick) step(position, stiffer);
  }
  /// In contact, 40 mm along the surface, from one stiffness to another.
  void drag(double speed, double from, double to) {
    constexpr int kSteps = 40;
    for (int i = 1; i <= kSteps; ++i) {
      new_place({kSiteB.x, 1.01e-3 * i});
      stay(2e-3, static_cast<int>(1.01 / speed), from + (to - from) * i / kSteps);
    }
  }
  void new_place(const Place& place) {
    estimator_.new_place(place);
    past_ = 0;
  }
  [[nodiscard]] const ModelPayload& told() const { return estimator_.model(); }
  [[nodiscard]] double force() const { return contact_model(told()).force(3e-3); }  ///< [N], 3 mm

  double relaxes{};  ///< [-], share of the force, in a second

 private:
  void step(double position, double stiffer) {
    const double force = stiffer * hertz(position);
    past_ += 1e-3 * (force - past_);
    estimator_.step(position, std::max(0.0, force + relaxes * (force - past_)));
  }

  ContactEstimator estimator_{[] {
    ContactEstimatorConfig config;
    config.sensor.step = 0;
    return config;
  }()};
  double past_{};  ///< [N]
};

TEST(ContactEstimatorTest, KeepsShowingTheOldPlaceUntilTheNewOneIsTouched) {
  Palpation palpation;
  palpation.tap(1);
  const ModelPayload before = palpation.told();
  palpation.new_place(kSiteB);
  palpation.stay(-5e-3, 100, 1);
  EXPECT_EQ(palpation.told().c, before.c);
  EXPECT_EQ(palpation.told().surface, before.surface);
}

TEST(ContactEstimatorTest, KnowsAPlaceAgainThatItTouchedBefore) {
  Palpation palpation;
  palpation.tap(1);
  const double at_a = palpation.force();
  palpation.new_place(kSiteB);
  palpation.tap(2.5);
  const double at_b = palpation.force();
  ASSERT_GT(at_b, 2 * at_a);
  const std::uint32_t version = palpation.told().version;
  palpation.new_place(kSiteA);
  EXPECT_GT(palpation.told().version, version) << "told before it is touched";
  EXPECT_NEAR(palpation.force(), at_a, 0.02 * at_a);
  palpation.new_place(kSiteB);
  EXPECT_NEAR(palpation.force(), at_b, 0.02 * at_b);
}

TEST(ContactEstimatorTest, ADragDoesNotMakeItForgetWhereItStayed) {
  for (const double speed : {20e-3, 5e-3}) {
    Palpation palpation;
    palpation.tap(1);
    const double at_a = palpation.force();
    palpation.new_place(kSiteB);
    palpation.tap(2.5);
    palpation.stay(2e-3, 500, 2.5);
    palpation.drag(speed, 2.5, 2.5);
    palpation.stay(-5e-3, 300, 2.5);
    palpation.new_place(kSiteA);
    EXPECT_NEAR(palpation.force(), at_a, 0.02 * at_a) << speed;
  }
}

TEST(ContactEstimatorTest, WhatWasLearnedDeepIsNotForgottenInALightHold) {
  for (const double relaxes : {0.2, 0.4}) {
    Palpation palpation;
    palpation.relaxes = relaxes;
    palpation.tap(1);
    palpation.new_place(kSiteB);
    palpation.tap(2.5);
    palpation.new_place(kSiteA);
    for (int tick = 0; tick < 600; ++tick) palpation.stay(-5e-3 + 9.2e-6 * tick, 1, 1);
    palpation.stay(0.5e-3, 3000, 1);
    EXPECT_NEAR(palpation.force(), hertz(3e-3), 0.25 * hertz(3e-3)) << relaxes;
  }
}

TEST(ContactEstimatorTest, KnowsAPlaceAgainFromOneThatProvedToBeElsewhere) {
  Palpation palpation;
  palpation.tap(1);
  const double at_a = palpation.force();
  palpation.new_place(kSiteB);
  palpation.tap(2.5);
  palpation.stay(4e-3, 300, 0);  // deep below the surface as believed, and nothing felt
  palpation.new_place(kSiteA);
  EXPECT_NEAR(palpation.force(), at_a, 0.02 * at_a);
}

}  // namespace
}  // namespace palp::coupling
