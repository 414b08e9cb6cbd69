#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
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

/// Draws of one script, one after the other.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : stream_{seed, 17} {}
  double between(double low, double high) { return low + (high - low) * stream_.uniform(next_++); }
  Duration span(double low, double high) { return from_seconds(between(low, high)); }
  int whole(int low, int high) { return static_cast<int>(between(low, high + 1)); }

 private:
  RandomStream stream_;
  std::uint64_t next_{};
};

/// Somewhere new, over the inclusion, or where the hand was before.
inline Place random_place(Draws& draws, const std::vector<Place>& been) {
  const int kind = draws.whole(0, 3);
  if (kind == 0) return kSiteA;
  if (kind == 1) return kSiteB;
  if (kind == 2 && !been.empty()) {
    return been[static_cast<std::size_t>(draws.whole(0, static_cast<int>(been.size()) - 1))];
  }
  return {draws.between(-40e-3, 40e-3), draws.between(-40e-3, 40e-3)};
}

/// Taps whose depths alternate, so that no two neighbours could be taken for each other; the same
/// touch repeated; and holds, of one depth or of two.
inline void random_gesture(Draws& draws, surgeon::ScriptBuilder& script) {
  const int kind = draws.whole(0, 3);
  if (kind <= 1) {
    const int taps = draws.whole(2, 4);
    for (int tap = 0; tap < taps; ++tap) {
      const double depth =
          tap % 2 == 0 ? draws.between(2.2e-3, 2.8e-3) : draws.between(3.8e-3, 4.6e-3);
      script.taps(1, depth, draws.span(0.6, 1.2), draws.span(0.1, 0.8));
    }
    return;
  }
  if (kind == 2) {
    const auto count = static_cast<std::uint32_t>(draws.whole(2, 4));
    script.taps(count, draws.between(2.5e-3, 4.5e-3), draws.span(0.6, 1.2), draws.span(0.1, 0.8));
    return;
  }
  script.press(draws.between(1.5e-3, 2.5e-3), draws.span(0.3, 0.6), draws.span(1.6, 2.5));
  if (draws.whole(0, 1) == 1) {
    script.press(draws.between(3e-3, 4.5e-3), draws.span(0.3, 0.6), draws.span(1.6, 2.5));
  }
  script.move(surgeon::kNearPlace, draws.span(0.3, 0.5)).hold(draws.span(0.1, 0.8));
}

inline surgeon::GestureScript random_script(std::uint64_t seed, double hand_stiffness) {
  Draws draws{seed};
  surgeon::ScriptBuilder script{hand_stiffness};
  script.hold(from_seconds(0.3));
  std::vector<Place> been;
  for (int visits = draws.whole(1, 4); visits > 0; --visits) {
    been.push_back(random_place(draws, been));
    script.travel(been.back()).move(surgeon::kNearPlace, from_seconds(0.4));
    for (int gestures = draws.whole(1, 2); gestures > 0; --gestures) random_gesture(draws, script);
    script.lift(from_seconds(0.4), from_seconds(0.3));
  }
  return script.build();
}

inline lab::Scenario random_scenario(std::uint64_t seed) {
  const RandomStream draws{seed, 18};
  const std::vector<std::string> couplings{"wave", "tdpa", "mmt"};
  const std::string& coupling = couplings[seed % couplings.size()];
  // Every other one longer than a pause between taps, so that a stroke comes in a later tap's time.
  const double delay =
      draws.uniform(3) < 0.5 ? 1 + 100 * draws.uniform(0) : 100 + 350 * draws.uniform(0);  // [ms]
  const std::string spec = "delay " + std::to_string(static_cast<int>(delay)) + "ms " +
                           std::to_string(1 + static_cast<int>(3 * draws.uniform(1))) +
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

/// [s] of the run: when the hand turned back, where a stroke ends; by the clocks alone.
inline double turned_at(const DepthEstimate& estimate,
                        const SessionPair& pair,
                        TimePoint run_began,
                        double way) {
  return seconds(elapsed(run_began, pair.time_line.surgeons(estimate.stroke_ended_at))) - way;
}

/// The tap that the hand was at then; none: it held a press.
inline std::optional<std::size_t> tap_at(const std::vector<judge::TapMetrics>& taps, double time) {
  for (std::size_t k = 0; k < taps.size(); ++k) {
    if (taps[k].began_at <= time && time <= taps[k].ended_at) return k;
  }
  return std::nullopt;
}

/// What was felt in each stroke is of the excursion of the hand in which it turned back.
inline void expect_felt_by_time(const std::vector<Tap>& taps,
                                const std::vector<double>& turns,
                                const JudgedSession& judged) {
  for (std::size_t i = 0; i < taps.size(); ++i) {
    const TimePoint turned = judged.run_began + from_seconds(turns[i]);
    const auto own = std::ranges::find_if(judged.excursions, [&](const judge::Excursion& one) {
      return one.began_at <= turned && turned <= one.ended_at;
    });
    // A wave that came back may make the tip touch once more, without the hand.
    const auto felt = own == judged.excursions.end() ? std::nullopt : own->stiffness.felt();
    EXPECT_EQ(taps[i].stiffness.felt(), felt) << "stroke " << i;
  }
}

/// In the reports of both programs each stroke stands beside the tap during which it was made.
inline void expect_paired_by_time(const nlohmann::json& lab,
                                  const nlohmann::json& review,
                                  const lab::RunResult& run,
                                  const std::vector<double>& turns) {
  ASSERT_EQ(review.size(), turns.size());
  ASSERT_EQ(lab.size(), run.metrics.taps.size());
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const auto tap = tap_at(run.metrics.taps, turns[i]);
    const nlohmann::json& row = review[i];
    const bool of_hand = tap || !row["stiffness_felt_n_per_m"].is_null();
    EXPECT_TRUE(!of_hand || row["kind"] == (tap ? "tap" : "press")) << row.dump();
    for (const char* key : {"stiffness_felt_n_per_m", "stiffness_true_n_per_m"}) {
      for (std::size_t k = 0; k < lab.size(); ++k) {
        if (lab[k][key].is_null()) continue;
        EXPECT_EQ(row[key] == lab[k][key], tap == k) << key << " of tap " << k << row.dump();
      }
    }
  }
  for (std::size_t k = 0; k < lab.size(); ++k) {
    if (lab[k]["depth"].is_null()) continue;  // the patient's site saw no stroke in it
    bool found = false;                       // a tip that bounces makes several strokes in a tap
    for (std::size_t i = 0; i < turns.size(); ++i) {
      found = found || (tap_at(run.metrics.taps, turns[i]) == k &&
                        review[i]["indentation_max_mm"] == lab[k]["indentation_max_mm"] &&
                        review[i]["force_max_n"] == lab[k]["force_max_n"] &&
                        review[i]["site"] == lab[k]["site"]);
    }
    EXPECT_TRUE(found) << "tap " << k << lab[k].dump();
  }
}

