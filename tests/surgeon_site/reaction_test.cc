#include "surgeon_site/reaction.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "surgeon_site/hand_plant.h"
#include "tests/support/realtime_guard.h"

/// Goal: a hand that reacts does so by its law, late, bounded, and does not swing by itself.
namespace palp::surgeon {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""us;

constexpr Grip kGrips[]{kLightGrip, kMidGrip, kFirmGrip, kArmGrip};
constexpr double kReflexMost = 0.5;  // [-], of hand.reflex

HandPlantConfig with(const Grip& grip, const ReactionConfig& reaction) {
  HandPlantConfig config;
  config.grip = grip;
  config.reaction = reaction;
  return config;
}

/// Where a constant force leaves a hand that wants to stay [m].
double bent(const HandPlantConfig& config, double force) {
  HandPlant plant{config, 0};
  for (int i = 0; i < 8000; ++i) plant.advance({}, {}, force, 1ms);
  return -plant.position();
}

TEST(ReactionTest, WithoutReactionTheHandIsThePassiveOneBitForBit) {
  HandPlantConfig config;
  HandPlant plant{config, 0};
  double position = 0, velocity = 0;
  const TanhTable tanh;
  const double dt = 1e-3 / 10;
  const double gain = dt / (config.mass + config.grip.mass);
  for (int i = 0; i < 1000; ++i) {
    const double force = 0.7 * std::sin(0.05 * i);
    plant.advance({}, {}, force, 1ms);
    for (int part = 0; part < 10; ++part) {
      const double pull =
          config.grip.stiffness * (0 - position) + config.grip.damping * (0 - velocity);
      const double drag = config.damping * velocity +
                          config.friction * tanh(velocity * (1 / config.friction_speed));
      velocity += gain * (pull - force - drag);
      position += dt * velocity;
    }
    ASSERT_EQ(plant.position(), position);
    ASSERT_EQ(plant.velocity(), velocity);
  }
}

TEST(ReactionTest, TheReflexActsAfterItsDelayAndNotBefore) {
  for (const Duration delay : {20ms, 50ms, 150ms}) {
    HandPlant passive{with(kMidGrip, {}), 0};
    HandPlant reacting{with(kMidGrip, {.reflex = 0.5, .reflex_delay = delay}), 0};
    Duration lived{};
    const auto live = [&](Duration span) {
      lived += span;
      passive.advance({}, {}, 1, span);
      reacting.advance({}, {}, 1, span);
    };
    while (lived < delay) {
      live(100us);
      ASSERT_EQ(reacting.position(), passive.position()) << seconds(lived);
    }
    while (lived < delay + 1ms) live(100us);
    EXPECT_GT(reacting.position(), passive.position()) << "it works against the force";
  }
}

TEST(ReactionTest, TheReflexGrowsLikeTheActivationOfAMuscle) {
  // A stretch that is held: 1 - (c e^(-t/c) - e e^(-t/e)) / (c - e), with the lags e and c.
  Reaction reaction{{.reflex = 0.4}};
  reaction.set_step(1e-4);
  const double e = Reaction::kExcitation, c = Reaction::kContraction;
  for (int i = 1; i <= 5000; ++i) {
    reaction.step(1e-3, 0);
    const double t = 1e-4 * i - 50e-3;
    const double grown = t < 0 ? 0 : 1 - (c * std::exp(-t / c) - e * std::exp(-t / e)) / (c - e);
    ASSERT_NEAR(reaction.reflex(), 0.4e-3 * grown, 0.4e-5) << t;
  }
}

TEST(ReactionTest, TheDelayIsExactWhateverTheStep) {
  // A stretch that grows by 1 m/s is answered as it was, the delay and both lags ago.
  for (const double dt : {1e-5, 3e-5, 4.1e-5}) {
    Reaction reaction{{.reflex = 0.5, .reflex_delay = 50ms}};
    reaction.set_step(dt);
    const double lags = 50e-3 + Reaction::kExcitation + Reaction::kContraction;
    const int last = static_cast<int>(1 / dt);
    for (int i = 0; i < last; ++i) {
      const double t = dt * i;
      reaction.step(t, 0);
      if (i < last - 20) continue;
      // Each lag of a step that ends is half a step shorter.
      ASSERT_NEAR(reaction.reflex(), 0.5 * (t - lags + dt), 1e-6) << dt;
    }
  }
}

TEST(ReactionTest, TheReflexRaisesTheStaticStiffnessByItsShare) {
  for (const Grip& grip : kGrips) {
    for (const double reflex : {0.1, 0.3, 0.5}) {
      const HandPlantConfig config = with(grip, {.reflex = reflex});
      EXPECT_NEAR(bent(config, 1) * grip.stiffness * (1 + reflex), 1, 1e-6);
    }
  }
}

TEST(ReactionTest, CoContractionRaisesTheStiffnessWithTheLoadToTwiceAtMost) {
  for (const Grip& grip : kGrips) {
    const HandPlantConfig config = with(grip, {.co_contraction = 0.25});
    for (const double force : {0.5, 2.0, -2.0, 4.0, 8.0}) {
      const double tension = std::min(2.0, 1 + 0.25 * std::abs(force));
      EXPECT_NEAR(bent(config, force) * grip.stiffness * tension, force, 1e-5) << force;
    }
  }
}

TEST(ReactionTest, CoContractionKeepsTheDampingRatio) {
  // Of a handle without mass, damping and friction: the overshoot tells the ratio.
  const auto overshoot = [](double co_contraction) {
    HandPlantConfig config = with(kArmGrip, {.co_contraction = co_contraction});
    config.damping = config.friction = 0;
    HandPlant plant{config, 0};
    for (int i = 0; i < 5000; ++i) plant.advance({}, {}, 4, 1ms);
    const double rest = plant.position();
    double most = rest;
    for (int i = 0; i < 1000; ++i) {
      plant.advance({5e-3, 0}, {5e-3, 0}, 4, 1ms);
      most = std::max(most, plant.position());
    }
    return (most - rest) / 5e-3;
  };
  EXPECT_GT(overshoot(0), 1.2);
  EXPECT_NEAR(overshoot(0.25), overshoot(0), 1e-3);
}

TEST(ReactionTest, CoContractionIsSlow) {
  Reaction reaction{{.co_contraction = 0.25}};
  reaction.set_step(1e-4);
  for (int i = 0; i < 3000; ++i) reaction.step(0, -4);
  EXPECT_NEAR(reaction.tension(), 1 + (1 - std::exp(-1)), 1e-9) << "after its time constant";
}

/// A hand that goes 4 mm into a spring and stays, with the force of every 2 ms.
HandPlant pressed(Duration span) {
  HandPlantConfig config =
      with(kMidGrip, {.reflex = 0.5, .reflex_delay = 33ms, .co_contraction = 0.5});
  HandPlant plant{config, 0};
  double force = 0;
  for (Duration lived{}; lived < 600ms; lived += 2ms) {
    const Pull aim{lived == Duration{} ? 0 : 4e-3, 0};
    Duration left = 2ms;
    for (; left > span; left -= span) plant.advance(aim, aim, force, span);
    plant.advance(aim, aim, force, left);
    force = 500 * plant.position();
  }
  return plant;
}

TEST(ReactionTest, HowTimeIsCutChangesNothing) {
  const HandPlant whole = pressed(2ms);
  for (const Duration span : {1000us, 730us, 400us, 130us, 100us, 70us}) {
    const HandPlant parts = pressed(span);
    // Steps of another length integrate a little differently, the passive hand's too.
    EXPECT_NEAR(parts.position(), whole.position(), 2e-6) << seconds(span);
    EXPECT_NEAR(parts.work(), whole.work(), 2e-5 * std::abs(whole.work()) + 2e-6);
  }
  const HandPlant again = pressed(2ms);
  EXPECT_EQ(again.position(), whole.position());
  EXPECT_EQ(again.velocity(), whole.velocity());
  EXPECT_EQ(again.work(), whole.work());
}

TEST(ReactionTest, WorkIsTheSumOfForceTimesWayAndNothingAllocates) {
  HandPlant plant{with(kArmGrip, {.reflex = 0.5, .co_contraction = 1}), 0};
  double summed = 0;
  const test::RealtimeGuard guard;
  for (int i = 0; i < 2000; ++i) {
    const double force = 3 * std::sin(0.02 * i);
    const double before = plant.position();
    plant.advance({}, {}, force, 1ms);
    summed += force * (plant.position() - before);
  }
  EXPECT_TRUE(guard.clean()) << guard.first_violation();
  EXPECT_NEAR(plant.work(), summed, 1e-12);
  EXPECT_GT(std::abs(plant.work()), 1e-4);
}

/// Largest swings [m] of a hand that was moved by 5 mm at a spring: in a first and a last second.
struct Swings {
  double first{};
  double last{};
};

/// The spring [N/m] answers every `hold`; `wait` lies between both seconds.
Swings swings(const HandPlantConfig& config, double spring, Duration hold, Duration wait) {
  HandPlant plant{config, 0};
  const Pull aim{5e-3, 0};
  const auto live = [&](Duration length) {
    double low = plant.position(), high = low;
    for (Duration lived{}; lived < length; lived += hold) {
      plant.advance(aim, aim, spring * plant.position(), hold);
      low = std::min(low, plant.position());
      high = std::max(high, plant.position());
    }
    return high - low;
  };
  const double first = live(1000ms);
  live(wait);
  return {first, live(1000ms)};
}

/// No friction and no damping of the handle helps.
HandPlantConfig alone(const Grip& grip, double mass, const ReactionConfig& reaction) {
  HandPlantConfig config = with(grip, reaction);
  config.mass = mass;
  config.damping = config.friction = 0;
  return config;
}

TEST(ReactionTest, AnySwingOfAHandAtASpringDiesOut) {
  constexpr double kMass = HandPlantConfig{}.mass;
  for (const Grip& grip : kGrips)
    for (const double reflex : {0.0, kReflexMost})
      for (const Duration delay : {20ms, 50ms, 90ms, 150ms})
        for (const double co_contraction : {0.0, 0.2, 1.0})
          for (const double spring : {0.0, 100.0, 500.0, 2000.0}) {
            const ReactionConfig reaction{reflex, delay, co_contraction};
            const Swings bare = swings(alone(grip, kMass, reaction), spring, 100us, 1000ms);
            const Swings sampled = swings(with(grip, reaction), spring, 1ms, 1000ms);
            EXPECT_LT(std::max(bare.last / bare.first, sampled.last / sampled.first), 0.03)
                << "grip " << grip.stiffness << " reflex " << reflex << " delay " << seconds(delay)
                << " co-contraction " << co_contraction << " spring " << spring;
          }
}

TEST(ReactionTest, AReflexThatIsBorneSwingsOnNoHandle) {
  for (const Grip& grip : kGrips)
    for (const double mass : {0.01, 0.5, 2.0})
      for (const Duration delay : {20ms, 60ms, 100ms, 150ms})
        for (const double co_contraction : {0.0, 0.5})
          for (const double spring : {0.0, 100.0, 2000.0}) {
            HandPlantConfig config = alone(grip, mass, {0, delay, co_contraction});
            config.reaction.reflex = std::min(kReflexMost, reflex_borne(config));
            const Swings found = swings(config, spring, 100us, 3000ms);
            EXPECT_LT(found.last, 0.85 * found.first)
                << "grip " << grip.stiffness << " mass " << mass << " delay " << seconds(delay)
                << " co-contraction " << co_contraction << " spring " << spring;
          }
}

TEST(ReactionTest, BeyondWhatIsBorneAHandSwings) {
  // What is borne is not far below the border: its margin is a third.
  for (const double mass : {0.075, 2.0}) {
    double most = 0;
    for (Duration delay = 20ms; delay <= 150ms; delay += 10ms) {
      HandPlantConfig config = alone(kLightGrip, mass, {0, delay, 0});
      config.reaction.reflex = 1.5 * reflex_borne(config);
      const Swings found = swings(config, 0, 100us, 3000ms);
      most = std::max(most, found.last / found.first);
    }
    EXPECT_GT(most, 1) << mass;
  }
}

TEST(ReactionTest, EveryGripOnTheUsualDeviceBearsTheWholeRange) {
  for (const Grip& grip : kGrips) EXPECT_GT(reflex_borne(with(grip, {})), kReflexMost);
}

}  // namespace
}  // namespace palp::surgeon
