/// The sets of scenarios by which couplings are judged.
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <span>
#include <string_view>

#include "common/core/random.h"
#include "lab/plan/plan.h"

namespace palp::lab {
namespace {

constexpr std::uint64_t kCaseStream = 0x6d6f'6e74'6500'0000ULL;  ///< "monte": draws of a case

/// One path both ways, and who palpates what.
struct Draw {
  double round_trip{};       ///< [s]
  double jitter{};           ///< [-], standard deviation over mean
  double loss{};             ///< [-]
  double burst_rate{};       ///< [1/s]
  double burst_length{0.2};  ///< [s]
  double duplicate{};        ///< [-]
  std::string_view grip{"mid"};
  double servo{20};     ///< [Hz]
  double inclusion{5};  ///< [mm], top of it
};

const std::vector<std::string> kLabels{
    "rtt_ms", "jitter", "loss", "burst_per_s", "duplicate", "grip", "servo_hz", "inclusion_mm"};

[[gnu::format(printf, 1, 2)]] std::string text(const char* format, ...) {
  std::array<char, 240> line{};
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line.data(), line.size(), format, arguments);
  va_end(arguments);
  return line.data();
}

/// In the words of the emulator.
std::string path_words(const Draw& draw) {
  std::string words = text("delay %.9gms", draw.round_trip * 500);
  if (draw.jitter > 0) {
    words += text(" %.9gms distribution normal floor 20%% order free",
                  draw.round_trip * 500 * draw.jitter);
  }
  if (draw.loss > 0) words += text(" loss %.9g%%", draw.loss * 100);
  if (draw.burst_rate > 0) {
    words += text(" loss burst %.9g/s %.9gms", draw.burst_rate, draw.burst_length * 1e3);
  }
  if (draw.duplicate > 0) words += text(" duplicate %.9g%%", draw.duplicate * 100);
  return words;
}

std::string phantom_words(const std::string& tissue, double inclusion) {
  if (tissue == "fe") return text("paper-%.0fmm", inclusion);
  if (tissue.find(':') != std::string::npos || tissue == "none" || tissue.rfind("paper", 0) == 0) {
    return tissue;
  }
  return text("%s:%.9g", tissue.c_str(), inclusion);
}

Case make_one(std::uint64_t index, std::uint64_t seed, const Draw& draw, const PlanAsk& ask) {
  const std::string path = path_words(draw);
  Case one;
  one.index = index;
  one.seed = seed;
  one.settings = {{"coupling.name", ask.coupling},
                  {"surgeon.engagement.forced", "true"},
                  {"up.spec", path},
                  {"down.spec", path},
                  {"surgeon.hand.grip", std::string{draw.grip}},
                  {"patient.simulated_phantom.servo_hz", text("%.9g", draw.servo)},
                  {"patient.simulated_phantom.phantom", phantom_words(ask.tissue, draw.inclusion)}};
  one.labels = {text("%.9g", draw.round_trip * 1e3),
                text("%.9g", draw.jitter),
                text("%.9g", draw.loss),
                text("%.9g", draw.burst_rate),
                text("%.9g", draw.duplicate),
                std::string{draw.grip},
                text("%.9g", draw.servo),
                text("%.9g", draw.inclusion)};
  return one;
}

void add(Plan& plan, std::uint64_t seed, const Draw& draw, const PlanAsk& ask) {
  plan.cases.push_back(make_one(plan.cases.size(), seed, draw, ask));
}

constexpr std::array<std::string_view, 4> kGrips{"light", "mid", "firm", "arm"};

template <std::size_t N>
double pick(const std::array<double, N>& values, double uniform) {
  return values[std::min(N - 1, static_cast<std::size_t>(uniform * N))];
}

/// Case `index` of the random sets.
Draw draw_case(std::uint64_t seed, std::uint64_t index, bool hard) {
  const auto uniform = [&](std::uint64_t which) {
    return random_uniform(seed, kCaseStream + which, index);
  };
  Draw draw;
  const double decades = hard ? 3 + std::log10(2.0) : 3;
  draw.round_trip = 1e-3 * std::pow(10.0, decades * uniform(0));
  draw.jitter = pick(std::array{0.0, 0.1, 0.3}, uniform(1));
  draw.loss = hard ? 0.2 : pick(std::array{0.0, 0.01, 0.05}, uniform(2));
  draw.burst_rate = pick(std::array{0.0, 0.1, 0.3}, uniform(3));
  draw.burst_length = hard ? 1.0 : 0.2;
  draw.duplicate = pick(std::array{0.0, 0.05}, uniform(4));
  draw.grip = kGrips[static_cast<std::size_t>(4 * uniform(5))];
  draw.servo = pick(std::array{10.0, 20.0, 30.0}, uniform(6));
  draw.inclusion = pick(std::array{5.0, 10.0, 15.0}, uniform(7));
  return draw;
}

Draw all_bad(double round_trip) {
  return {
      .round_trip = round_trip, .jitter = 0.3, .loss = 0.05, .burst_rate = 0.2, .duplicate = 0.05};
}

void fill_random(Plan& plan, const PlanAsk& ask, bool hard) {
  for (std::uint64_t index = 0; index < ask.count; ++index) {
    const std::uint64_t seed = random_bits(ask.seed, kCaseStream + 99, index) >> 12U;
    add(plan, seed, draw_case(ask.seed, index, hard), ask);
  }
}

void fill_table(Plan& plan, const PlanAsk& ask) {
  for (const double ms : {0, 2, 5, 10, 20, 50, 100, 200, 500, 1000}) {
    add(plan, ask.seed, {.round_trip = ms * 1e-3}, ask);
  }
}

void fill_net(Plan& plan, const PlanAsk& ask) {
  for (const double ms : {20, 100, 500}) {
    const double rtt = ms * 1e-3;
    const std::array<Draw, 7> links{Draw{.round_trip = rtt},
                                    Draw{.round_trip = rtt, .jitter = 0.1},
                                    Draw{.round_trip = rtt, .jitter = 0.3},
                                    Draw{.round_trip = rtt, .loss = 0.01},
                                    Draw{.round_trip = rtt, .loss = 0.05},
                                    Draw{.round_trip = rtt, .burst_rate = 0.2},
                                    all_bad(rtt)};
    for (const Draw& link : links) {
      for (std::uint64_t k = 0; k < 5; ++k) add(plan, ask.seed + k, link, ask);
    }
  }
}

void fill_grips(Plan& plan, const PlanAsk& ask) {
  for (const std::string_view grip : kGrips) {
    for (const double servo : {10, 20, 30}) {
      for (const double ms : {0, 100, 500}) {
        add(plan, ask.seed, {.round_trip = ms * 1e-3, .grip = grip, .servo = servo}, ask);
      }
    }
  }
}

void fill_inclusions(Plan& plan, const PlanAsk& ask) {
  for (const double depth : {5, 10, 15, 25}) {
    for (const double ms : {100, 500}) {
      for (Draw draw : {Draw{.round_trip = ms * 1e-3}, all_bad(ms * 1e-3)}) {
        draw.inclusion = depth;
        for (std::uint64_t k = 0; k < 5; ++k) add(plan, ask.seed + k, draw, ask);
      }
    }
  }
}

void fill_blackout(Plan& plan, const PlanAsk& ask) {
  plan.blackout = true;
  for (const double ms : {20, 100, 500}) add(plan, ask.seed, {.round_trip = ms * 1e-3}, ask);
}

void fill_breath(Plan& plan, const PlanAsk& ask) {
  constexpr std::uint64_t kSeeds = 5;
  for (std::uint64_t k = 0; k < 6 * kSeeds; ++k) {
    constexpr std::array kTrips{0.0, 20.0, 50.0, 100.0, 200.0, 500.0};
    add(plan, ask.seed + k / 6, {.round_trip = kTrips[k % 6] * 1e-3}, ask);
    auto& settings = plan.cases.back().settings;
    settings.push_back({"patient.simulated_phantom.breathing_mm", "1"});
    settings.push_back({"patient.simulated_phantom.breathing_hz", "0.25"});
    settings.push_back({"surgeon.hand.master", "script:breath"});
  }
}

void fill_long(Plan& plan, const PlanAsk& ask) {
  add(plan, ask.seed, all_bad(0.5), ask);
  plan.cases.back().settings.push_back({"surgeon.hand.master", "script:long"});
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
                       text("%.9g", amount)});
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
                       text("%.4f", one.fault_share),
                       text("%.9g", seconds(fault.amount)),
                       text("%u", fault.count),
                       text("%.9g", seconds(fault.apart)),
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
      one.settings.push_back({path, text("%.9g", value)});
    };
    const double jitter = draw(std::array{0.0, 0.1, 0.3});  // [-], of a period
    for (const std::string device : {"hand_device.", "stage_device.", "sensor_device."}) {
      const double rate = draw(std::array{50.0, 100.0, 200.0, 500.0, 1000.0});
      const double lag = draw(std::array{0.0, 2.0, 5.0, 10.0, 20.0, 30.0});
      set(device + "rate_hz", rate);
      set(device + "lag_ms", lag);
      set(device + "jitter_ms", jitter * 1e3 / rate);
      one.labels.insert(one.labels.end(), {text("%.9g", rate), text("%.9g", lag)});
    }
    set("patient.simulated_phantom.sensor_quantum_mn", draw(std::array{1.0, 10.0, 50.0, 100.0}));
    set("patient.simulated_phantom.encoder_um", draw(std::array{1.0, 10.0, 50.0}));
    set("surgeon.hand.encoder_um", draw(std::array{1.0, 30.0, 100.0}));
  }
}