/// How many strokes were looked at.
struct Looked {
  std::size_t taps{};
  std::size_t presses{};
};

/// All numbers of the lab's report and of the review's are the same to the last digit, and each
/// tap stands beside the stroke that the tip made for it.
inline void expect_same_judgement(const lab::Scenario& scenario, Looked& looked) {
  LabFiles files;
  const lab::RunResult run =
      lab::simulate(scenario, {.surgeon = &files.surgeon, .patient = &files.patient});
  const nlohmann::json lab = nlohmann::json::parse(lab::run_report(scenario, run, {}));

  SessionPair pair = pair_of(load_site(files.surgeon.bytes(), "s", link::Role::Surgeon).value(),
                             load_site(files.patient.bytes(), "p", link::Role::Patient).value())
                         .value();
  const JudgedSession judged = judge_session(pair, nullptr);
  Touches touches = match_taps(pair.surgeon, pair.patient, pair.time_line, judged.excursions);
  ASSERT_TRUE(judged.by_truth);
  const double way = seconds(scenario.up.delay.mean);
  std::vector<double> turns;
  std::vector<Tap>& taps = touches.taps;
  for (const Tap& tap : taps) {
    ++(tap.kind == StrokeKind::Tap ? looked.taps : looked.presses);
    turns.push_back(turned_at(tap.estimate, pair, judged.run_began, way));
  }
  expect_felt_by_time(taps, turns, judged);
  take_truth(taps, pair, judged.run_began, judged.metrics.taps);
  const config::Json told = metrics_json(judged);
  const nlohmann::json metrics = nlohmann::json::parse(told.dump());
  for (const judge::Metric& metric : judge::metric_table()) {
    const std::string name{metric.name};
    // What energy permits takes the tissue and the hand themselves; no session file has them.
    if (name.starts_with("share_")) {
      EXPECT_TRUE(name == "share_2s" || metrics[name].is_null()) << name;
      continue;
    }
    EXPECT_EQ(metrics[name].dump(), lab[name].dump()) << name;
  }
  EXPECT_EQ(metrics["unstable"], lab["unstable"]);
  const nlohmann::json review = nlohmann::json::parse(demo_report(pair, touches, {}, {}, {}, told));
  expect_same_taps(lab["taps"], review["taps"]);
  expect_paired_by_time(lab["taps"], review["taps"], run, turns);

  const auto found = judge::estimates_of(run.metrics.taps, run.strokes, run.depths);
  std::size_t paired = 0;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (found[k] == nullptr) continue;
    ++paired;
    if (found[k]->indentation_max <= 0) continue;  // too shallow: it says nothing of its depth
    EXPECT_NEAR(found[k]->indentation_max, tip_depth(run, run.metrics.taps[k], way), 0.5e-3)
        << "tap " << k;
  }
  EXPECT_GE(2 * paired, found.size()) << "most taps are strokes";
}

inline void expect_same_judgement(std::uint64_t seed, Looked& looked) {
  SCOPED_TRACE("random session " + std::to_string(seed));
  expect_same_judgement(random_scenario(seed), looked);
}

}  // namespace palp::review::test
