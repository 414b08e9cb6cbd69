/// The sets of scenarios by which couplings are judged.
#include <array>
#include <string_view>

#include "lab/plan/gesture_set.h"
#include "lab/plan/plan.h"
#include "lab/plan/random_sets.h"
#include "lab/plan/set_case.h"

namespace palp::lab {
namespace {

SetDraw all_bad(double round_trip) {
  return {
      .round_trip = round_trip, .jitter = 0.3, .loss = 0.05, .burst_rate = 0.2, .duplicate = 0.05};
}

void fill_table(Plan& plan, const PlanAsk& ask) {
  for (const double ms : {0, 2, 5, 10, 20, 50, 100, 200, 500, 1000}) {
    add_case(plan, ask.seed, {.round_trip = ms * 1e-3}, ask);
  }
}

void fill_net(Plan& plan, const PlanAsk& ask) {
  for (const double ms : {20, 100, 500}) {
    const double rtt = ms * 1e-3;
    const std::array<SetDraw, 7> links{SetDraw{.round_trip = rtt},
                                       SetDraw{.round_trip = rtt, .jitter = 0.1},
                                       SetDraw{.round_trip = rtt, .jitter = 0.3},
                                       SetDraw{.round_trip = rtt, .loss = 0.01},
                                       SetDraw{.round_trip = rtt, .loss = 0.05},
                                       SetDraw{.round_trip = rtt, .burst_rate = 0.2},
                                       all_bad(rtt)};
    for (const SetDraw& link : links) {
      for (std::uint64_t k = 0; k < 5; ++k) add_case(plan, ask.seed + k, link, ask);
    }
  }
}

void fill_grips(Plan& plan, const PlanAsk& ask) {
  for (const std::string_view grip : kSetGrips) {
    for (const double servo : {10, 20, 30}) {
      for (const double ms : {0, 100, 500}) {
        add_case(plan, ask.seed, {.round_trip = ms * 1e-3, .grip = grip, .servo = servo}, ask);
      }
    }
  }
}

void fill_inclusions(Plan& plan, const PlanAsk& ask) {
  for (const double depth : {5, 10, 15, 25}) {
    for (const double ms : {100, 500}) {
      for (SetDraw draw : {SetDraw{.round_trip = ms * 1e-3}, all_bad(ms * 1e-3)}) {
        draw.inclusion = depth;
        for (std::uint64_t k = 0; k < 5; ++k) add_case(plan, ask.seed + k, draw, ask);
      }
    }
  }
}

void fill_blackout(Plan& plan, const PlanAsk& ask) {
  plan.blackout = true;
  for (const double ms : {20, 100, 500}) add_case(plan, ask.seed, {.round_trip = ms * 1e-3}, ask);
}

void fill_breath(Plan& plan, const PlanAsk& ask) {
  constexpr std::uint64_t kSeeds = 5;
  for (std::uint64_t k = 0; k < 6 * kSeeds; ++k) {
    constexpr std::array kTrips{0.0, 20.0, 50.0, 100.0, 200.0, 500.0};
    add_case(plan, ask.seed + k / 6, {.round_trip = kTrips[k % 6] * 1e-3}, ask);
    auto& settings = plan.cases.back().settings;
    settings.push_back({"patient.simulated_phantom.breathing_mm", "1"});
    settings.push_back({"patient.simulated_phantom.breathing_hz", "0.25"});
    settings.push_back({"surgeon.hand.master", "script:breath"});
  }
}

void fill_long(Plan& plan, const PlanAsk& ask) {
  add_case(plan, ask.seed, all_bad(0.5), ask);
  plan.cases.back().settings.push_back({"surgeon.hand.master", "script:long"});
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
    Set{"wild", "tissues and gestures drawn at random over the links and hands of mc", fill_wild},
    Set{"first", "first presses that are held, of tissues drawn at random", fill_first},
    Set{"gestures", "taps, presses and drags, five round trips, four grips", fill_gestures},
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
    plan.label_names = set_labels();
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
  sets.reserve(std::size(kSets));
  for (const Set& set : kSets) sets.push_back({std::string{set.name}, std::string{set.means}});
  return sets;
}

Plan make_map(const PlanAsk& ask) {
  Plan plan;
  plan.name = "map";
  plan.seed = ask.seed;
  plan.coupling = "direct";
  plan.tissue = ask.tissue;
  plan.label_names = set_labels();
  plan.label_names.insert(plan.label_names.begin(), "k_p_n_per_m");
  for (const std::string_view grip : kSetGrips) {
    for (const double spring : {0, 25, 50, 100, 200, 400, 800, 1600}) {
      for (const double ms : {0, 2, 5, 10, 20, 30, 50, 70, 100, 150, 200, 300, 500, 1000}) {
        PlanAsk direct = ask;
        direct.coupling = "direct";
        add_case(plan, ask.seed, {.round_trip = ms * 1e-3, .grip = grip}, direct);
        Case& one = plan.cases.back();
        one.settings.push_back({"coupling.direct.spring_n_per_m", nine_digit_text(spring)});
        one.labels.insert(one.labels.begin(), nine_digit_text(spring));
      }
    }
  }
  plan.count = plan.cases.size();
  return plan;
}

}  // namespace palp::lab
