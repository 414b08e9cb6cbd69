#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "common/config/json.h"
#include "common/core/conventions.h"
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
struct Row {
  std::string name;
  Figures figures;
};

std::vector<Row> rows_of(const LocateStudy& study, const std::vector<LocateCase>& cases) {
  const depth::DepthPrior prior;
  std::vector<Row> rows{{"all", figures(cases, [](const LocateCase&) { return true; })}};
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
  constexpr std::uint32_t kModel = 1U << static_cast<unsigned>(depth::MapDoubt::Curve) |
                                   1U << static_cast<unsigned>(depth::MapDoubt::NotOneBall);
  for (const LocateCase& one : cases) {
    ++out.all;
    if ((one.doubts & kModel) != 0) ++out.doubted;
    if (one.inclusion) continue;
    ++out.plain;
    if (one.found) ++out.found;
  }
  return out;
}

double unit_of(std::size_t coordinate) { return coordinate + 1 < kLocated ? kMillimetre : 1; }

double share(std::size_t part, std::size_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

}  // namespace

std::string locate_table(const LocateStudy& study, const std::vector<LocateCase>& cases) {
  std::string out =
      "balls               n  found  coverage % x     y depth radius ratio  rms mm x     y depth "
      "radius  over bound x    y depth radius\n";
  for (const Row& row : rows_of(study, cases)) {
    const Figures& f = row.figures;
    char line[240];
    std::snprintf(line,
                  sizeof line,
                  "%-16s %4zu %5.1f%%",
                  row.name.c_str(),
                  f.count,
                  100 * share(f.found, f.count));
    out += line;
    if (f.found > 0) {
      out += "      ";
      for (std::size_t i = 0; i < kLocated; ++i) {
        std::snprintf(line, sizeof line, " %6.1f", 100 * share(f.inside[i], f.found));
        out += line;
      }
      out += "   ";
      for (std::size_t i = 0; i + 1 < kLocated; ++i) {
        std::snprintf(line, sizeof line, " %6.2f", f.squares[i] / unit_of(i));
        out += line;
      }
      out += "   ";
      for (std::size_t i = 0; i + 1 < kLocated; ++i) {
        std::snprintf(line, sizeof line, " %6.2f", f.squares[i] / f.bounds[i]);
        out += line;
      }
    }
    out += '\n';
  }
  const Alarms told = alarms(cases);
  char line[160];
  std::snprintf(line,
                sizeof line,
                "false alarms %.2f %% of %zu plain phantoms\nmodel doubted %.2f %% of all\n",
                100 * share(told.found, told.plain),
                told.plain,
                100 * share(told.doubted, told.all));
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
  json["assumed_spread"] = study.assumed_spread;
  json["depth_max_mm"] = study.depth_max / kMillimetre;
  json["rows"] = Json::array();
  for (const Row& row : rows_of(study, cases)) {
    const Figures& f = row.figures;
    Json one;
    one["balls"] = row.name;
    one["n"] = f.count;
    one["found"] = f.found;
    one["trusted"] = f.trusted;
    for (std::size_t i = 0; i < kLocated && f.found > 0; ++i) {
      Json& told = one[kLocatedNames[i]];
      told["coverage95"] = share(f.inside[i], f.found);
      told["rmse"] = f.squares[i] / unit_of(i);
      told["crb"] = f.bounds[i] / unit_of(i);
    }
    json["rows"].push_back(std::move(one));
  }
  const Alarms told = alarms(cases);
  json["plain_count"] = told.plain;
  json["false_alarm_rate"] = share(told.found, told.plain);
  json["model_doubted_rate"] = share(told.doubted, told.all);
  json["cases_csv"] = cases_csv.empty() ? Json(nullptr) : Json(cases_csv);
  return json.dump(2) + "\n";
}

std::string locate_csv(const std::vector<LocateCase>& cases) {
  std::string out =
      "index,inclusion,found,doubts,ratio,scale,log_evidence,balls_worth,worst_curve,"
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
                  "%u,%d,%d,%u,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g",
                  one.index,
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
