#include "lab/run/two_port.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <numbers>
#include <span>

#include "common/core/conventions.h"

namespace palp::lab {
namespace {

using namespace std::complex_literals;

constexpr double kPeriod = 1e-3;               // [s]
constexpr double kDepth = 3 * kMillimetre;     // of the swing in the tissue
constexpr double kAir = -10 * kMillimetre;     // and in the air
constexpr double kTapDepth = 4 * kMillimetre;  // of the taps before
constexpr double kTapTime = 0.8;               // [s], of one
constexpr int kTaps = 3;
constexpr double kMoveTime = 1;           // [s], to where the swing is
constexpr double kSettle = 2;             // [s], of the swing, and eight round trips
constexpr double kMeasured = 1;           // [s], at least, in whole swings
constexpr double kForceAmplitude = 0.05;  // [N], on the tip

/// The stage as the simulated one: a servo of the second order, at the facts' lag.
class Servo {
 public:
  explicit Servo(double position) noexcept : position_{position} {}
  void move(double target) noexcept {
    constexpr int kSteps = 10;
    constexpr double kDt = kPeriod / kSteps;
    constexpr double kOmega = 2 * std::numbers::pi * 20;
    for (int i = 0; i < kSteps; ++i) {
      velocity_ += kDt * (kOmega * kOmega * (target - position_) - 1.8 * kOmega * velocity_);
      position_ += kDt * velocity_;
    }
  }
  [[nodiscard]] double position() const noexcept { return position_; }
  [[nodiscard]] double velocity() const noexcept { return velocity_; }

 private:
  double position_;    ///< [m]
  double velocity_{};  ///< [m/s]
};

/// What the laws are told of the devices: the transducer has neither steps nor noise.
constexpr PatientDevices kDevices{.sensor = {.step = 0, .noise = 0}};

/// The transducer as the simulated one: its pole, without noise and steps.
class Transducer {
 public:
  double read(double force) noexcept {
    const double share = 1 - std::exp(-2 * std::numbers::pi * kDevices.sensor.pole * kPeriod);
    value_ += share * (force - value_);
    return value_;
  }

 private:
  double value_{};  ///< [N]
};

/// One way of the path.
class Way {
 public:
  explicit Way(double delay) : ticks_{static_cast<std::size_t>(std::lround(delay / kPeriod))} {}
  void send(const PortSample& sample, TimePoint now) {
    ++number_;
    Incoming one{.sample = sample,
                 .number = number_,
                 .fresh = true,
                 .repaired = false,
                 .sent_at = PeerTimePoint{now.time_since_epoch()},
                 .arrived_at = now + static_cast<std::int64_t>(ticks_) * from_seconds(kPeriod)};
    under_way_.push_back(one);
  }
  /// What is there now; valid until the next.
  std::span<const Incoming> receive(TimePoint now) {
    arrived_.clear();
    while (!under_way_.empty() && under_way_.front().arrived_at <= now) {
      arrived_.push_back(under_way_.front());
      under_way_.pop_front();
    }
    return arrived_;
  }

 private:
  std::size_t ticks_;
  std::uint64_t number_{};
  std::deque<Incoming> under_way_;
  std::vector<Incoming> arrived_;
};

/// Of one tick, at both ports.
struct Ports {
  double time{};           ///< [s], since the start
  double hand{};           ///< [m]
  double hand_velocity{};  ///< [m/s]
  double hand_force{};     ///< [N]
  double tip_velocity{};   ///< [m/s]
  double contact_force{};  ///< [N], true
};

/// Both halves, the path between them, and the stage.
class Loop {
 public:
  Loop(const TwoPortSetup& setup, double begins_at)
      : round_trip_{from_seconds(setup.round_trip)},
        surgeon_{coupling::make_surgeon_coupling(setup.coupling).value()},
        patient_{coupling::make_patient_coupling(setup.coupling, kDevices).value()},
        up_{0.5 * setup.round_trip},
        down_{0.5 * setup.round_trip},
        stage_{begins_at},
        hand_{begins_at} {
    coupling::meet(surgeon_, kDevices);
    coupling::begin_epoch(surgeon_, begins_at);
    coupling::begin_epoch(patient_, begins_at);
  }

  /// The hand goes to `hand` [m]; `force_at`: [N] on the tip at a position [m].
  Ports step(double hand, const std::function<double(double)>& force_at) {
    now_ += from_seconds(kPeriod);
    Ports ports{.time = seconds(now_.time_since_epoch()),
                .hand = hand,
                .hand_velocity = (hand - hand_) / kPeriod};
    hand_ = hand;
    const auto to_hand = coupling::step(surgeon_,
                                        {.now = now_,
                                         .state = SiteState::Engaged,
                                         .position = hand,
                                         .velocity = ports.hand_velocity,
                                         .force_applied = force_,
                                         .arrived = down_.receive(now_),
                                         .round_trip = round_trip_},
                                        from_seconds(kPeriod));
    force_ = ports.hand_force = to_hand.force;
    up_.send(to_hand.to_patient, now_);
    ports.contact_force = force_at(stage_.position());
    ports.tip_velocity = stage_.velocity();
    const auto to_tip = coupling::step(patient_,
                                       {.now = now_,
                                        .state = SiteState::Engaged,
                                        .position = stage_.position(),
                                        .velocity = stage_.velocity(),
                                        .contact_force = transducer_.read(ports.contact_force),
                                        .arrived = up_.receive(now_),
                                        .round_trip = round_trip_},
                                       from_seconds(kPeriod));
    stage_.move(to_tip.target_position);
    down_.send(to_tip.to_surgeon, now_);
    return ports;
  }

