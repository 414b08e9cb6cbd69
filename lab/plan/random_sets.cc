#include "lab/plan/random_sets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <span>
#include <utility>

#include "common/core/formatted.h"
#include "common/core/random.h"
#include "lab/plan/set_case.h"

namespace palp::lab {
namespace {

constexpr std::uint64_t kCaseStream = 0x6d6f'6e74'6500'0000ULL;  ///< "monte": draws of a case

template <std::size_t N>
double pick(const std::array<double, N>& values, double uniform) {
  return values[std::min(N - 1, static_cast<std::size_t>(uniform * N))];
}

std::uint64_t case_seed(std::uint64_t seed, std::uint64_t index) {
  return random_bits(seed, kCaseStream + 99, index) >> 12U;
}

/// Case `index` of the random sets.
SetDraw draw_case(std::uint64_t seed, std::uint64_t index, bool hard) {
  const auto uniform = [&](std::uint64_t which) {
    return random_uniform(seed, kCaseStream + which, index);
  };
  SetDraw draw;
  const double decades = hard ? 3 + std::log10(2.0) : 3;
  draw.round_trip = 1e-3 * std::pow(10.0, decades * uniform(0));
  draw.jitter = pick(std::array{0.0, 0.1, 0.3}, uniform(1));
  draw.loss = hard ? 0.2 : pick(std::array{0.0, 0.01, 0.05}, uniform(2));
  draw.burst_rate = pick(std::array{0.0, 0.1, 0.3}, uniform(3));
  draw.burst_length = hard ? 1.0 : 0.2;
  draw.duplicate = pick(std::array{0.0, 0.05}, uniform(4));
  draw.grip = kSetGrips[static_cast<std::size_t>(4 * uniform(5))];
  draw.servo = pick(std::array{10.0, 20.0, 30.0}, uniform(6));
  draw.inclusion = pick(std::array{5.0, 10.0, 15.0}, uniform(7));
  return draw;
}

constexpr bool is_pause(FaultKind kind) {
  return kind == FaultKind::PauseSurgeon || kind == FaultKind::PausePatient;
}

/// Every other one in a burst.
void draw_pauses(Fault& fault, double uniform, double gap) {
  if (uniform < 0.5) return;
  fault.count = 2 + static_cast<std::uint32_t>(20 * (uniform - 0.5) * 2);
  fault.apart = from_seconds(1e-3 * std::floor(std::pow(10.0, 3 * gap)));
}

/// One fault in each case, of every kind there is in `kinds`, place and size, over the links and
/// hands of `mc`.
void fill_with(std::span<const FaultKind> kinds, Plan& plan, const PlanAsk& ask) {
  fill_random(plan, ask, false);
  plan.label_names.insert(plan.label_names.end(), {"fault", "place", "amount_s"});
  for (Case& one : plan.cases) {
    const auto uniform = [&](std::uint64_t which) {
      return random_uniform(ask.seed, kCaseStream + 20 + which, one.index);
    };
    const auto kind_count = static_cast<double>(kinds.size());
    one.fault.kind = kinds[static_cast<std::size_t>(uniform(0) * kind_count)];
    one.fault_place = kFaultPlaces[static_cast<std::size_t>(uniform(1) * kFaultPlaces.size())];
    double amount = pick(std::array{0.05, 0.3, 1.0, 5.0, 40.0}, uniform(2));
    if (one.fault.kind == FaultKind::LiftPedal)
      amount = pick(std::array{0.002, 0.05, 1.0}, uniform(2));
    const bool clock = one.fault.kind == FaultKind::StepSurgeonClock ||
                       one.fault.kind == FaultKind::StepPatientClock;
    if (clock && uniform(3) < 0.5) amount = -amount;
    if (is_pause(one.fault.kind)) {
      amount = pick(std::array{0.002, 0.01, 0.04, 0.3, 5.0}, uniform(2));
      draw_pauses(one.fault, uniform(4), uniform(5));
    }
    one.fault.amount = from_seconds(amount);
    one.settings.push_back({"duration_s", "600"});
    one.labels.insert(one.labels.end(),
                      {std::string{to_string(one.fault.kind)},
                       std::string{one.fault_place},
                       nine_digit_text(amount)});
  }
}

}  // namespace

void fill_random(Plan& plan, const PlanAsk& ask, bool hard) {
  for (std::uint64_t index = 0; index < ask.count; ++index) {
    const std::uint64_t seed = case_seed(ask.seed, index);
    add_case(plan, seed, draw_case(ask.seed, index, hard), ask);
  }
}

void fill_faults(Plan& plan, const PlanAsk& ask) {
  constexpr std::array kKinds{FaultKind::KillSurgeon,
                              FaultKind::KillPatient,
                              FaultKind::StepSurgeonClock,
                              FaultKind::StepPatientClock,
                              FaultKind::LiftPedal,
                              FaultKind::PauseSurgeon,
                              FaultKind::PausePatient};
  fill_with(kKinds, plan, ask);
}

void fill_device_faults(Plan& plan, const PlanAsk& ask) { fill_with(kDeviceFaults, plan, ask); }

/// Of 1 ms to 5 s, of either process, alone and in bursts, at any moment; every other peer lies.
void fill_pauses(Plan& plan, const PlanAsk& ask) {
  fill_random(plan, ask, false);
  plan.label_names.insert(plan.label_names.end(),
                          {"fault", "place_share", "amount_s", "count", "apart_s", "peer"});
  for (Case& one : plan.cases) {
    const auto uniform = [&](std::uint64_t which) {
      return random_uniform(ask.seed, kCaseStream + 40 + which, one.index);
    };
    Fault& fault = one.fault;
    fault.kind = uniform(0) < 0.7 ? FaultKind::PauseSurgeon : FaultKind::PausePatient;
    fault.amount = from_seconds(1e-3 * std::floor(std::pow(10.0, std::log10(5000.0) * uniform(1))));
    draw_pauses(fault, uniform(2), uniform(3));
    one.fault_share = uniform(4);
    one.lying = uniform(5) < 0.5;
    one.settings.push_back({"duration_s", "600"});
    one.labels.insert(one.labels.end(),
                      {std::string{to_string(fault.kind)},
                       nine_digit_text(std::round(1e4 * one.fault_share) / 1e4),
                       nine_digit_text(seconds(fault.amount)),
                       std::to_string(fault.count),
                       nine_digit_text(seconds(fault.apart)),
                       one.lying ? "lying" : "honest"});
  }
}

/// Paces, lags and steps of all three devices, over the links and hands of `mc`.
void fill_devices(Plan& plan, const PlanAsk& ask) {
  fill_random(plan, ask, false);
  for (const char* label :
       {"hand_hz", "hand_lag_ms", "stage_hz", "stage_lag_ms", "sensor_hz", "sensor_lag_ms"}) {
    plan.label_names.emplace_back(label);
  }
  for (Case& one : plan.cases) {
    std::uint64_t which = kCaseStream + 60;
    const auto draw = [&](const auto& values) {
      return pick(values, random_uniform(ask.seed, which++, one.index));
    };
    const auto set = [&one](const std::string& path, double value) {
      one.settings.push_back({path, nine_digit_text(value)});
    };
    const double jitter = draw(std::array{0.0, 0.1, 0.3});  // [-], of a period
    for (const std::string device : {"hand_device.", "stage_device.", "sensor_device."}) {
      const double rate = draw(std::array{50.0, 100.0, 200.0, 500.0, 1000.0});
      const double lag = draw(std::array{0.0, 2.0, 5.0, 10.0, 20.0, 30.0});
      set(device + "rate_hz", rate);
      set(device + "lag_ms", lag);
      set(device + "jitter_ms", jitter * 1e3 / rate);
      one.labels.insert(one.labels.end(), {nine_digit_text(rate), nine_digit_text(lag)});
    }
    set("patient.simulated_phantom.sensor_quantum_mn", draw(std::array{1.0, 10.0, 50.0, 100.0}));
    set("patient.simulated_phantom.encoder_um", draw(std::array{1.0, 10.0, 50.0}));
    set("surgeon.hand.encoder_um", draw(std::array{1.0, 30.0, 100.0}));
  }
}

/// First presses that are held, of tissues that nobody chose; every fifth of a ball or beside it.
void fill_first(Plan& plan, const PlanAsk& ask) {
  plan.direct_touch = true;
  plan.label_names.insert(plan.label_names.end(), {"depth_mm", "press_s", "site", "drawn"});
  for (std::uint64_t index = 0; index < ask.count; ++index) {
    const auto uniform = [&](std::uint64_t which) {
      return random_uniform(ask.seed, kCaseStream + 110 + which, index);
    };
    SetDraw draw = draw_case(ask.seed, index, false);
    draw.round_trip = 0.5 * uniform(0);
    draw.burst_rate = 0;
    const std::uint64_t seed = case_seed(ask.seed, index);
    add_case(plan, seed, draw, ask);
    Case& one = plan.cases.back();
    const bool ball = uniform(1) >= 0.8;
    const bool over = ball && uniform(2) < 0.5;
    const std::string paper = formatted("paper-%.0fmm", draw.inclusion);
    const std::string drawn = ball ? paper : std::to_string(seed);
    const std::string phantom = ball ? paper : "random:" + drawn;
    one.settings.push_back({"patient.simulated_phantom.phantom", phantom});
    one.settings.push_back(
        {"patient.simulated_phantom.viscous_s_per_m", nine_digit_text(uniform(3))});
    const std::string depth = nine_digit_text(2 + 3 * uniform(4));
    const std::string time = nine_digit_text(0.3 * std::pow(10.0, uniform(5)));
    one.script = "hold 1\n";
    if (over) one.script += "move to B\nhold 0.5\n";
    one.script += formatted("press %s %s 6\nlift 0.6 1\n", depth.c_str(), time.c_str());
    one.labels.insert(one.labels.end(), {depth, time, over ? "B" : "A", drawn});
  }
}

/// Tissues and gestures that nobody chose, over the links, hands and servos of `mc`; every fourth
/// surface breathes, no breath like the last one. Every second hand reacts, and every second stage
/// and sensor yields to the tissue.
void fill_wild(Plan& plan, const PlanAsk& ask) {
  fill_random(plan, ask, false);
  plan.direct_touch = true;
  const std::string tissue = "patient.simulated_phantom.";
  plan.label_names.insert(plan.label_names.end(),
                          {"drawn",
                           "viscous_s_per_m",
                           "breathing_mm",
                           "breathing_hz",
                           "breathing_variation",
                           "servo_n_per_mm",
                           "yield_um_per_n",
                           "reflex",
                           "reflex_delay_ms",
                           "co_contraction_per_n"});
  for (Case& one : plan.cases) {
    const auto uniform = [&](std::uint64_t which) {
      return random_uniform(ask.seed, kCaseStream + 80 + which, one.index);
    };
    const std::string drawn = std::to_string(one.seed);
    one.settings.push_back({tissue + "phantom", "random:" + drawn});
    one.settings.push_back({"surgeon.hand.master", "script:random:" + drawn});
    one.labels.push_back(drawn);
    const bool breathes = uniform(1) < 0.25;
    for (const auto& [name, value] :
         {std::pair{"viscous_s_per_m", uniform(0)},
          std::pair{"breathing_mm", breathes ? 0.2 + 1.3 * uniform(2) : 0},
          std::pair{"breathing_hz", breathes ? 0.15 + 0.25 * uniform(3) : 0},
          std::pair{"breathing_variation", breathes ? 0.3 * uniform(4) : 0},
          std::pair{"servo_n_per_mm", uniform(5) < 0.5 ? 10 * std::pow(10.0, uniform(6)) : 0},
          std::pair{"yield_um_per_n", uniform(5) < 0.5 ? 50 * uniform(7) : 0}}) {
      one.labels.push_back(nine_digit_text(value));
      one.settings.push_back({tissue + name, one.labels.back()});
    }
    const bool reacts = uniform(8) < 0.5;
    for (const auto& [name, value] :
         {std::pair{"reflex", reacts ? 0.5 * uniform(9) : 0},
          std::pair{"reflex_delay_ms", 20 + 130 * uniform(10)},
          std::pair{"co_contraction_per_n", reacts ? 0.5 * uniform(11) : 0}}) {
      one.labels.push_back(nine_digit_text(value));
      one.settings.push_back({std::string{"surgeon.hand."} + name, one.labels.back()});
    }
  }
}

}  // namespace palp::lab
