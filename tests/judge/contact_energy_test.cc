#include "judge/contact_energy.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace palp::judge {
namespace {

/// A hand that goes into a spring and out of it again, by way of the true path of its force.
class Hand {
 public:
  static constexpr double kDepth = 4e-3;  // [m]
  static constexpr int kTicks = 4000;     // of a press: fine steps, so that sums are integrals

  /// `in`, `out` [N/m]: stiffness on the way in and on the way out.
  void press(double in, double out) {
    air(0.1);
    for (int i = 1; i <= kTicks; ++i) {
      const double position = kDepth * std::sin(std::numbers::pi * i / kTicks);
      const double stiffness = i <= kTicks / 2 ? in : out;
      const double middle = 0.5 * (position + position_);
      work_ += stiffness * middle * (position - position_);
      position_ = position;
      tick(std::max(0.0, stiffness * position));
    }
    position_ = 0;
    air(0.1);
  }
  void air(double span) {
    for (int i = 0; i < 1000 * span; ++i) tick(0);
  }
  [[nodiscard]] const ContactEnergy& energy() const { return energy_; }

 private:
  void tick(double force) {
    at_ += 1e-3;
    energy_.look({.at = at_, .felt = force, .truth = position_ > 1e-9 ? 1.0 : 0.0, .work = work_});
  }
  ContactEnergy energy_;
  double at_{};        // [s]
  double position_{};  // [m]
  double work_{};      // [J]
};

/// [J], of the loop.
double loop(double in, double out) { return 0.5 * (out - in) * Hand::kDepth * Hand::kDepth; }

TEST(ContactEnergyTest, ASpringThatIsNoStifferOnTheWayOutGivesNothing) {
  for (const double out : {500.0, 300.0}) {
    Hand hand;
    hand.press(500, out);
    EXPECT_NEAR(hand.energy().in_contact(), 0, 1e-9) << out;
    EXPECT_NEAR(hand.energy().air_to_air(), 0, 1e-9) << out;
  }
}

TEST(ContactEnergyTest, ASpringThatIsStifferOnTheWayOutGivesTheLoopsArea) {
  Hand hand;
  hand.press(300, 500);
  EXPECT_NEAR(hand.energy().in_contact(), loop(300, 500), 1e-8);
  EXPECT_NEAR(hand.energy().air_to_air(), loop(300, 500), 1e-8);
}

TEST(ContactEnergyTest, ContactsAddUpOnlyFromAirToAir) {
  Hand hand;
  hand.press(300, 500);
  hand.press(300, 500);
  EXPECT_NEAR(hand.energy().in_contact(), loop(300, 500), 1e-8);
  EXPECT_NEAR(hand.energy().air_to_air(), 2 * loop(300, 500), 1e-8);
}

TEST(ContactEnergyTest, WhatWasTakenBeforeIsNotGivenBackInAnotherContact) {
  Hand hand;
  hand.press(500, 300);
  hand.press(300, 400);
  EXPECT_NEAR(hand.energy().in_contact(), loop(300, 400), 1e-8);
  EXPECT_NEAR(hand.energy().air_to_air(), loop(300, 400), 1e-8);
}

/// A force that comes back within 20 ms is of the same contact, one that comes later is not.
TEST(ContactEnergyTest, TwentyMillisecondsWithoutForceEndAContact) {
  for (const int gap : {15, 25}) {
    ContactEnergy energy;
    double at = 0;
    double work = 0;
    const auto ticks = [&](int count, double felt) {
      for (int i = 0; i < count; ++i) {
        at += 1e-3;
        if (felt > 0) work -= 1e-6;
        energy.look({.at = at, .felt = felt, .work = work});
      }
    };
    ticks(50, 0);
    ticks(100, 0.06);
    ticks(gap, 0);
    ticks(100, 0.06);
    ticks(50, 0);
    EXPECT_NEAR(energy.in_contact(), gap < 20 ? 200e-6 : 100e-6, 1e-9) << gap;
  }
}

/// A tissue may sink away under a hand that is given little of it still: what that stores is of the
/// same contact.
TEST(ContactEnergyTest, AContactLastsUntilNothingOfItIsLeft) {
  ContactEnergy energy;
  double at = 0;
  double work = 0;
  const auto ticks = [&](int count, double felt, double gain) {
    for (int i = 0; i < count; ++i) {
      at += 1e-3;
      work += gain;
      energy.look({.at = at, .felt = felt, .work = work});
    }
  };
  ticks(50, 0, 0);
  ticks(100, 0.3, 4e-6);
  ticks(100, 0.04, 0);
  ticks(100, 0.3, -6e-6);
  ticks(50, 0, 0);
  EXPECT_NEAR(energy.in_contact(), 200e-6, 1e-9);
}

TEST(ContactEnergyTest, WhereNobodyKnowsTheTissueTheForceFeltTells) {
  ContactEnergy energy;
  energy.look({.at = 0, .truth = NAN});
  energy.look({.at = 1e-3, .felt = 0.06, .truth = NAN, .work = -1e-3});
  EXPECT_EQ(energy.in_contact(), 1e-3);
  EXPECT_EQ(energy.air_to_air(), 0);
}

}  // namespace
}  // namespace palp::judge
