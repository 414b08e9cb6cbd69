#include "fem/database_grid.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <vector>

#include "common/core/conventions.h"
#include "common/core/printable.h"
#include "fem/database_builder.h"
#include "fem/figure_text.h"

namespace palp::fem {
namespace {

constexpr double kIndentationMax = 5e-3;  // [m], nobody presses deeper
constexpr std::size_t kFitsLeast = 2;     // depths that a radius must fit at

// The default grid took 470 s on two processors of a virtual machine, its shape beside the axis 415
// s of one; 60 phantoms between its points were at most 0.12 % of the force off.
constexpr double kCurveTime = 0.66;       // [s], coarse mesh
constexpr double kBallTime = 1.44;        // [s], normal mesh
constexpr double kFinerTime = 2.5;        // [-], for the next finer mesh; sizes differ by 1.7 to 2
constexpr double kDefaultError = 1.2e-3;  // [-], of F
constexpr double kErrorPower = 3;         // of the distance between points: Hermite's cubic

/// Every second one, the ends kept.
std::vector<double> thinned(const std::vector<double>& axis) {
  std::vector<double> out;
  for (std::size_t i = 0; i < axis.size(); i += 2) out.push_back(axis[i]);
  if (out.back() != axis.back()) out.push_back(axis.back());
  return out;
}

/// Depths where an inclusion of this radius fits and may be pressed as far as the grid goes.
std::size_t depths_for(const DepthGrid& grid, double radius) {
  return static_cast<std::size_t>(
      std::count_if(grid.depths.begin(), grid.depths.end(), [&](double depth) {
        return indentation_limit(grid, depth) >= grid.indentations.back() * (1 - 1e-9) &&
               check(specimen_of(grid, InclusionShape::Ball, depth, radius, 10)).has_value();
      }));
}

/// The longest step of an axis over that of the default's, both in logarithms. [-]
double widest_step(const std::vector<double>& axis, const std::vector<double>& usual) {
  const auto widest = [](const std::vector<double>& values) {
    double step = 0;
    for (std::size_t i = 1; i < values.size(); ++i) {
      step = std::max(step, std::log(values[i] / values[i - 1]));
    }
    return step;
  };
  return widest(axis) / widest(usual);
}

}  // namespace

Accuracy member_mesh(Detail detail) noexcept {
  return detail == Detail::Fine ? Accuracy::Normal : Accuracy::Coarse;
}

Accuracy shape_mesh(Detail detail) noexcept {
  return detail == Detail::Coarse   ? Accuracy::Coarse
         : detail == Detail::Normal ? Accuracy::Normal
                                    : Accuracy::Fine;
}

DepthGrid grid_for(const Block& block,
                   double indenter_radius,
                   double inclusion_poisson,
                   Detail detail) {
  DepthGrid grid = default_grid();
  grid.block = block;
  grid.indenter_radius = indenter_radius;
  grid.inclusion_poisson = inclusion_poisson;
  if (detail == Detail::Coarse) {
    for (std::vector<double>* axis : {&grid.depths, &grid.radii, &grid.ratios}) {
      *axis = thinned(*axis);
    }
  }
  const double deepest = std::min(kIndentationMax, indenter_radius);
  for (double& d : grid.indentations) d *= deepest / kIndentationMax;
  std::erase_if(grid.depths, [&](double depth) {
    return !check(specimen_of(grid, InclusionShape::Ball, depth, grid.radii.front(), 10));
  });
  std::erase_if(grid.radii, [&](double radius) { return depths_for(grid, radius) < kFitsLeast; });
  return grid;
}

Result<DepthGrid> with_axes(DepthGrid grid, std::string_view text) {
  std::istringstream lines{std::string{text}};
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    line.erase(std::min(line.size(), line.find('#')));
    std::istringstream words{line};
    std::string name;
    if (!(words >> name)) continue;
    std::vector<double>* const axis = name == "depth_mm"         ? &grid.depths
                                      : name == "radius_mm"      ? &grid.radii
                                      : name == "ratio"          ? &grid.ratios
                                      : name == "indentation_mm" ? &grid.indentations
                                                                 : nullptr;
    const auto wrong = [&](const std::string& why) {
      return fail("line " + std::to_string(number) + ": " + why);
    };
    if (axis == nullptr) {
      return wrong("\"" + printable(name) +
                   "\" is no axis; there are depth_mm, radius_mm, ratio and indentation_mm");
    }
    axis->clear();
    std::string word;
    while (words >> word) {
      double value = 0;
      const char* end = word.data() + word.size();
      const auto [stop, error] = std::from_chars(word.data(), end, value);
      if (error != std::errc{} || stop != end || !(value > 0) || !std::isfinite(value)) {
        return wrong("\"" + printable(word) + "\" is no number above 0");
      }
      axis->push_back(axis == &grid.ratios ? value : value * kMillimetre);
    }
    const auto falls = [](double a, double b) { return !(a < b); };
    if (axis->size() < 2 || std::adjacent_find(axis->begin(), axis->end(), falls) != axis->end()) {
      return wrong(name + " is not two or more rising numbers");
    }
  }
  return grid;
}

