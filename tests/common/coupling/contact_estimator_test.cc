#include "common/coupling/contact_estimator.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "common/core/filters.h"
#include "common/core/place.h"
#include "common/core/random.h"
#include "common/coupling/contact_model.h"
#include "tests/common/coupling/sensed_tip.h"

namespace palp::coupling {
namespace {

/// A tip that taps four times, 4 mm deep, on tissue without noise, seen through the transducer's
/// pole. @returns what was learned.
template <class Tissue>
ModelPayload learn(const Tissue& tissue, double surface = 0) {
  ContactEstimatorConfig config;
  config.sensor.step = 0;
  ContactEstimator estimator{config};
  LowPass pole{config.sensor.pole, config.period / 10};
  double before = -3e-3;
  for (int tick = 0; tick < 7000; ++tick) {
    const double t = 1e-3 * tick;
    const double phase = std::fmod(t, 1.5);
    const double raised = phase < 1 ? 0.5 * (1 - std::cos(2 * std::numbers::pi * phase)) : 0;
    const double position = t < 1 ? -3e-3 : -3e-3 + 7e-3 * raised;
    for (int part = 1; part <= 10; ++part) {
      const double x = before + 0.1 * part * (position - before);
      pole.step(tissue(x - surface));
    }
    before = position;
    estimator.step(position, pole.value());
  }
  return estimator.model();
}

double hertz(double depth) { return depth > 0 ? 1897 * depth * std::sqrt(depth) : 0; }

/// Over a hard inclusion 5 mm deep, in a law that is not one of the estimator's.
double over_inclusion(double depth) {
  if (depth <= 0) return 0;
  const double chi = std::sqrt(5e-3 * depth) / 5e-3;
  return hertz(depth) * (1 + 0.5 * chi * (1.133 + chi * (1.283 + chi * (0.769 + chi * 0.0975))));
}

/// Mean slope over what a tap is judged by.
template <class Force>
double secant(const Force& force) {
  return (force(3.6e-3) - force(1.2e-3)) / 2.4e-3;
}

TEST(ContactEstimatorTest, FindsHertzWithinAGridStepAndTwoThousandths) {
  const ModelPayload model = learn(hertz);
  EXPECT_NEAR(model.surface, 0, 0.051e-3);
  const ContactModel found = contact_model(model);
  const auto felt = [&](double x) { return found.force(x - found.surface); };
  EXPECT_NEAR(secant(felt) / secant(hertz), 1, 2e-3);
}

TEST(ContactEstimatorTest, FindsALawThatIsNotOneOfItsOwn) {
  const ContactModel found = contact_model(learn(over_inclusion));
  const auto felt = [&](double x) { return found.force(x - found.surface); };
  EXPECT_NEAR(secant(felt) / secant(over_inclusion), 1, 2e-3);
}

TEST(ContactEstimatorTest, FindsTissuesThatStiffenExponentially) {
  for (const double per_mm : {0.3, 0.45, 0.7}) {
    const auto tissue = [per_mm](double depth) {
      return depth > 0 ? 0.036 / per_mm * std::expm1(1e3 * per_mm * depth) : 0;
    };
    const ContactModel found = contact_model(learn(tissue));
    for (const double depth : {2e-3, 2.5e-3, 3e-3, 3.5e-3, 4e-3}) {
      const double slope = 36 * std::exp(1e3 * per_mm * depth);
      EXPECT_NEAR(found.slope(depth - found.surface) / slope, 1, 0.03) << per_mm << ' ' << depth;
    }
  }
}

TEST(ContactEstimatorTest, FiveNumbersSayWhatTheySuffice) {
  const ModelPayload model = learn(hertz);
  EXPECT_EQ(model.stiffness, KnotStiffness{});
  EXPECT_GT(model.c[1], 0.05);
}

TEST(ContactEstimatorTest, FindsWhatATissueThatRelaxesComesTo) {
  for (const double time : {0.4, 1.0, 2.5}) {
    double past = 0;
    const auto tissue = [&](double depth) {  // called every 0.1 ms
      const double elastic = hertz(depth);
      past += 1e-4 / time * (elastic - past);
      return std::max(0.0, 1.1 * elastic - 0.1 * past);
    };
    const ModelPayload model = learn(tissue);
    const ContactModel found = contact_model(model);
    const auto felt = [&](double x) { return found.force(x - found.surface); };
    EXPECT_NEAR(secant(felt) / secant(hertz), 1, 0.03) << time;
    EXPECT_GT(model.relaxing[0] + model.relaxing[1], 0) << time;
  }
}

TEST(ContactEstimatorTest, WhatIsHeldIsToldAsItIsMeasuredBeforeTheFitKnowsWhy) {
  SensedTip tip;
  double past = 0;
  double position = -3e-3;
  for (int tick = 0; tick < 3300; ++tick) {
    if (tick > 1000) position = std::min(4e-3, position + 10e-6);
    past += 1e-3 / 1.5 * (hertz(position) - past);
    const double force = std::max(0.0, 1.4 * hertz(position) - 0.4 * past);
    const double given = tip.meets(position, force);
    if (tick < 2500) continue;
    EXPECT_NEAR(given / force, 1, 0.03) << tick;
  }
}

TEST(ContactEstimatorTest, DampingIsNoStiffnessAndDoesNotRelax) {
  double before = 0;
  const auto tissue = [&](double depth) {
    const double rate = (depth - before) / 1e-4;
    before = depth;
    return std::max(0.0, hertz(depth) * (1 + 1.5 * rate));
  };
  const ModelPayload model = learn(tissue);
  const ContactModel found = contact_model(model);
  const auto felt = [&](double x) { return found.force(x - found.surface); };
  EXPECT_NEAR(secant(felt) / secant(hertz), 1, 0.01);
  EXPECT_LT(model.relaxing[0] + model.relaxing[1], 0.02);
}

TEST(ContactEstimatorTest, ATissueThatLetsGoOnTheWayOutIsAsStiffAsOnTheWayIn) {
  double before = 0;
  double share = 1;
  const auto tissue = [&](double depth) {
    share = std::clamp(share + (depth > before ? 0.01 : -0.01), 0.9, 1.0);
    before = depth;
    return share * hertz(depth);
  };
  const ModelPayload model = learn(tissue);
  const ContactModel found = contact_model(model);
  const auto felt = [&](double x) { return found.force(x - found.surface); };
  EXPECT_NEAR(secant(felt) / secant(hertz), 1, 0.048);
}

TEST(ContactEstimatorTest, TissueThatBreathesIsFoundAsStiffAsItIsAtAnyPace) {
  for (const double pace : {0.2, 0.25, 0.33}) {
    ContactEstimatorConfig config;
    config.sensor.step = 0;
    ContactEstimator estimator{config};
    LowPass pole{config.sensor.pole, config.period};
    double surface = 0;
    double position = -3e-3;
    for (int tick = 0; tick < 16'000; ++tick) {
      const double t = 1e-3 * tick;
      const double phase = std::fmod(t, 1.5);
      const double tap = phase < 1 ? 3.5e-3 * (1 - std::cos(2 * std::numbers::pi * phase)) : 0;
      position = t < 7 ? -3e-3 + tap : std::min(3e-3, -3e-3 + 10e-3 * (t - 7));
      surface = 1e-3 * std::sin(2 * std::numbers::pi * pace * t);
      estimator.step(position, pole.step(hertz(position - surface)));
    }
    const ModelPayload model = estimator.model();
    const ContactModel found = contact_model(model);
    EXPECT_NEAR(model.surface + model.swing, surface, 0.1e-3) << pace;
    EXPECT_NEAR(found.force(3e-3) / hertz(3e-3), 1, 0.03) << pace;
  }
}

/// Three presses that are held and then moved about, on a tissue that relaxes and from 1.5 mm on is
/// `under` times as stiff; noise and steps of the sensor. @returns how often a breath was told,
/// once there was time to know.
int breaths_told(double stiffness, double under) {
  const ContactEstimatorConfig config;
  ContactEstimator estimator{config};
  LowPass pole{config.sensor.pole, config.period};
  double past = 0;
  int told = 0;
  for (int tick = 0; tick < 14'000; ++tick) {
    const double t = 1e-3 * tick;
    const double inside = std::fmod(std::max(0.0, t - 1), 4.3);
    const double position = -3e-3 + 6e-3 * std::clamp(inside, 0.0, 1.0) +
                            (inside > 2.5 ? 1e-3 * std::sin(3 * (inside - 2.5)) : 0);
    const double depth = std::max(0.0, position);
    const double elastic = stiffness * (depth < 1.5e-3 ? depth : 1.5e-3 + under * (depth - 1.5e-3));
    past += 1e-3 / 0.8 * (elastic - past);
    const double noisy = pole.step(std::max(0.0, elastic - 0.25 * past)) +
                         15e-3 * random_normal(7, 3, static_cast<std::uint64_t>(tick));
    estimator.step(position, 0.05 * std::round(noisy / 0.05));
    const ModelPayload& model = estimator.model();
    const double swing = std::hypot(model.swing, model.swing_quadrature);
    told += t > 6 && swing > 0.2e-3 ? 1 : 0;
  }
  return told;
}

TEST(ContactEstimatorTest, ALargeBreathOfSoftTissueIsFoundAndKept) {
  const ContactEstimatorConfig config;
  ContactEstimator estimator{config};
  LowPass pole{config.sensor.pole, config.period};
  double off = 0;
  double whole = 0;
  double position = -3e-3;
  for (int tick = 0; tick < 20'000; ++tick) {
    const double t = 1e-3 * tick;
    const double inside = std::fmod(std::max(0.0, t - 1), 8.0);
    const double aim = t < 1 || inside > 7.3 ? -3e-3 : 3.2e-3;
    position += std::clamp(aim - position, -60e-6, 60e-6);
    const double depth = std::max(0.0, position - 1.5e-3 * std::sin(2.155 * t));
    const double truth = 0.0158 * std::pow(1e3 * depth, 2.5);
    const double noise = 15e-3 * random_normal(7, 3, static_cast<std::uint64_t>(tick));
    estimator.step(position, 0.05 * std::round((pole.step(truth) + noise) / 0.05));
    if (t < 9 || truth < 0.05) continue;
    const ContactModel found = contact_model(estimator.model());
    const double told = found.force(position - found.surface - estimator.model().swing);
    off += (told - truth) * (told - truth);
    whole += truth * truth;
  }
  EXPECT_LT(std::sqrt(off / whole), 0.06);
}

TEST(ContactEstimatorTest, WhatATissueAtRestExplainsIsNoBreath) {
  for (const double stiffness : {60.0, 200.0, 600.0}) {
    for (const double under : {0.3, 3.0}) {
      EXPECT_EQ(breaths_told(stiffness, under), 0) << stiffness << ' ' << under;
    }
  }
}

TEST(ContactEstimatorTest, FindsASurfaceThatIsNotWhereTheAxisBegins) {
  for (const double surface : {-2e-3, 0.7e-3}) {
    EXPECT_NEAR(learn(hertz, surface).surface, surface, 0.051e-3);
  }
}

TEST(ContactEstimatorTest, FindsTissueThreeTimesStifferOrSofterThanExpected) {
  for (const double factor : {1.0 / 3, 3.0}) {
    const auto tissue = [factor](double depth) { return factor * hertz(depth); };
    const ContactModel found = contact_model(learn(tissue));
    const auto felt = [&](double x) { return found.force(x - found.surface); };
    EXPECT_NEAR(secant(felt) / secant(tissue), 1, 5e-3) << factor;
  }
}

TEST(ContactEstimatorTest, OnlySaysWhatIsPassive) {
  const ModelPayload model = learn([](double d) { return d > 0 ? 0.3 : 0.0; });  // no spring at all
  EXPECT_TRUE(is_sound(model, 60e-3));
}

TEST(ContactEstimatorTest, TheSurfaceDoesNotWalkToWhereTheTipFeltNothing) {
  ContactEstimatorConfig config;
  config.sensor.step = 0;
  ContactEstimator estimator{config};
  double highest = 0;
  for (int tick = 0; tick < 30'000; ++tick) {
    const double t = 1e-3 * tick;
    const double tap = -3e-3 + 3.5e-3 * (1 - std::cos(2 * std::numbers::pi * t));
    const double sway = 2e-3 * std::sin(9 * t);  // about a press of 3 mm
    // What a wrong breath makes of a tissue: soft, and as if it began 15 mm above the tip.
    const bool pressed = t > 6;
    const double force = pressed ? 0.3 + 20 * sway : hertz(tap);
    estimator.step(pressed ? 3e-3 + sway : tap, force);
    highest = std::min(highest, estimator.model().surface);
  }
  EXPECT_GT(highest, -7e-3);
}

TEST(ContactEstimatorTest, SaysNothingWithoutAContact) {
  ContactEstimator estimator{ContactEstimatorConfig{}};
  for (int tick = 0; tick < 2000; ++tick) estimator.step(-5e-3, 0.05 * ((tick % 20) == 0));
  EXPECT_EQ(estimator.model().version, 0U);
}

/// Noise of 15 mN does that within some minutes where it takes a sensor's step of 50 mN.
TEST(ContactEstimatorTest, SixReadingsOfOneStepInARowAreNoContact) {
  ContactEstimator estimator{ContactEstimatorConfig{}};
  for (int tick = 0; tick < 2000; ++tick) {
    estimator.step(-5e-3, tick >= 1000 && tick < 1006 ? 0.05 : 0);
  }
  EXPECT_EQ(estimator.model().version, 0U);
}

/// A transducer of the paper's steps in quiet air, read as often as its device can.
TEST(ContactEstimatorTest, NoiseIsNoContactHoweverSlowTheSensorIs) {
  for (const double rate : {50.0, 100.0, 200.0, 500.0, 1000.0}) {
    for (const double noise : {5e-3, 10e-3, 15e-3, 25e-3}) {
      ContactEstimatorConfig config;
      config.sensor.rate = rate;
      ContactEstimator estimator{config};
      const RandomStream draws{7, static_cast<std::uint64_t>(rate)};
      const auto reading = [&](double number) {
        return config.sensor.step *
               std::round(noise * draws.normal(static_cast<std::uint64_t>(number)) /
                          config.sensor.step);
      };
      for (int tick = 0; tick < 60'000; ++tick) {
        // As the two readings round it say, one after the other.
        const double read = tick * config.period * rate;
        const double before = reading(std::floor(read));
        const double share = read - std::floor(read);
        estimator.step(-5e-3, before + share * (reading(std::floor(read) + 1) - before));
        ASSERT_EQ(estimator.model().version, 0U)
            << rate << " Hz, " << noise << " N, after " << tick << " ms";
      }
    }
  }
}

TEST(ContactEstimatorTest, WhatProvesToBeNoiseIsTakenBack) {
  ContactEstimator estimator{ContactEstimatorConfig{}};
  const auto stand = [&](int ticks, double force) {
    for (int tick = 0; tick < ticks; ++tick) estimator.step(-5e-3, force);
  };
  stand(1000, 0);
  stand(8, 0.05);
  ASSERT_GT(contact_model(estimator.model()).force(2e-3), 0.1) << "it is shown at once";
  stand(60, 0);
  EXPECT_EQ(contact_model(estimator.model()).force(2e-3), 0);
  // A light touch that stays is none.
  stand(60, 0.05);
  stand(400, 0.03);
  EXPECT_GT(contact_model(estimator.model()).force(2e-3), 0.01);
}

}  // namespace
}  // namespace palp::coupling
