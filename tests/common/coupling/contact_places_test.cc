#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/core/place.h"
#include "common/coupling/contact_estimator.h"
#include "common/coupling/contact_model.h"

namespace palp::coupling {
namespace {

double hertz(double depth) { return depth > 0 ? 1897 * depth * std::sqrt(depth) : 0; }

TEST(ContactEstimatorTest, KeepsShowingTheOldPlaceUntilTheNewOneIsTouched) {
  ContactEstimatorConfig config;
  config.sensor.step = 0;
  ContactEstimator estimator{config};
  for (int tick = 0; tick < 3000; ++tick) {
    const double position = tick < 500 ? -1e-3 : 2e-3 - 2e-3 * std::cos(0.01 * tick);
    estimator.step(position, hertz(position));
  }
  for (int tick = 0; tick < 300; ++tick) estimator.step(-5e-3, 0);
  const ModelPayload before = estimator.model();
  estimator.new_place(kSiteB);
  for (int tick = 0; tick < 100; ++tick) estimator.step(-5e-3, 0);
  EXPECT_EQ(estimator.model().c, before.c);
  EXPECT_EQ(estimator.model().surface, before.surface);
}

TEST(ContactEstimatorTest, KnowsAPlaceAgainThatItTouchedBefore) {
  ContactEstimatorConfig config;
  config.sensor.step = 0;
  ContactEstimator estimator{config};
  const auto tap = [&](double stiffer) {
    for (int tick = 0; tick < 3000; ++tick) {
      const double position = tick < 500 ? -1e-3 : 2e-3 - 2e-3 * std::cos(0.01 * tick);
      estimator.step(position, stiffer * hertz(position));
    }
    for (int tick = 0; tick < 300; ++tick) estimator.step(-5e-3, 0);
  };
  tap(1);
  const double at_a = contact_model(estimator.model()).force(3e-3);
  estimator.new_place(kSiteB);
  tap(2.5);
  const double at_b = contact_model(estimator.model()).force(3e-3);
  ASSERT_GT(at_b, 2 * at_a);
  const std::uint32_t version = estimator.model().version;
  estimator.new_place(kSiteA);
  EXPECT_GT(estimator.model().version, version) << "told before it is touched";
  EXPECT_NEAR(contact_model(estimator.model()).force(3e-3), at_a, 0.02 * at_a);
  estimator.new_place(kSiteB);
  EXPECT_NEAR(contact_model(estimator.model()).force(3e-3), at_b, 0.02 * at_b);
}

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
      estimator.new_place({kSiteB.x, 1.01e-3 * i});
      stay(2e-3, static_cast<int>(1.01 / speed), from + (to - from) * i / kSteps);
    }
  }
  [[nodiscard]] double force() const { return contact_model(estimator.model()).force(3e-3); }

  void new_place(const Place& place) {
    estimator.new_place(place);
    past_ = 0;
  }

  ContactEstimator estimator{[] {
    ContactEstimatorConfig config;
    config.sensor.step = 0;
    return config;
  }()};
  double relaxes{};  ///< [-], share of the force, in a second

 private:
  void step(double position, double stiffer) {
    const double force = stiffer * hertz(position);
    past_ += 1e-3 * (force - past_);
    estimator.step(position, std::max(0.0, force + relaxes * (force - past_)));
  }

  double past_{};  ///< [N]
};

TEST(ContactEstimatorTest, ADragDoesNotMakeItForgetWhereItStayed) {
  for (const double speed : {20e-3, 5e-3}) {
    Palpation palpation;
    palpation.tap(1);
    const double at_a = palpation.force();
    palpation.estimator.new_place(kSiteB);
    palpation.tap(2.5);
    palpation.stay(2e-3, 500, 2.5);
    palpation.drag(speed, 2.5, 2.5);
    palpation.stay(-5e-3, 300, 2.5);
    palpation.estimator.new_place(kSiteA);
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
  palpation.estimator.new_place(kSiteB);
  palpation.tap(2.5);
  palpation.stay(4e-3, 300, 0);  // deep below the surface as believed, and nothing felt
  palpation.estimator.new_place(kSiteA);
  EXPECT_NEAR(palpation.force(), at_a, 0.02 * at_a);
}

}  // namespace
}  // namespace palp::coupling
