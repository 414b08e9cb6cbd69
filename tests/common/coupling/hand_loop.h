#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "common/core/random.h"
#include "common/coupling/coupling.h"

/// A hand at a device that renders a law: the independent probe of the law's energy. Integrates
/// in steps of 0.1 ms and books the work of the hand from its own states.
namespace palp::coupling::hand_loop {

struct Hand {
  double mass{0.115};      ///< [kg]
  double damping{4};       ///< [N s/m]
  double stiffness{300};   ///< [N/m]
  double position{-3e-3};  ///< [m]
  double velocity{};       ///< [m/s]
  double work{};           ///< [J], of the hand on the device
  double work_min{};       ///< [J]

  void live(double intent, double force) {
    constexpr double kStep = 1e-4;
    for (int i = 0; i < 10; ++i) {
      const double pull = stiffness * (intent - position) - damping * velocity;
      velocity += kStep * (pull - force - 0.05 * velocity) / mass;
      position += kStep * velocity;
      work += force * velocity * kStep;
      work_min = std::min(work_min, work);
    }
  }
};

/// Random models, another one every 50 ms or so, some of them broken, some old.
class Liar {
 public:
  explicit Liar(std::uint64_t seed) : seed_{seed} {}
  Incoming tell(std::uint64_t tick) {
    const std::uint64_t lie = tick / 50;
    const auto uniform = [&](std::uint64_t which) { return random_uniform(seed_, which, lie); };
    ModelPayload model;
    model.version = static_cast<std::uint32_t>(lie + 1);
    model.surface = 3e-3 * (2 * uniform(0) - 1);
    model.c = {0.1 * uniform(12),
               0.3 * uniform(1),
               0.1 * uniform(2),
               0.02 * uniform(3),
               1e-4 * uniform(4)};
    for (std::size_t k = 0; k < kModelKnots.size(); ++k) model.stiffness[k] = 600 * uniform(20 + k);
    model.depth_max = 5e-3;
    model.swing = 2e-3 * (2 * uniform(5) - 1);
    model.swing_quadrature = 2e-3 * (2 * uniform(6) - 1);
    model.swing_rate = 10 * uniform(7);
    model.relaxing = {0.3 * uniform(8), 0.3 * uniform(9)};
    if (uniform(10) < 0.1) model.c[0] = std::nan("");
    if (uniform(11) < 0.1) model.version = 1;
    Incoming incoming;
    incoming.sample.payload = model;
    incoming.number = tick;
    incoming.fresh = true;
    return incoming;
  }

 private:
  std::uint64_t seed_;
};

struct Outcome {
  double taken{};      ///< [J], most energy the hand ever had from the device
  double step_max{};   ///< [N], worst change of force in 10 ms
  double force_max{};  ///< [N]
};

/// 10 s of a hand that presses in and out, with changing tempo, against a lying patient site.
template <class Law>
Outcome press_against_lies(Law law, std::uint64_t seed, double cap = 8.5) {
  Hand hand;
  Liar liar{seed};
  std::array<double, 10> past{};
  Outcome outcome;
  double force = 0;
  constexpr double kEncoder = 0.03e-3;
  law.begin_epoch(kEncoder * std::round(hand.position / kEncoder));
  for (std::uint64_t tick = 0; tick < 10'000; ++tick) {
    const double t = 1e-3 * static_cast<double>(tick);
    const double tempo = 2 + 6 * random_uniform(seed, 50, tick / 1000);
    const double intent = 2e-3 + 4e-3 * std::sin(tempo * t);
    hand.live(intent, force);
    const std::array arrived{liar.tell(tick)};
    SurgeonInput in;
    in.state = SiteState::Engaged;
    in.position = kEncoder * std::round(hand.position / kEncoder);
    in.force_applied = force;
    in.arrived = tick % 3 == 0 ? std::span<const Incoming>{arrived} : std::span<const Incoming>{};
    in.round_trip = std::chrono::milliseconds{100};
    force = std::clamp(law.step(in, std::chrono::milliseconds{1}).force, -cap, cap);
    double& before = past[tick % past.size()];
    outcome.step_max = std::max(outcome.step_max, std::abs(force - before));
    before = force;
    outcome.force_max = std::max(outcome.force_max, std::abs(force));
  }
  outcome.taken = -hand.work_min;
  return outcome;
}

}  // namespace palp::coupling::hand_loop
