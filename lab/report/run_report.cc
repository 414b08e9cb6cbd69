#include "lab/report/run_report.h"

#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <optional>
#include <span>

#include "common/config/json.h"
#include "common/core/number_text.h"
#include "common/core/place_text.h"
#include "common/message/map_text.h"
#include "judge/depth_statement.h"
#include "judge/depth_summary.h"
#include "judge/map_json.h"
#include "judge/metric_table.h"
#include "judge/stroke_pairing.h"
#include "lab/run/digest.h"

namespace palp::lab {
namespace {

using config::Json;

std::vector<DepthEstimate> estimates_at(const Place& place, std::span<const DepthEstimate> all) {
  std::vector<DepthEstimate> here;
  for (const DepthEstimate& estimate : all) {
    if (distance(estimate.place, place) <= kSamePlace) here.push_back(estimate);
  }
  return here;
}

Json millimetres(const std::optional<double>& metres) {
  return metres ? Json(*metres * 1e3) : Json(nullptr);
}

Json depth_json(const DepthEstimate& estimate, depth::EstimatorKind kind) {
  const judge::DepthStatement statement = judge::statement_of(estimate);
  Json json;
  json["verdict"] = to_string(statement.verdict);
  json["depth_mm"] = millimetres(statement.depth);
  json["low_mm"] = millimetres(statement.low);
  json["high_mm"] = millimetres(statement.high);
  json["stddev_mm"] = millimetres(statement.stddev);
  json["excluded_above_mm"] = millimetres(statement.excluded);
  json["says"] = statement.says;
  json["h_n"] = estimate.hash;
  json["reason"] = to_string(estimate.reason);
  json["estimator"] = to_string(kind);
  return json;
}

/// Each tap with the stroke that shares its time.
Json taps_json(const RunResult& result, depth::EstimatorKind kind) {
  Json taps = Json::array();
  const std::vector<judge::TapMetrics>& all = result.metrics.taps;
  const auto found = judge::estimates_of(all, result.strokes, result.depths);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const judge::TapMetrics& tap = all[k];
    const DepthEstimate* const estimate = found[k];
    Json json;
    json["site"] = place_text(tap.place);
    json["x_mm"] = tap.place.x * 1e3;
    json["y_mm"] = tap.place.y * 1e3;
    json["index"] = tap.index;
    const bool known = estimate != nullptr;
    json["indentation_max_mm"] = known ? Json(estimate->indentation_max * 1e3) : Json(nullptr);
    json["force_max_n"] = known ? Json(estimate->force_max) : Json(nullptr);
    json["stiffness_felt_n_per_m"] = tap.stiffness.felt().value_or(judge::kUndefined);
    json["stiffness_true_n_per_m"] = tap.stiffness.truth().value_or(judge::kUndefined);
    json["depth"] = known ? depth_json(*estimate, kind) : Json(nullptr);
    taps.push_back(json);
  }
  return taps;
}

Json metrics_json(const judge::RunMetrics& m) {
  Json json;
  json["unstable"] = m.unstable;
  json["unstable_reason"] = m.unstable_reason;
  for (const judge::Metric& metric : judge::metric_table()) {
    json[std::string{metric.name}] = metric.value(m);
  }
  return json;
}

/// printf at the end of a text; a line is never longer than 239 characters.
[[gnu::format(printf, 2, 3)]] void append(std::string& text, const char* format, ...) {
  std::array<char, 240> line{};
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line.data(), line.size(), format, arguments);
  va_end(arguments);
  text += line.data();
}

/// "-0.3 %" of a ratio; what nothing was measured of is "-".
std::string percent(double ratio) {
  std::string text;
  if (std::isfinite(ratio)) append(text, "%+.1f %%", 100 * ratio);
  return text.empty() ? "-" : text;
}

std::string measured(double value, int decimals, const char* unit) {
  return std::isfinite(value) ? number_text("", value, decimals, unit) : "-";
}

std::string tap_text(const judge::TapMetrics& tap) {
  std::string text;
  append(text, "tap %-9s %-2d ", place_text(tap.place).c_str(), tap.index);
  if (!tap.stiffness.felt()) return text + "no contact\n";
  append(text,
         "felt %6.1f N/m, true %6.1f N/m (%s), hand to %.2f mm\n",
         *tap.stiffness.felt(),
         tap.stiffness.truth().value_or(judge::kUndefined),
         percent(tap.stiffness.error().value_or(judge::kUndefined)).c_str(),
         tap.hand_max * 1e3);
  return text;
}

}  // namespace