void set_for_all(Plan& plan, const Setting& setting) {
  for (Case& one : plan.cases) one.settings.push_back(setting);
}

struct Set {
  std::string_view name;
  std::string_view means;
  void (*fill)(Plan&, const PlanAsk&);
};

constexpr std::array kSets{
    Set{"table", "round trips from 0 to 1 s, clean link", fill_table},
    Set{"net", "three round trips by seven kinds of link, five seeds", fill_net},
    Set{"mc",
        "random links, grips, servos and inclusions",
        [](Plan& p, const PlanAsk& a) { fill_random(p, a, false); }},
    Set{"mc-hard",
        "the same to 2 s, 20 % loss, bursts of 1 s",
        [](Plan& p, const PlanAsk& a) { fill_random(p, a, true); }},
    Set{"mc-noise",
        "mc with 50 mN of sensor noise",
        [](Plan& p, const PlanAsk& a) {
          fill_random(p, a, false);
          set_for_all(p, {"patient.simulated_phantom.sensor_noise_mn", "50"});
        }},
    Set{"mc-adv",
        "mc with a patient site that lies",
        [](Plan& p, const PlanAsk& a) {
          fill_random(p, a, false);
          p.lying = true;
        }},
    Set{"grips", "four grips, three servos, three round trips", fill_grips},
    Set{"inc", "four depths of the inclusion, clean and bad links, five seeds", fill_inclusions},
    Set{"blackout", "2 s without a link at the end of a press", fill_blackout},
    Set{"breath", "a surface that breathes, 1 mm at 0.25 Hz", fill_breath},
    Set{"long", "ten minutes on the worst link", fill_long},
    Set{"faults", "mc with a process killed, a clock that jumps or another epoch", fill_faults},
    Set{"pauses", "mc with pauses of 1 ms to 5 s of either process, half with a liar", fill_pauses},
    Set{"device-faults",
        "mc with a sensor, a stage or a haptic device that fails",
        fill_device_faults},
    Set{"devices", "mc with devices of 50 to 1,000 Hz, lags to 30 ms, jitter, steps", fill_devices},
};

}  // namespace