 private:
  Duration round_trip_;
  coupling::SurgeonCoupling surgeon_;
  coupling::PatientCoupling patient_;
  Way up_;
  Way down_;
  Servo stage_;
  Transducer transducer_;
  double hand_;     ///< [m], of the last tick
  double force_{};  ///< [N], likewise
  TimePoint now_{};
};

/// The share of one frequency in what passes by, over whole swings.
class Component {
 public:
  explicit Component(double frequency) noexcept : omega_{2 * std::numbers::pi * frequency} {}
  void add(double value, double time) { sum_ += value * std::exp(-1i * (omega_ * time)); }
  [[nodiscard]] std::complex<double> value() const noexcept { return sum_; }

 private:
  double omega_;  ///< [rad/s]
  std::complex<double> sum_;
};

struct Components {
  std::complex<double> hand_velocity;
  std::complex<double> hand_force;
  std::complex<double> tip_velocity;
  std::complex<double> contact_force;
};

/// A swing of hand or force of one frequency: until it is the same again, then over whole swings.
template <class Step>
Components measure(const TwoPortSetup& setup, const Step& step) {
  const double settle = kSettle + 8 * setup.round_trip;
  const auto swings = std::ceil(kMeasured * setup.frequency);
  const auto first = static_cast<int>(std::ceil(settle / kPeriod));
  const auto ticks = static_cast<int>(std::lround(swings / setup.frequency / kPeriod));
  Component hand{setup.frequency};
  Component felt{setup.frequency};
  Component tip{setup.frequency};
  Component contact{setup.frequency};
  for (int i = 0; i < first + ticks; ++i) {
    const double time = kPeriod * i;
    const Ports ports = step(std::sin(2 * std::numbers::pi * setup.frequency * time));
    if (i < first) continue;
    hand.add(ports.hand, time);
    felt.add(ports.hand_force, time);
    tip.add(ports.tip_velocity, time);
    contact.add(ports.contact_force, time);
  }
  const std::complex<double> rate = 1i * (2 * std::numbers::pi * setup.frequency);
  return {rate * hand.value(), felt.value(), tip.value(), contact.value()};
}

double free_air(double /*position*/) { return 0; }

}  // namespace

Impedance transmitted_impedance(const TwoPortSetup& setup, double stiffness) {
  Loop loop{setup, kAir};
  const auto tissue = [stiffness](double tip) { return stiffness * std::max(0.0, tip); };
  double middle = kAir;
  if (stiffness > 0) {
    const auto go = [&](double from, double to, double time) {
      const int ticks = static_cast<int>(time / kPeriod);
      for (int i = 1; i <= ticks; ++i) {
        const double share = 0.5 - 0.5 * std::cos(std::numbers::pi * i / ticks);
        (void)loop.step(from + share * (to - from), tissue);
      }
    };
    for (int i = 0; i < kTaps; ++i) {
      go(kAir, kTapDepth, 0.5 * kTapTime);
      go(kTapDepth, kAir, 0.5 * kTapTime);
      go(kAir, kAir, kTapTime + 2 * setup.round_trip);
    }
    middle = kDepth;
    go(kAir, middle, kMoveTime);
  }
  const Components found = measure(
      setup, [&](double swing) { return loop.step(middle + setup.amplitude * swing, tissue); });
  return found.hand_force / found.hand_velocity;
}

HybridMatrix hybrid_matrix(const TwoPortSetup& setup) {
  Loop moved{setup, kAir};
  const Components by_hand = measure(
      setup, [&](double swing) { return moved.step(kAir + setup.amplitude * swing, free_air); });
  Loop pushed{setup, kAir};
  const Components by_force = measure(setup, [&](double swing) {
    return pushed.step(kAir, [swing](double /*position*/) { return kForceAmplitude * swing; });
  });
  return {.h11 = by_hand.hand_force / by_hand.hand_velocity,
          .h12 = by_force.hand_force / by_force.contact_force,
          .h21 = -by_hand.tip_velocity / by_hand.hand_velocity,
          .h22 = -by_force.tip_velocity / by_force.contact_force};
}

bool AbsoluteStability::holds(double tolerance) const noexcept {
  return hand >= -tolerance && tissue >= -tolerance && margin >= 1 - tolerance;
}

AbsoluteStability absolute_stability(const HybridMatrix& of) noexcept {
  const std::complex<double> across = of.h12 * of.h21;
  return {.hand = of.h11.real(),
          .tissue = of.h22.real(),
          .margin = (2 * of.h11.real() * of.h22.real() - across.real()) / std::abs(across)};
}

bool is_linear(std::string_view coupling) noexcept {
  return coupling == "direct" || coupling == "wave";
}

}  // namespace palp::lab
