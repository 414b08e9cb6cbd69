#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/core/random.h"
#include "judge/metric_table.h"
#include "lab/report/run_report.h"
#include "review/demo_report.h"
#include "review/session_metrics.h"
#include "review/taps.h"
#include "surgeon_site/script_builder.h"
#include "tests/review/lab_files.h"

/// Sessions of the lab with a script, a network and a coupling drawn by chance, judged by the lab
/// as they run and again from their files.
namespace palp::review::test {

/// Taps of alternating depth, so that no two neighbours could be taken for each other, on visits to
/// sites A and B in turn.
inline surgeon::GestureScript random_script(std::uint64_t seed, double hand_stiffness) {
  const RandomStream draws{seed, 17};
  std::uint64_t next = 0;
  const auto between = [&](double low, double high) {
    return low + (high - low) * draws.uniform(next++);
  };
  surgeon::ScriptBuilder script{hand_stiffness};
  script.hold(from_seconds(0.3));
  const auto visits = 1 + static_cast<int>(between(1, 3));
  for (int visit = 0; visit < visits; ++visit) {
    script.site(visit % 2 == 0 ? kSiteA : kSiteB).move(surgeon::kNearPlace, from_seconds(0.4));
    const auto taps = static_cast<int>(between(2, 5));
    for (int tap = 0; tap < taps; ++tap) {
      const double depth = tap % 2 == 0 ? between(2.2e-3, 2.8e-3) : between(3.8e-3, 4.6e-3);
      script.taps(1, depth, from_seconds(between(0.6, 1.2)), from_seconds(between(0.1, 0.8)));
    }
    script.lift(from_seconds(0.4), from_seconds(0.3));
  }
  return script.build();
}

inline lab::Scenario random_scenario(std::uint64_t seed) {
  const RandomStream draws{seed, 18};
  const std::vector<std::string> couplings{"wave", "tdpa", "mmt"};
  const std::string& coupling = couplings[seed % couplings.size()];
  const std::string spec = "delay " + std::to_string(1 + static_cast<int>(100 * draws.uniform(0))) +
                           "ms " + std::to_string(1 + static_cast<int>(3 * draws.uniform(1))) +
                           "ms distribution normal loss " +
                           std::to_string(static_cast<int>(3 * draws.uniform(2))) + "%";
  lab::Scenario scenario = lab_scenario({},
                                        {"seed=" + std::to_string(seed),
                                         "surgeon.coupling.name=" + coupling,
                                         "patient.coupling.name=" + coupling,
                                         "up.spec=" + spec,
                                         "down.spec=" + spec});
  scenario.script = random_script(seed, scenario.hand.plant.grip.stiffness);
  return scenario;
}

/// [m], how deep the tip really went for a tap.
inline double tip_depth(const lab::RunResult& run, const judge::TapMetrics& tap, double way) {
  double deepest = -INFINITY;
  for (const judge::RunTick& tick : run.ticks) {
    if (tick.at < tap.began_at + way || tick.at > tap.ended_at + way) continue;
    deepest = std::max(deepest, tick.tip);
  }
  return deepest;
}

inline void expect_same_taps(const nlohmann::json& lab, const nlohmann::json& review) {
  std::size_t next = 0;
  for (const nlohmann::json& tap : lab) {
    if (tap["depth"].is_null()) continue;  // the patient's site saw no stroke in it
    while (next < review.size() &&
           review[next]["force_max_n"].dump() != tap["force_max_n"].dump()) {
      ++next;
    }
    ASSERT_LT(next, review.size()) << tap.dump();
    for (const char* key : {"site",
                            "indentation_max_mm",
                            "stiffness_felt_n_per_m",
                            "stiffness_true_n_per_m",
                            "force_max_n"}) {
      EXPECT_EQ(review[next][key].dump(), tap[key].dump()) << key;
    }
    EXPECT_EQ(review[next]["depth"]["h_n"].dump(), tap["depth"]["h_n"].dump());
  }
}

/// All numbers of the lab's report and of the review's are the same to the last digit, and each
/// tap stands beside the stroke that the tip made for it.
inline void expect_same_judgement(std::uint64_t seed) {
  SCOPED_TRACE("random session " + std::to_string(seed));
  const lab::Scenario scenario = random_scenario(seed);
  LabFiles files;
  const lab::RunResult run =
      lab::simulate(scenario, {.surgeon = &files.surgeon, .patient = &files.patient});
  const nlohmann::json lab = nlohmann::json::parse(lab::run_report(scenario, run, {}));

  SessionPair pair = pair_of(load_site(files.surgeon.bytes(), "s", link::Role::Surgeon).value(),
                             load_site(files.patient.bytes(), "p", link::Role::Patient).value())
                         .value();
  const JudgedSession judged = judge_session(pair, nullptr);
  auto taps = match_taps(pair.surgeon, pair.patient, pair.time_line, judged.excursions);
  ASSERT_TRUE(judged.by_truth);
  take_truth(taps, pair, judged.run_began, judged.metrics.taps);
  const config::Json told = metrics_json(judged);
  const nlohmann::json metrics = nlohmann::json::parse(told.dump());
  for (const judge::Metric& metric : judge::metric_table()) {
    const std::string name{metric.name};
    EXPECT_EQ(metrics[name].dump(), lab[name].dump()) << name;
  }
  EXPECT_EQ(metrics["unstable"], lab["unstable"]);
  const nlohmann::json review =
      nlohmann::json::parse(demo_report(pair.surgeon, pair.patient, taps, {}, {}, {}, told));
  expect_same_taps(lab["taps"], review["taps"]);

  const auto found = judge::estimates_of(run.metrics.taps, run.strokes, run.depths);
  std::size_t paired = 0;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (found[k] == nullptr) continue;
    ++paired;
    if (found[k]->indentation_max <= 0) continue;  // too shallow: it says nothing of its depth
    const double way = seconds(scenario.up.delay.mean);
    EXPECT_NEAR(found[k]->indentation_max, tip_depth(run, run.metrics.taps[k], way), 0.5e-3)
        << "tap " << k;
  }
  EXPECT_GT(2 * paired, found.size()) << "most taps are strokes";
}

}  // namespace palp::review::test
