#include "lab/report/locate_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/core/conventions.h"
#include "common/core/map_doubt.h"
#include "common/core/median.h"

namespace palp::lab {
namespace {

constexpr std::size_t kThirds = 3;
constexpr double kHard = 20;         // [-], ratio from which a harder ball is no other
constexpr double kNearMost = 10e-3;  // [m], depth to which nine taps are held to a bound
constexpr double kNearLeast = 5e-3;  // [m], and radius and depth from which
constexpr double kSizeMost = 15e-3;  // [m], and radius to which
constexpr double kNever = std::numeric_limits<double>::infinity();

template <class Chosen>
LocateFigures figures(const std::vector<LocateCase>& cases, const Chosen& chosen) {
  LocateFigures out;
  for (const LocateCase& one : cases) {
    if (!one.inclusion || !chosen(one)) continue;
    ++out.count;
    if (!one.found) continue;
    ++out.found;
    if (one.doubts == 0) ++out.trusted;
    for (std::size_t i = 0; i < kLocated; ++i) {
      const Located& told = one.coordinates[i];
      const double error = told.median - told.truth;
      out.rmse[i] += error * error;
      out.bounds[i] += told.bound * told.bound;
      out.inside[i] += told.low <= told.truth && told.truth <= told.high ? 1 : 0;
    }
  }
  for (std::size_t i = 0; i < kLocated && out.found > 0; ++i) {
    out.rmse[i] = std::sqrt(out.rmse[i] / static_cast<double>(out.found));
    out.bounds[i] = std::sqrt(out.bounds[i] / static_cast<double>(out.found));
  }
  return out;
}

double border(double low, double high, std::size_t third) {
  return low + (high - low) * static_cast<double>(third) / kThirds;
}

std::size_t third_of(double value, double low, double high) {
  return static_cast<std::size_t>(
      std::clamp((value - low) / (high - low) * static_cast<double>(kThirds), 0.0, 2.0));
}

double radius_of(const LocateCase& one) { return one.coordinates[3].truth; }
double depth_of(const LocateCase& one) { return one.coordinates[2].truth; }

bool hard_and_near(const LocateCase& one) {
  return one.ratio >= kHard && depth_of(one) >= kNearLeast && depth_of(one) <= kNearMost &&
         radius_of(one) >= kNearLeast && radius_of(one) <= kSizeMost;
}

}  // namespace

LocateFigures figures_of_all(const std::vector<LocateCase>& cases) {
  return figures(cases, [](const LocateCase&) { return true; });
}

std::vector<LocateCell> cells_of(const LocateStudy& study, const std::vector<LocateCase>& cases) {
  const depth::DepthPrior prior;
  constexpr std::array kSize{"small", "middle", "large"};
  constexpr std::array kDeep{"shallow", "middle", "deep"};
  std::vector<LocateCell> cells;
  for (std::size_t i = 0; i < kThirds; ++i) {
    for (std::size_t j = 0; j < kThirds; ++j) {
      const auto here = [&](const LocateCase& one) {
        return third_of(radius_of(one), prior.radius_min, prior.radius_max) == i &&
               third_of(depth_of(one), prior.depth_min, study.depth_max) == j;
      };
      cells.push_back({.name = std::string{kSize[i]} + ", " + kDeep[j],
                       .radius = {border(prior.radius_min, prior.radius_max, i),
                                  border(prior.radius_min, prior.radius_max, i + 1)},
                       .depth = {border(prior.depth_min, study.depth_max, j),
                                 border(prior.depth_min, study.depth_max, j + 1)},
                       .figures = figures(cases, here)});
    }
  }
  return cells;
}

std::vector<LocateRow> rows_of(const LocateStudy& study, const std::vector<LocateCase>& cases) {
  const depth::DepthPrior prior;
  const double half = 0.5 * study.pitch;
  const auto below_the_middle = [&](const LocateCase& one) {
    return hard_and_near(one) && std::abs(one.coordinates[0].truth) <= half &&
           std::abs(one.coordinates[1].truth) <= half;
  };
  std::vector<LocateRow> rows{{"hard, near", figures(cases, hard_and_near)},
                              {"and middle place", figures(cases, below_the_middle)}};
  constexpr std::array kStiff{"ratio below 20", "ratio 20 to 134", "ratio above 134"};
  for (std::size_t i = 0; i < kThirds; ++i) {
    rows.push_back({kStiff[i], figures(cases, [&](const LocateCase& one) {
                      return one.ratio > 0 && third_of(std::log(one.ratio),
                                                       std::log(prior.ratio_min),
                                                       std::log(prior.ratio_max)) == i;
                    })});
  }
  return rows;
}

LocateAlarms alarms(const std::vector<LocateCase>& cases) {
  LocateAlarms out;
  constexpr MapDoubts kModel = doubts_of(MapDoubt::Curve) | doubts_of(MapDoubt::NotOneBall);
  for (const LocateCase& one : cases) {
    ++out.all;
    if (one.doubts != 0) ++out.doubted;
    if ((one.doubts & kModel) != 0) ++out.model;
    if (one.inclusion) continue;
    ++out.plain;
    if (one.found) ++out.found;
  }
  return out;
}

std::vector<LocateWorlds> worlds_of(const std::vector<LocateCase>& cases) {
  std::vector<LocateWorlds> out(kMismatchNames.size() + 1);
  const auto add = [](const LocateCase& one, LocateWorlds& to) {
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

std::size_t balls_of(const std::vector<LocateCase>& cases) {
  return static_cast<std::size_t>(std::count_if(
      cases.begin(), cases.end(), [](const LocateCase& one) { return one.inclusion; }));
}

double strokes_of(const std::vector<LocateCase>& cases) {
  std::vector<double> strokes;
  for (const LocateCase& one : cases) {
    if (one.inclusion && one.found) strokes.push_back(one.strokes);
  }
  return median(strokes).value_or(0);
}

double touches_of(const std::vector<LocateCase>& cases,
                  std::uint32_t Searched::*number,
                  double share) {
  std::vector<double> touches;
  for (const LocateCase& one : cases) {
    if (!one.inclusion) continue;
    const std::uint32_t told = one.searched.*number;
    touches.push_back(told > 0 ? told : kNever);
  }
  if (touches.empty()) return 0;
  std::sort(touches.begin(), touches.end());
  const double place = share * static_cast<double>(touches.size());
  const auto above = std::min(static_cast<std::size_t>(place), touches.size() - 1);
  const bool between = std::floor(place) == place && above > 0;
  const double value = between ? 0.5 * (touches[above - 1] + touches[above]) : touches[above];
  return std::isfinite(value) ? value : 0;
}

double unit_of(std::size_t coordinate) { return coordinate + 1 < kLocated ? kMillimetre : 1; }

double share_or_zero(std::size_t part, std::size_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

bool tells(const LocateStudy& study, std::size_t coordinate) {
  return study.script.empty() || coordinate + 1 < kLocated;
}

}  // namespace palp::lab