Result<void> check(const DepthGrid& grid) {
  if (auto ok = check(Specimen{
          .block = grid.block, .inclusion = {}, .indenter = {.radius = grid.indenter_radius}});
      !ok) {
    return ok;
  }
  if (grid.depths.size() < 2 || grid.radii.size() < 2 || grid.ratios.size() < 2 ||
      grid.indentations.size() < 2) {
    return fail("a block of height " + length_text(grid.block.height) + " and half width " +
                length_text(grid.block.half_width) +
                " holds too few of the grid's inclusions: give smaller ones with --grid");
  }
  if (!(grid.ratios.front() > 1)) return fail("a stiffness ratio is not above 1");
  const double deepest = 1.2 * grid.indenter_radius;
  if (grid.indentations.back() > deepest) {
    return fail("an indentation is " + length_text(grid.indentations.back()) +
                ", expected at most " + length_text(deepest) + " with such a tip");
  }
  for (const double radius : grid.radii) {
    if (depths_for(grid, radius) >= kFitsLeast) continue;
    return fail("an inclusion of radius " + length_text(radius) +
                " fits at fewer than two depths whose " + "cover takes an indentation of " +
                length_text(grid.indentations.back()) + " in a block of height " +
                length_text(grid.block.height));
  }
  return {};
}

ShapeTable shape_axes(const DepthGrid& grid, Detail detail) {
  ShapeTable axes;
  const bool coarse = detail == Detail::Coarse;
  const int depths = coarse ? 6 : 12;
  const double range = grid.depths.back() / grid.depths.front();
  for (int i = 0; i < depths; ++i) {
    axes.depths.push_back(grid.depths.front() * std::pow(range, i / (depths - 1.0)));
  }
  axes.radii = grid.radii;
  axes.ratios = {grid.ratios.front(), grid.ratios.back()};
  if (!coarse && axes.ratios.front() < 20 && axes.ratios.back() > 20) {
    axes.ratios.insert(axes.ratios.begin() + 1, 20);
  }
  axes.offsets = {0.1, 0.2, 0.3, 0.4, 0.5, 0.65, 0.8, 1, 1.25, 1.5, 2, 2.5, 3};
  for (const double share : {0.1, 0.3, 0.6, 1.0}) {
    axes.indentations.push_back(share * grid.indentations.back());
  }
  return axes;
}

Forecast forecast(const DepthGrid& grid, Detail detail, bool off_axis) {
  Forecast out;
  out.curves = cells_of(grid).size() * grid.ratios.size();
  const double finer = detail == Detail::Fine ? kFinerTime : 1;
  const DepthGrid usual = default_grid();
  const auto points = static_cast<double>(grid.indentations.size());
  const double rows = points / static_cast<double>(usual.indentations.size());
  out.work = static_cast<double>(out.curves) * kCurveTime * finer * rows;
  out.bytes = static_cast<double>(out.curves) * (8 + 4 * points);
  const double step = std::max({widest_step(grid.depths, usual.depths),
                                widest_step(grid.radii, usual.radii),
                                widest_step(grid.ratios, usual.ratios)});
  out.error_share = kDefaultError * std::pow(step, kErrorPower);
  if (!off_axis) return out;
  const ShapeTable axes = shape_axes(grid, detail);
  out.balls = axes.depths.size() * axes.radii.size() * axes.ratios.size();
  const double mesh = detail == Detail::Coarse ? 1 / kFinerTime : finer;
  out.work += static_cast<double>(out.balls) * kBallTime * mesh;
  out.bytes += 2 * static_cast<double>(out.balls * axes.ball_size());
  return out;
}

std::string forecast_text(const Forecast& forecast, std::size_t cores) {
  char text[240];
  std::snprintf(
      text,
      sizeof text,
      "%zu curves%s; about %.0f min on %zu processors, a file of about %.0f kB, "
      "interpolation within about %.2g %% of the force",
      forecast.curves,
      forecast.balls > 0
          ? (" and " + std::to_string(forecast.balls) + " balls beside their axis").c_str()
          : "",
      std::ceil(forecast.work / 60 / static_cast<double>(cores)),
      cores,
      forecast.bytes / 1e3,
      100 * forecast.error_share);
  return text;
}

}  // namespace palp::fem