Result<Plan> make_set(const std::string& name, const PlanAsk& ask) {
  for (const Set& set : kSets) {
    if (set.name != name) continue;
    Plan plan;
    plan.name = name;
    plan.seed = ask.seed;
    plan.coupling = ask.coupling;
    plan.tissue = ask.tissue;
    plan.label_names = kLabels;
    set.fill(plan, ask);
    plan.count = plan.cases.size();
    return plan;
  }
  std::string sentence = "unknown set '" + name + "'; there are:";
  for (const Set& set : kSets) sentence.append(" ").append(set.name);
  return fail(sentence);
}

std::vector<NamedChoice> described_sets() {
  std::vector<NamedChoice> sets;
  for (const Set& set : kSets) sets.push_back({std::string{set.name}, std::string{set.means}});
  return sets;
}

Plan make_map(const PlanAsk& ask) {
  Plan plan;
  plan.name = "map";
  plan.seed = ask.seed;
  plan.coupling = "direct";
  plan.tissue = ask.tissue;
  plan.label_names = kLabels;
  plan.label_names.insert(plan.label_names.begin(), "k_p_n_per_m");
  for (const std::string_view grip : kGrips) {
    for (const double spring : {0, 25, 50, 100, 200, 400, 800, 1600}) {
      for (const double ms : {0, 2, 5, 10, 20, 30, 50, 70, 100, 150, 200, 300, 500, 1000}) {
        PlanAsk direct = ask;
        direct.coupling = "direct";
        add(plan, ask.seed, {.round_trip = ms * 1e-3, .grip = grip}, direct);
        Case& one = plan.cases.back();
        one.settings.push_back({"coupling.direct.spring_n_per_m", text("%.9g", spring)});
        one.labels.insert(one.labels.begin(), text("%.9g", spring));
      }
    }
  }
  plan.count = plan.cases.size();
  return plan;
}

}  // namespace palp::lab
