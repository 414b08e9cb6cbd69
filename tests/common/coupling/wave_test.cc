#include "common/coupling/wave.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/core/random.h"
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
  EXPECT_GE(wave_impedance(config), config.stiffness_expected * config.stage_lag);
  config.stiffness_expected = 10;
  EXPECT_EQ(wave_impedance(config), 5);
  config.stiffness_expected = 5000;
  EXPECT_EQ(wave_impedance(config), 15);
  config.impedance = 2;
  EXPECT_EQ(wave_impedance(config), 2);
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
  // k = k_e/(1 + k_e RTT/(2b)) with RTT the path's and the play-out's few ticks of buffer.
  constexpr double kTissue = 173;
  for (const int half : {50, 250}) {
    const double trip = 2e-3 * half;
    const double felt = stiffness_over(half, kTissue);
    EXPECT_LT(felt, kTissue / (1 + kTissue * trip / 20)) << "the buffers make it softer still";
    EXPECT_GT(felt, kTissue / (1 + kTissue * (trip + 12e-3) / 20));
  }
}

}  // namespace
}  // namespace palp::coupling
