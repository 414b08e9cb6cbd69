#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "common/config/json.h"
#include "common/core/conventions.h"
#include "common/core/median.h"
#include "lab/plan/locate_study.h"

namespace palp::lab {
namespace {

using config::Json;

constexpr std::size_t kThirds = 3;
constexpr double kHard = 20;              // [-], ratio from which a harder ball is no other
constexpr double kNeighbourhood = 10e-3;  // [m], depth to which nine taps are held to a bound
constexpr double kNearest = 5e-3;         // [m], and radius and depth from which

/// Of balls that were found.
struct Figures {
  std::size_t count{};
  std::size_t found{};
  std::size_t trusted{};
  std::array<std::size_t, kLocated> inside{};
  std::array<double, kLocated> squares{};  ///< of the errors, then their root mean
  std::array<double, kLocated> bounds{};   ///< of the bounds, then their root mean
};

template <class Chosen>
Figures figures(const std::vector<LocateCase>& cases, const Chosen& chosen) {
  Figures out;
  for (const LocateCase& one : cases) {
    if (!one.inclusion || !chosen(one)) continue;
    ++out.count;
    if (!one.found) continue;
    ++out.found;
    if (one.doubts == 0) ++out.trusted;
    for (std::size_t i = 0; i < kLocated; ++i) {
      const Located& told = one.coordinates[i];
      const double error = told.median - told.truth;
      out.squares[i] += error * error;
      out.bounds[i] += told.bound * told.bound;
      out.inside[i] += told.low <= told.truth && told.truth <= told.high ? 1 : 0;
    }
  }
  for (std::size_t i = 0; i < kLocated && out.found > 0; ++i) {
    out.squares[i] = std::sqrt(out.squares[i] / static_cast<double>(out.found));
    out.bounds[i] = std::sqrt(out.bounds[i] / static_cast<double>(out.found));
  }
  return out;
}

std::size_t third_of(double value, double low, double high) {
  return static_cast<std::size_t>(
      std::clamp((value - low) / (high - low) * static_cast<double>(kThirds), 0.0, 2.0));
}

/// A name and the cases of it.
struct LocateRow {
  std::string name;
  Figures figures;
};

std::vector<LocateRow> rows_of(const LocateStudy& study, const std::vector<LocateCase>& cases) {
  const depth::DepthPrior prior;
  std::vector<LocateRow> rows{{"all", figures(cases, [](const LocateCase&) { return true; })}};
  const auto radius = [](const LocateCase& one) { return one.coordinates[3].truth; };
  const auto depth = [](const LocateCase& one) { return one.coordinates[2].truth; };
  rows.push_back({"hard, near", figures(cases, [&](const LocateCase& one) {
                    return one.ratio >= kHard && depth(one) >= kNearest &&
                           depth(one) <= kNeighbourhood && radius(one) >= kNearest;
                  })});
  constexpr std::array kWords{"small", "middle", "large"};
  constexpr std::array kDeep{"shallow", "middle", "deep"};
  for (std::size_t i = 0; i < kThirds; ++i) {
    for (std::size_t j = 0; j < kThirds; ++j) {
      rows.push_back(
          {std::string{kWords[i]} + ", " + kDeep[j], figures(cases, [&](const LocateCase& one) {
             return third_of(radius(one), prior.radius_min, prior.radius_max) == i &&
                    third_of(depth(one), prior.depth_min, study.depth_max) == j;
           })});
    }
  }
  constexpr std::array kStiff{"ratio below 20", "ratio 20 to 134", "ratio above 134"};
  for (std::size_t i = 0; i < kThirds; ++i) {
    rows.push_back({kStiff[i], figures(cases, [&](const LocateCase& one) {
                      return third_of(one.coordinates[4].truth,
                                      std::log(prior.ratio_min),
                                      std::log(prior.ratio_max)) == i;
                    })});
  }
  return rows;
}

struct Alarms {
  std::size_t plain{};
  std::size_t found{};
  std::size_t doubted{};  ///< well-modelled all of them, yet not trusted
  std::size_t all{};
};

Alarms alarms(const std::vector<LocateCase>& cases) {
  Alarms out;
  constexpr std::uint32_t kModel = 1U << static_cast<unsigned>(MapDoubt::Curve) |
                                   1U << static_cast<unsigned>(MapDoubt::NotOneBall);
  for (const LocateCase& one : cases) {
    ++out.all;
    if ((one.doubts & kModel) != 0) ++out.doubted;
    if (one.inclusion) continue;
    ++out.plain;
    if (one.found) ++out.found;
  }
  return out;
}

/// Of the worlds of a kind, or of all.
struct Worlds {
  std::string name;
  std::size_t count{};
  std::size_t wrong{};  ///< confidently
  std::size_t warned{};
  std::size_t alarms{};  ///< plain ones in which something was found, doubted or not
};

std::vector<Worlds> worlds_of(const std::vector<LocateCase>& cases) {
  std::vector<Worlds> out(kMismatchNames.size() + 1);
  const auto add = [](const LocateCase& one, Worlds& to) {
    ++to.count;
    if (one.confidently_wrong()) ++to.wrong;
    if (one.doubts != 0) ++to.warned;
    if (!one.inclusion && one.found) ++to.alarms;
  };
  for (const LocateCase& one : cases) {
    add(one, out[static_cast<std::size_t>(one.kind)]);
    add(one, out.back());
  }
  for (std::size_t i = 0; i < kMismatchNames.size(); ++i) out[i].name = kMismatchNames[i];
  out.back().name = "all";
  return out;
}

std::size_t right_of(const std::vector<LocateCase>& cases) {
  return static_cast<std::size_t>(
      std::count_if(cases.begin(), cases.end(), [](const LocateCase& one) { return one.right(); }));
}

/// Median number of strokes of the sessions that found their ball; 0: there are none.
double strokes_of(const std::vector<LocateCase>& cases) {
  std::vector<double> strokes;
  for (const LocateCase& one : cases) {
    if (one.inclusion && one.found) strokes.push_back(one.strokes);
  }
  return median(strokes).value_or(0);
}

/// Median over all balls of a number of touches, 0 of them for never; 0: never for half of them.
double touches_of(const std::vector<LocateCase>& cases, std::uint32_t Searched::*number) {
  std::vector<double> touches;
  for (const LocateCase& one : cases) {
    if (!one.inclusion) continue;
    const std::uint32_t told = one.searched.*number;
    touches.push_back(told > 0 ? told : 1e9);
  }
  const double middle = median(touches).value_or(0);
  return middle < 1e9 / 2 ? middle : 0;
}

std::size_t balls_of(const std::vector<LocateCase>& cases) {
  return static_cast<std::size_t>(std::count_if(
      cases.begin(), cases.end(), [](const LocateCase& one) { return one.inclusion; }));
}

double unit_of(std::size_t coordinate) { return coordinate + 1 < kLocated ? kMillimetre : 1; }

double share_or_zero(std::size_t part, std::size_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

/// A line of the table.
std::string text_of(const LocateRow& row) {
  const Figures& f = row.figures;
  char line[240];
  std::snprintf(line,
                sizeof line,
                "%-16s %4zu %5.1f%%",
                row.name.c_str(),
                f.count,
                100 * share_or_zero(f.found, f.count));
  std::string out = line;
  if (f.found == 0) return out + '\n';
  out += "      ";
  for (std::size_t i = 0; i < kLocated; ++i) {
    std::snprintf(line, sizeof line, " %6.1f", 100 * share_or_zero(f.inside[i], f.found));
    out += line;
  }
  out += "   ";
  for (std::size_t i = 0; i + 1 < kLocated; ++i) {
    std::snprintf(line, sizeof line, " %6.2f", f.squares[i] / unit_of(i));
    out += line;
  }
  out += "   ";
  for (std::size_t i = 0; i + 1 < kLocated; ++i) {
    if (f.bounds[i] > 0) {
      std::snprintf(line, sizeof line, " %6.2f", f.squares[i] / f.bounds[i]);
    } else {
      std::snprintf(line, sizeof line, " %6s", "-");
    }
    out += line;
  }
  return out + '\n';
}

std::string worlds_text(const std::vector<LocateCase>& cases) {
  std::string out = "kind              n  confidently wrong  warned  plain called an inclusion\n";
  for (const Worlds& one : worlds_of(cases)) {
    char line[160];
    std::snprintf(line,
                  sizeof line,
                  "%-12s %6zu %17.1f%% %6.1f%% %26zu\n",
                  one.name.c_str(),
                  one.count,
                  100 * share_or_zero(one.wrong, one.count),
                  100 * share_or_zero(one.warned, one.count),
                  one.alarms);
    out += line;
  }
  return out;
}

}  // namespace

std::string locate_table(const LocateStudy& study, const std::vector<LocateCase>& cases) {
  std::string out =
      "balls               n  found  coverage % x     y depth radius ratio  rms mm x     y depth "
      "radius  over bound x    y depth radius\n";
  for (const LocateRow& row : rows_of(study, cases)) out += text_of(row);
  if (study.mismatch) return out + worlds_text(cases);
  const Alarms told = alarms(cases);
  char line[240];
  std::snprintf(line,
                sizeof line,
                "right (x, y, depth within 1 mm, the radius in its interval) %zu of %zu balls\n"
                "false alarms %.2f %% of %zu plain phantoms\nmodel doubted %.2f %% of all\n",
                right_of(cases),
                balls_of(cases),
                100 * share_or_zero(told.found, told.plain),
                told.plain,
                100 * share_or_zero(told.doubted, told.all));
  out += line;
  if (study.rule) {
    std::snprintf(line,
                  sizeof line,
                  "touches, median of all balls, until known to 1 mm: %.1f, until right to 1 mm "
                  "beside the axis: %.1f\n",
                  touches_of(cases, &Searched::known),
                  touches_of(cases, &Searched::near));
    out += line;
  }
  if (study.script.empty()) return out;
  std::snprintf(line, sizeof line, "strokes, median of the balls found: %.0f\n", strokes_of(cases));
  return out + line;
}

std::string locate_report(const LocateStudy& study,
                          const std::vector<LocateCase>& cases,
                          const std::string& cases_csv) {
  Json json;
  json["schema"] = "palp.locate/1";
  json["count"] = study.count;
  json["seed"] = study.seed;
  json["places"] = study.rows * study.rows;
  json["pitch_mm"] = study.pitch / kMillimetre;
  json["stiffness_spread"] = study.spread;
  json["stiffness_length_mm"] = study.length / kMillimetre;
  json["assumed_spread"] = study.assumed_spread;
  json["depth_max_mm"] = study.depth_max / kMillimetre;
  json["rows"] = Json::array();
  for (const LocateRow& row : rows_of(study, cases)) {
    const Figures& f = row.figures;
    Json one;
    one["balls"] = row.name;
    one["n"] = f.count;
    one["found"] = f.found;
    one["trusted"] = f.trusted;
    for (std::size_t i = 0; i < kLocated && f.found > 0; ++i) {
      Json& told = one[kLocatedNames[i]];
      told["coverage95"] = share_or_zero(f.inside[i], f.found);
      told["rmse"] = f.squares[i] / unit_of(i);
      told["crb"] = f.bounds[i] / unit_of(i);
    }
    json["rows"].push_back(std::move(one));
  }
  json["right"] = right_of(cases);
  json["session"] = study.script.empty() ? Json(nullptr) : Json(study.script);
  json["rtt_ms"] = study.round_trip * 1e3;
  json["loss"] = study.loss;
  json["strokes_p50"] = study.script.empty() ? Json(nullptr) : Json(strokes_of(cases));
  json["next_tap"] =
      study.rule ? Json(kTapRuleNames[static_cast<std::size_t>(*study.rule)]) : Json(nullptr);
  json["touches_known_p50"] =
      study.rule ? Json(touches_of(cases, &Searched::known)) : Json(nullptr);
  json["touches_near_p50"] = study.rule ? Json(touches_of(cases, &Searched::near)) : Json(nullptr);
  json["set"] = study.mismatch ? Json("mismatch") : Json(nullptr);
  json["kinds"] = Json::array();
  for (const Worlds& one : study.mismatch ? worlds_of(cases) : std::vector<Worlds>{}) {
    json["kinds"].push_back({{"kind", one.name},
                             {"n", one.count},
                             {"confident_wrong", one.wrong},
                             {"warned", one.warned},
                             {"plain_found", one.alarms}});
  }
  const Alarms told = alarms(cases);
  json["plain_count"] = told.plain;
  json["false_alarm_rate"] = share_or_zero(told.found, told.plain);
  json["model_doubted_rate"] = share_or_zero(told.doubted, told.all);
  json["cases_csv"] = cases_csv.empty() ? Json(nullptr) : Json(cases_csv);
  return json.dump(2) + "\n";
}

std::string locate_csv(const LocateStudy& study, const std::vector<LocateCase>& cases) {
  std::string out =
      "index,kind,inclusion,found,doubts,ratio,scale,log_evidence,balls_worth,worst_curve,"
      "worst_deviation";
  for (const char* name : kLocatedNames) {
    for (const char* what : {"true_", "median_", "low_", "high_", "crb_"}) {
      out.append(",").append(what).append(name);
    }
  }
  out += '\n';
  for (const LocateCase& one : cases) {
    char line[200];
    std::snprintf(line,
                  sizeof line,
                  "%u,%s,%d,%d,%u,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g",
                  one.index,
                  std::string{study.mismatch ? to_string(one.kind) : "assumed"}.c_str(),
                  one.inclusion ? 1 : 0,
                  one.found ? 1 : 0,
                  one.doubts,
                  one.ratio,
                  one.scale,
                  one.log_evidence,
                  one.balls_worth,
                  one.worst_curve,
                  one.worst_deviation);
    out += line;
    for (std::size_t i = 0; i < kLocated; ++i) {
      const Located& told = one.coordinates[i];
      for (const double value : {told.truth, told.median, told.low, told.high, told.bound}) {
        std::snprintf(line, sizeof line, ",%.9g", value / unit_of(i));
        out += line;
      }
    }
    out += '\n';
  }
  return out;
}

}  // namespace palp::lab
