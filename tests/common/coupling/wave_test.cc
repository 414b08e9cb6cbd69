#include "common/coupling/wave.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/core/random.h"
#include "common/coupling/any_coupling.h"
#include "common/coupling/play_out.h"

namespace palp::coupling {
namespace {

constexpr double kPeriod = 1e-3;

Incoming wave_sample(std::uint64_t number, const WavePayload& payload, double arrived) {
  Incoming incoming;
  incoming.sample.payload = payload;
  incoming.number = number;
  incoming.fresh = true;
  incoming.sent_at = PeerTimePoint{from_seconds(kPeriod * static_cast<double>(number))};
  incoming.arrived_at = TimePoint{from_seconds(arrived)};
  return incoming;
}

RC_GTEST_PROP(PlayOutTest, NeverPlaysMoreEnergyThanWasSent, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  struct Flying {
    double due;
    Incoming incoming;
  };
  std::vector<Flying> flying;
  PlayOut play_out{kPeriod};
  WavePayload sent;
  for (std::uint64_t tick = 0; tick < 3000; ++tick) {
    const double now = kPeriod * static_cast<double>(tick);
    const double wave = std::sin(0.02 * static_cast<double>(tick)) + random_normal(seed, 0, tick);
    sent.wave_integral += wave * kPeriod;
    sent.wave_energy += 0.5 * wave * wave * kPeriod;
    const bool burst = tick % 700 > 550;
    if (!burst && random_uniform(seed, 1, tick) > 0.2) {
      for (std::uint64_t copy = 0; copy < 2; ++copy) {
        const double due = now + 0.05 + 0.04 * random_uniform(seed, 2 + copy, tick);
        flying.push_back({due, wave_sample(tick, sent, due)});
      }
    }
    std::vector<Incoming> arrived;
    for (auto it = flying.begin(); it != flying.end();) {
      if (it->due <= now) {
        arrived.push_back(it->incoming);
        it = flying.erase(it);
      } else {
        ++it;
      }
    }
    (void)play_out.step(TimePoint{from_seconds(now)}, arrived);
    RC_ASSERT(play_out.energy_played() <= sent.wave_energy + 1e-12);
    RC_ASSERT(play_out.energy_played() <= play_out.energy_received() + 1e-12);
  }
}

TEST(PlayOutTest, PlaysASteadyWaveAsItWasSentOverAnEvenPath) {
  PlayOut play_out{kPeriod};
  WavePayload sent;
  double played = 0;
  for (std::uint64_t tick = 0; tick < 1000; ++tick) {
    sent.wave_integral += 0.5 * kPeriod;
    sent.wave_energy += 0.5 * 0.25 * kPeriod;
    const double now = kPeriod * static_cast<double>(tick);
    const std::array arrived{wave_sample(tick, sent, now)};
    played = play_out.step(TimePoint{from_seconds(now)}, arrived);
  }
  EXPECT_NEAR(played, 0.5, 1e-3);
}

TEST(PlayOutTest, OverAnEvenPathNothingIsHeldBack) {
  PlayOut play_out{kPeriod};
  WavePayload sent;
  for (std::uint64_t tick = 0; tick < 3000; ++tick) {
    const double wave = random_normal(7, 0, tick);
    sent.wave_integral += wave * kPeriod;
    sent.wave_energy += 0.5 * wave * wave * kPeriod;
    const double now = kPeriod * static_cast<double>(tick);
    const std::array arrived{wave_sample(tick, sent, now)};
    (void)play_out.step(TimePoint{from_seconds(now)}, arrived);
    ASSERT_NEAR(play_out.integral_played(), sent.wave_integral, 1e-9) << "tick " << tick;
  }
}

/// A wave of 0.5 for 20 s over a path, then nothing: what is played, tick by tick.
struct Steady {
  double integral{};  ///< of what was played
  double sent{};      ///< from when playing began
  double largest{};   ///< from `settled` on
  double smallest{1};
};
template <class Delay>
Steady play_steady(Delay delay, std::uint64_t settled) {
  constexpr std::uint64_t kSent = 20'000;
  std::vector<std::vector<Incoming>> due(kSent + 1000);
  WavePayload sent;
  for (std::uint64_t tick = 0; tick < kSent + 500; ++tick) {
    const double wave = tick < kSent ? 0.5 : 0;
    sent.wave_integral += wave * kPeriod;
    sent.wave_energy += 0.5 * wave * wave * kPeriod;
    const double late = delay(tick);
    if (late < 0) continue;
    const double arrives = kPeriod * static_cast<double>(tick) + late;
    const auto heard = static_cast<std::size_t>(std::ceil(arrives / kPeriod - 1e-9));
    if (heard < due.size()) due[heard].push_back(wave_sample(tick, sent, arrives));
  }
  PlayOut play_out{kPeriod};
  Steady steady;
  double began = -1;
  for (std::uint64_t tick = 0; tick < due.size(); ++tick) {
    const double now = kPeriod * static_cast<double>(tick);
    const double wave = play_out.step(TimePoint{from_seconds(now)}, due[tick]);
    if (began < 0 && !due[tick].empty()) began = play_out.integral_played();
    steady.integral += wave * kPeriod;
    if (tick > 10) steady.largest = std::max(steady.largest, wave);
    if (tick > settled && tick < kSent) steady.smallest = std::min(steady.smallest, wave);
  }
  steady.sent = sent.wave_integral - began;
  return steady;
}

TEST(PlayOutTest, APathThatShakesAndLosesByMillisecondsTakesNothingOfTheIntegral) {
  const auto delay = [](std::uint64_t tick) {
    if (random_uniform(3, 1, tick) < 0.05) return -1.0;
    return 0.05 + 3e-3 * random_uniform(3, 0, tick);
  };
  const Steady steady = play_steady(delay, 10'000);
  EXPECT_NEAR(steady.integral, steady.sent, 1e-3 * steady.sent);
}

TEST(PlayOutTest, WhatWasWaitedForIsNotPlayedLouder) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const auto delay = [seed](std::uint64_t tick) {
      if (random_uniform(seed, 1, tick) < 0.05 || tick % 3000 > 2980) return -1.0;
      return std::max(0.01, 0.05 + 0.015 * random_normal(seed, 0, tick));
    };
    EXPECT_LE(play_steady(delay, 0).largest, 1.1 * 0.5 * (1 + 1e-6)) << "seed " << seed;
  }
}

TEST(PlayOutTest, APathIsKnownAfterAWhileAndTheWavePlayedEvenly) {
  const auto delay = [](std::uint64_t tick) { return tick % 50 == 0 ? 0.053 : 0.05; };
  EXPECT_GT(play_steady(delay, 1000).smallest, 0.45);
}

TEST(PlayOutTest, APauseIsDroppedAndDoesNotDelayWhatComesAfterItByItsLength) {
  constexpr std::uint64_t kPause = 60;
  const auto delay = [](std::uint64_t tick) {
    return tick >= 5000 && tick < 5000 + kPause ? -1.0 : 0.05;
  };
  const Steady steady = play_steady(delay, 0);
  const double lost = steady.sent - steady.integral;
  EXPECT_GT(lost, 0.5 * 0.8 * kPeriod * kPause);
  EXPECT_LT(lost, 0.5 * 1.1 * kPeriod * kPause);
}

TEST(PlayOutTest, APeerThatUnderstatesItsEnergyIsPlayedNoLouderThanItSays) {
  PlayOut play_out{kPeriod};
  WavePayload said;
  for (std::uint64_t tick = 0; tick < 1000; ++tick) {
    said.wave_integral += 0.5 * kPeriod;
    said.wave_energy = 1e-6;
    const double now = kPeriod * static_cast<double>(tick);
    const std::array arrived{wave_sample(tick, said, now)};
    (void)play_out.step(TimePoint{from_seconds(now)}, arrived);
    ASSERT_LE(play_out.energy_played(), 1e-6 * (1 + 1e-9)) << "tick " << tick;
  }
}

TEST(WaveTest, TheImpedanceKeepsAStageWithItsLagPassiveOnTheStiffestTissue) {
  WaveConfig config;
  PatientDevices devices;
  EXPECT_GE(wave_impedance(config, devices),
            config.stiffness_expected * (devices.stage.lag + devices.sensor.lag));
  config.stiffness_expected = 10;
  EXPECT_EQ(wave_impedance(config, devices), 5);
  config.stiffness_expected = 5000;
  EXPECT_EQ(wave_impedance(config, devices), 15);
  config.impedance = 2;
  EXPECT_EQ(wave_impedance(config, devices), 2);
}

TEST(WaveTest, TheHandTakesTheImpedanceOfTheStageThatItMeets) {
  // In free air the hand feels b v: half the lag above the least impedance, so much less of it.
  const auto drag = [](const PatientDevices& met) {
    SurgeonCoupling law{WaveSurgeon{{}}};
    meet(law, met);
    begin_epoch(law, 0);
    SurgeonInput in;
    in.state = SiteState::Engaged;
    double force = 0;
    for (int i = 1; i <= 100; ++i) {
      in.position = i * 1e-4;
      force = step(law, in, std::chrono::milliseconds{1}).force;
    }
    return force;
  };
  PatientDevices quick;
  quick.stage.lag = 8e-3;
  const double ratio = wave_impedance({}, quick) / wave_impedance({}, {});
  EXPECT_LT(ratio, 0.8);
  EXPECT_NEAR(drag(quick), ratio * drag({}), 1e-9);
}

TEST(WaveTest, BothPortsCarryThePowerOfTheirWaves) {
  // F v = (u^2 - w^2)/2, as the sums of one tick show.
  WaveConfig config;
  config.impedance = 10;
  WaveSurgeon surgeon{config};
  surgeon.begin_epoch(0);
  SurgeonInput in;
  in.state = SiteState::Engaged;
  double speed = 0;
  double force = 0;
  double energy_before = 0;
  double energy = 0;
  for (int tick = 0; tick < 400; ++tick) {
    in.position = 0.02 * kPeriod * tick;
    const SurgeonOutput out = surgeon.step(in, std::chrono::milliseconds{1});
    energy_before = energy;
    energy = std::get<WavePayload>(out.to_patient.payload).wave_energy;
    force = out.force;
    speed = 0.02;
  }
  // Nothing came back: all of F v leaves as u^2/2.
  EXPECT_NEAR(force * speed * kPeriod, energy - energy_before, 1e-9);
  EXPECT_NEAR(force, 10 * 0.02, 1e-6) << "drag is b v";
}

/// What a surgeon's half gives a hand that stands still, while waves come and break off.
std::vector<double> forces_of_a_liar(const WaveConfig& config) {
  WaveSurgeon surgeon{config};
  surgeon.begin_epoch(0);
  std::vector<double> forces;
  WavePayload said;
  for (std::uint64_t tick = 0; tick < 2000; ++tick) {
    const double now = kPeriod * static_cast<double>(tick);
    const double wave = random_normal(7, 0, tick / 97) > 0 ? -3.0 : 3.0;
    said.wave_integral += wave * kPeriod;
    said.wave_energy += 0.5 * wave * wave * kPeriod;
    const std::array arrived{wave_sample(tick, said, now)};
    SurgeonInput in;
    in.now = TimePoint{from_seconds(now)};
    in.state = SiteState::Engaged;
    in.force_applied = forces.empty() ? 0 : forces.back();
    if (tick % 300 < 200) in.arrived = arrived;
    forces.push_back(surgeon.step(in, std::chrono::milliseconds{1}).force);
  }
  return forces;
}

TEST(WaveTest, NoNewsAndNoPauseOfItIsAKickForAHandThatStandsStill) {
  const std::vector<double> forces = forces_of_a_liar({});
  EXPECT_GT(*std::ranges::max_element(forces), 0.8) << "the waves are felt";
  for (std::size_t tick = 1; tick < forces.size(); ++tick) {
    ASSERT_LE(std::abs(forces[tick] - forces[tick - 1]), ToldForceConfig{}.slew * kPeriod + 1e-12)
        << tick;
  }
}

TEST(WaveTest, AtTheTipNoMorePowerGoesIntoTheTissueThanTheWavesBring) {
  for (const int trip_ms : {0, 70, 500}) {
    WaveConfig config;
    WavePatient patient{config};
    patient.begin_epoch(0);
    WavePayload said;
    WavePayload back;
    double target = 0;
    for (std::uint64_t tick = 0; tick < 2000; ++tick) {
      const double wave = 0.1 * random_normal(5, 0, tick / 20);
      said.wave_integral += wave * kPeriod;
      said.wave_energy += 0.5 * wave * wave * kPeriod;
      const double now = kPeriod * static_cast<double>(tick);
      const std::array arrived{wave_sample(tick, said, now)};
      PatientInput in;
      in.now = TimePoint{from_seconds(now)};
      in.state = SiteState::Engaged;
      in.contact_force = 0.05 + random_uniform(5, 1, tick / 30);
      in.arrived = arrived;
      in.round_trip = std::chrono::milliseconds{trip_ms};
      const PatientOutput out = patient.step(in, std::chrono::milliseconds{1});
      const auto sent = std::get<WavePayload>(out.to_surgeon.payload);
      const double returned = sent.wave_energy - back.wave_energy;
      const double given = in.contact_force * (out.target_position - target);
      if (tick > 0) {
        ASSERT_LE(given + returned, 0.5 * wave * wave * kPeriod + 1e-12)
            << trip_ms << " ms, tick " << tick;
      }
      back = sent;
      target = out.target_position;
    }
  }
}

/// Stage and spring behind a path of `half` ticks each way; the hand is moved to 4 mm and held.
double stiffness_over(int half, double tissue) {
  WaveConfig config;
  config.impedance = 10;
  WaveSurgeon surgeon{config};
  WavePatient patient{config};
  surgeon.begin_epoch(0);
  patient.begin_epoch(0);
  std::vector<PortSample> up;
  std::vector<PortSample> down;
  double tip = 0;
  double force = 0;
  const auto incoming = [half](const std::vector<PortSample>& line, int tick) {
    Incoming one;
    const auto sent = static_cast<std::size_t>(std::max(0, tick - half));
    one.sample = line[std::min(sent, line.size() - 1)];
    one.number = sent;
    one.fresh = true;
    one.sent_at = PeerTimePoint{std::chrono::milliseconds{sent}};
    one.arrived_at = TimePoint{std::chrono::milliseconds{tick}};
    return std::array{one};
  };
  double hand = 0;
  for (int tick = 0; tick < 30'000; ++tick) {
    const TimePoint now{std::chrono::milliseconds{tick}};
    hand = std::min(4e-3, 4e-3 * tick / 2000);
    SurgeonInput at_hand;
    at_hand.now = now;
    at_hand.state = SiteState::Engaged;
    at_hand.position = hand;
    const auto to_hand = down.empty() ? std::array{Incoming{}} : incoming(down, tick);
    if (!down.empty() && tick >= half) at_hand.arrived = to_hand;
    const SurgeonOutput out = surgeon.step(at_hand, std::chrono::milliseconds{1});
    up.push_back(out.to_patient);
    force = out.force;
    PatientInput at_tip;
    at_tip.now = now;
    at_tip.state = SiteState::Engaged;
    at_tip.position = tip;
    at_tip.contact_force = std::max(0.0, tissue * tip);
    const auto to_tip = incoming(up, tick);
    if (tick >= half) at_tip.arrived = to_tip;
    const PatientOutput moved = patient.step(at_tip, std::chrono::milliseconds{1});
    down.push_back(moved.to_surgeon);
    tip = moved.target_position;
  }
  return force / hand;
}

TEST(WaveTest, ADelayIsASpringInSeries) {
  // k = k_e/(1 + k_e RTT/(2b)): over an even path play-out adds nothing to the round trip.
  constexpr double kTissue = 173;
  for (const int half : {50, 250}) {
    const double trip = 2e-3 * half;
    const double felt = stiffness_over(half, kTissue);
    EXPECT_NEAR(felt, kTissue / (1 + kTissue * trip / 20), 0.01);
  }
}

}  // namespace
}  // namespace palp::coupling
