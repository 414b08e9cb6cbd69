#include "lab/report/visibility.h"

#include <cstdio>

#include "common/config/json.h"
#include "common/config/report.h"
#include "common/core/conventions.h"

namespace palp::lab {
namespace {

using config::ExitCode;
using config::ExitStatus;

/// The largest ball at `depth` that the database holds, or 0.
double largest(const depth::DepthDatabase& database, double depth, double ratio) {
  const std::vector<double>& radii = database.grid().radii;
  constexpr int kSteps = 130;
  for (int i = 0; i < kSteps; ++i) {
    const double radius = radii.back() - (radii.back() - radii.front()) * i / kSteps;
    if (database.contains({.depth = depth, .radius = radius, .ratio = ratio})) return radius;
  }
  return 0;
}

double smallest_seen(const depth::DepthDatabase& database,
                     const TapPlan& plan,
                     double deviations,
                     double depth,
                     double ratio) {
  const std::vector<TipState> motion = motion_of(plan);
  const auto seen = [&](double radius) {
    const depth::DepthDatabase::Query query{.depth = depth, .radius = radius, .ratio = ratio};
    return depth_bound(database, query, {}, {}, plan.sensor, motion).signal >= deviations;
  };
  double low = database.grid().radii.front();
  double high = largest(database, depth, ratio);
  if (high == 0 || !seen(high)) return 0;
  if (seen(low)) return low;
  while (high - low > 0.05e-3) {
    const double middle = 0.5 * (low + high);
    (seen(middle) ? high : low) = middle;
  }
  return high;
}

std::string radius_text(const Visibility& all, double radius) {
  char text[32] = "      none";
  if (radius > 0) {
    const bool least = radius <= all.radius_min;
    std::snprintf(text, sizeof text, "%s%.1f", least ? "<= " : "", radius / kMillimetre);
  }
  return text;
}

}  // namespace

Visibility visibility(const depth::DepthDatabase& database,
                      const TapPlan& plan,
                      double deviations) {
  Visibility out;
  out.radius_min = database.grid().radii.front();
  out.ratios = {3, 10, 100, 856};
  for (const double depth_mm : {5.0, 7.5, 10.0, 12.5, 15.0, 17.5, 20.0, 25.0}) {
    out.depths.push_back(depth_mm * kMillimetre);
    std::vector<double>& row = out.radii.emplace_back();
    for (const double ratio : out.ratios) {
      row.push_back(smallest_seen(database, plan, deviations, out.depths.back(), ratio));
    }
  }
  return out;
}

std::string visibility_text(const Visibility& all) {
  std::string text = "radius in mm of the smallest ball that is seen, by stiffness ratio\ndepth mm";
  char cell[32];
  for (const double ratio : all.ratios) {
    std::snprintf(cell, sizeof cell, "%10.0f", ratio);
    text += cell;
  }
  for (std::size_t i = 0; i < all.depths.size(); ++i) {
    std::snprintf(cell, sizeof cell, "\n%8.1f", all.depths[i] / kMillimetre);
    text += cell;
    for (const double radius : all.radii[i]) {
      std::snprintf(cell, sizeof cell, "%10s", radius_text(all, radius).c_str());
      text += cell;
    }
  }
  return text + "\n";
}

void declare_visible(config::CommandLine& line, VisibilityFlags& flags) {
  line.whole("--taps", flags.taps, {.min = 1, .max = 1000}, "over the inclusion");
  line.whole("--reference-taps", flags.reference_taps, {.min = 0, .max = 1000}, "beside it");
  line.number(
      "--indentation-mm", flags.indentation_mm, {.min = 1, .max = 5, .unit = "mm"}, "of each tap");
  line.number("--deviations",
              flags.deviations,
              {.min = 0.1, .max = 20},
              "standard deviations by which a ball differs from plain tissue");
  line.report(flags.report, "palp.visible/1");
}

ExitStatus run_visible(const VisibilityFlags& flags) {
  const auto database = depth::default_database();
  if (!database) return {ExitCode::CannotOpen, "palp-lab: " + database.error().text};
  const TapPlan plan{.taps = static_cast<int>(flags.taps),
                     .reference_taps = static_cast<int>(flags.reference_taps),
                     .indentation = flags.indentation_mm * kMillimetre,
                     .sensor = {}};
  const Visibility all = visibility(*database, plan, flags.deviations);
  if (!flags.report.empty()) {
    config::Json out;
    out["schema"] = "palp.visible/1";
    out["taps"] = flags.taps;
    out["reference_taps"] = flags.reference_taps;
    out["indentation_mm"] = flags.indentation_mm;
    out["deviations"] = flags.deviations;
    out["ratios"] = all.ratios;
    out["rows"] = config::Json::array();
    for (std::size_t i = 0; i < all.depths.size(); ++i) {
      config::Json radii = config::Json::array();
      for (const double radius : all.radii[i]) {
        radii.push_back(radius > 0 ? config::Json(radius / kMillimetre) : nullptr);
      }
      out["rows"].push_back({{"depth_mm", all.depths[i] / kMillimetre}, {"radius_mm", radii}});
    }
    if (const auto written = config::write_whole_file(flags.report, out.dump(2) + "\n"); !written) {
      return {ExitCode::CannotOpen, "palp-lab: " + written.error().text};
    }
  }
  return {ExitCode::Done, visibility_text(all)};
}

}  // namespace palp::lab