std::string run_report(const Scenario& scenario,
                       const RunResult& result,
                       const RunAccount& account) {
  Json json;
  json["schema"] = "palp.run/1";
  json["scenario"] = account.scenario;
  json["seed"] = scenario.seed;
  json["coupling"] = scenario.coupling.name;
  json["tissue"] = scenario.phantom.name;
  json["bare"] = scenario.bare;
  json["digest"] = hexadecimal(result.digest);
  json["outcome"] = surgeon::to_string(result.outcome);
  json["virtual_s"] = seconds(result.virtual_span);
  json["cpu_s"] = account.cpu;
  json["wall_s"] = account.wall;
  json["speed"] = seconds(result.virtual_span) / account.cpu;
  json["records"] = result.records;
  json["recording_fault"] =
      account.recording_fault.empty() ? Json(nullptr) : Json(account.recording_fault);
  json.update(metrics_json(result.metrics));
  json["taps"] = taps_json(result, scenario.estimator.kind);
  json["depth"] =
      depth_json(judge::summarise_depths(estimates_at(scenario.phantom.axis, result.depths)),
                 scenario.estimator.kind);
  json["map"] = judge::map_json(result.map);
  // A file's name need not be UTF-8.
  return json.dump(2) + "\n";
}

std::string run_summary(const Scenario& scenario,
                        const RunResult& result,
                        const RunAccount& account) {
  std::string text;
  append(text,
         "scenario   %s, seed %llu, coupling %s, phantom %s\n",
         account.scenario.c_str(),
         static_cast<unsigned long long>(scenario.seed),
         scenario.coupling.name.c_str(),
         scenario.phantom.name.c_str());
  const judge::RunMetrics& m = result.metrics;
  for (const judge::TapMetrics& tap : m.taps) text += tap_text(tap);
  for (const DepthEstimate& estimate : result.depths) {
    append(text,
           "stroke %-9s h %.4f N, %s",
           place_text(estimate.place).c_str(),
           estimate.hash,
           std::string{to_string(estimate.verdict)}.c_str());
    if (estimate.verdict == DepthVerdict::Found) {
      append(text, " at %.1f mm, if right below the tip", estimate.depth * 1e3);
    }
    if (estimate.reason != DepthReason::Ok) {
      append(text, " (%s)", std::string{to_string(estimate.reason)}.c_str());
    }
    text += '\n';
  }
  if (result.map.number != 0) text += "map        " + map_sentence(result.map) + '\n';
  append(text, "stability  %s\n", m.unstable ? m.unstable_reason : "stable");
  text += "taps 2-4   A " + percent(m.tap_error[0]) + ", B " + percent(m.tap_error[1]) +
          ", ratio " + percent(m.ratio_error) + "; holds A " + percent(m.static_error[0]) + ", B " +
          percent(m.static_error[1]) + "\n";
  text += "hand       drag " + measured(m.drag_rms, 3, " N rms") + ", worst step " +
          measured(m.force_step_10ms, 2, " N in 10 ms") + ", energy out " +
          measured(m.energy_operator * 1e3, 3, " mJ") + "\n";
  append(text,
         "outcome    %s after %.1f s of virtual time in %.2f s of processor time: %.0f times\n",
         std::string{surgeon::to_string(result.outcome)}.c_str(),
         seconds(result.virtual_span),
         account.cpu,
         seconds(result.virtual_span) / account.cpu);
  append(text, "digest     %s\n", hexadecimal(result.digest).c_str());
  return text;
}

std::string trace_csv(const RunResult& result) {
  std::string text =
      "t_s,site,phase,index,hand_mm,tip_mm,force_felt_n,force_true_n,contact_force_n,energy_mj,"
      "counted,hand_speed_m_per_s,surface_mm,x_mm,y_mm\n";
  constexpr std::array kSites{"A", "B", ""};
  constexpr std::array kKinds{"other", "air", "tap", "press", "lift", "drag"};
  static_assert(kKinds.size() == static_cast<std::size_t>(judge::PhaseKind::Drag) + 1);
  for (const judge::RunTick& tick : result.ticks) {
    append(text,
           "%.4f,%s,%s,%d,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%d,%.9g,%.9g,%.9g,%.9g\n",
           tick.at,
           kSites[static_cast<std::size_t>(tick.phase.site)],
           kKinds[static_cast<std::size_t>(tick.phase.kind)],
           tick.phase.index,
           tick.hand * 1e3,
           tick.tip * 1e3,
           tick.hand_force,
           tick.force_true,
           tick.contact_force,
           tick.energy_operator * 1e3,
           tick.counted ? 1 : 0,
           tick.hand_velocity,
           tick.surface * 1e3,
           tick.tip_place.x * 1e3,
           tick.tip_place.y * 1e3);
  }
  return text;
}

}  // namespace palp::lab
