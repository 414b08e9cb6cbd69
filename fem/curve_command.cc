#include "fem/curve_command.h"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "common/config/number.h"
#include "common/config/report.h"
#include "common/core/conventions.h"
#include "common/core/printable.h"
#include "fem/vtu.h"

namespace palp::fem {
namespace {

using config::ExitCode;
using config::ExitStatus;

constexpr std::size_t kRowsMax = 1000;
// What can be solved is for check() to say, in one place; flags only are numbers.
const config::NumberRange kAnyLength{.min = -1e6, .max = 1e6, .unit = "mm"};
const config::NumberRange kAnyNumber{.min = -1e9, .max = 1e9};

std::vector<std::string> split(const std::string& text, char mark) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == mark) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

}  // namespace

void declare_block(config::CommandLine& line, CurveFlags& flags) {
  line.number("--inclusion-poisson", flags.inclusion_poisson, kAnyNumber, "below 0.5");
  line.number("--youngs-modulus-kpa",
              flags.youngs_modulus_kpa,
              {.min = -1e12, .max = 1e12, .unit = "kPa"},
              "of the block");
  line.number("--poisson", flags.poisson, kAnyNumber, "of the block, below 0.5");
  line.number("--half-width-mm", flags.half_width_mm, kAnyLength, "of the block");
  line.number("--height-mm", flags.height_mm, kAnyLength, "of the block, bonded at its base");
  line.number("--indenter-radius-mm", flags.indenter_radius_mm, kAnyLength, "of the rigid sphere");
}

void declare_curve(config::CommandLine& line, CurveFlags& flags) {
  const auto length = [&](const char* flag, double& value, const char* meaning) {
    line.number(flag, value, kAnyLength, meaning);
  };
  line.choice("--shape", flags.shape, {"ball", "cylinder", "column", "none"}, "of the inclusion");
  length("--depth-mm", flags.depth_mm, "of the inclusion's top below the surface");
  length("--radius-mm", flags.radius_mm, "of the inclusion");
  length("--cylinder-height-mm", flags.cylinder_height_mm, "of a cylinder");
  line.number("--ratio",
              flags.ratio,
              kAnyNumber,
              "Young's modulus of the inclusion over that of the block");
  declare_block(line, flags);
  length("--offset-mm", flags.offset_mm, "of the tip's axis from that of the ball");
  line.number("--tilt-deg",
              flags.tilt_deg,
              {.min = -1e6, .max = 1e6, .unit = "deg"},
              "of the tip's way off the normal, away from the ball");
  length("--surface-radius-mm", flags.surface_radius_mm, "dome > 0, hollow < 0, flat 0");
  line.choice("--model", flags.model, {"l1", "neo"}, "small strain, or finite neo-Hookean");
  line.text("--indentations-mm", flags.indentations_mm, "LIST", "0.5,1,2 or from:to:step");
  line.choice("--accuracy", flags.accuracy, {"coarse", "normal", "fine"}, "of the mesh");
  line.output("--csv", flags.csv, "rows d_mm,F_N,contact_radius_mm,err_N");
  line.output("--vtu", flags.vtu, "deformed section at the largest indentation");
}

Result<std::vector<double>> parse_indentations(const std::string& text) {
  const auto wrong = [&](const std::string& part) {
    return fail("--indentations-mm is \"" + printable(text) + "\": \"" + printable(part) +
                "\" is no number, expected 0.5,1,2 or from:to:step");
  };
  std::vector<double> values;
  const std::vector<std::string> range = split(text, ':');
  for (const std::string& part : range.size() == 3 ? range : split(text, ',')) {
    const auto value = config::parse_number(part);
    if (!value || !(std::abs(*value) < 1e6)) return wrong(part);
    values.push_back(*value * kMillimetre);
  }
  if (range.size() != 3) {
    if (values.size() > kRowsMax) return fail("--indentations-mm: expected at most 1000 values");
    return values;
  }
  const double from = values[0];
  const double step = values[2];
  if (!(step > 0) || !(values[1] >= from)) {
    return fail("--indentations-mm is \"" + printable(text) +
                "\", expected from:to:step with from <= to and step > 0");
  }
  const double count = std::floor((values[1] - from) / step + 1e-6) + 1;
  if (!(count <= static_cast<double>(kRowsMax))) {
    return fail("--indentations-mm: expected at most 1000 values");
  }
  std::vector<double> out;
  for (int i = 0; i < static_cast<int>(count); ++i) out.push_back(from + i * step);
  return out;
}

Result<CurveRequest> curve_request(const CurveFlags& flags) {
  auto indentations = parse_indentations(flags.indentations_mm);
  if (!indentations) return tl::unexpected<Error>(indentations.error());
  CurveRequest request;
  Specimen& specimen = request.specimen;
  specimen.block = {.half_width = flags.half_width_mm * kMillimetre,
                    .height = flags.height_mm * kMillimetre,
                    .youngs_modulus = flags.youngs_modulus_kpa * 1e3,
                    .poisson = flags.poisson};
  specimen.inclusion = {.shape = InclusionShape::None,
                        .depth = flags.depth_mm * kMillimetre,
                        .radius = flags.radius_mm * kMillimetre,
                        .height = flags.cylinder_height_mm * kMillimetre,
                        .ratio = flags.ratio,
                        .poisson = flags.inclusion_poisson};
  for (const InclusionShape shape :
       {InclusionShape::Ball, InclusionShape::Cylinder, InclusionShape::Column}) {
    if (flags.shape == to_string(shape)) specimen.inclusion.shape = shape;
  }
  specimen.indenter.radius = flags.indenter_radius_mm * kMillimetre;
  request.model = flags.model == "l1" ? Model::Linear : Model::NeoHookean;
  request.accuracy = flags.accuracy == "fine"     ? Accuracy::Fine
                     : flags.accuracy == "coarse" ? Accuracy::Coarse
                                                  : Accuracy::Normal;
  request.indentations = std::move(*indentations);
  return request;
}

Approach approach_of(const CurveFlags& flags) {
  const double radius = flags.surface_radius_mm * kMillimetre;
  return {.offset = flags.offset_mm * kMillimetre,
          .tilt = flags.tilt_deg * std::numbers::pi / 180,
          .surface_curvature = radius == 0 ? 0 : 1 / radius};
}

std::string csv_text(const std::vector<CurveRow>& rows) {
  std::string text = "d_mm,F_N,contact_radius_mm,err_N\n";
  for (const CurveRow& row : rows) {
    char line[128];
    std::snprintf(line,
                  sizeof line,
                  "%.9g,%.9g,%.9g,%.9g\n",
                  row.indentation / kMillimetre,
                  row.force,
                  row.contact_radius / kMillimetre,
                  row.error);
    text += line;
  }
  return text;
}

ExitStatus run_curve(const CurveFlags& flags) {
  const auto request = curve_request(flags);
  if (!request) return {ExitCode::BadInput, "palp-fem: " + request.error().text};
  std::vector<CurveRow> rows;
  if (const Approach approach = approach_of(flags); !approach.straight()) {
    if (!flags.vtu.empty()) {
      return {ExitCode::BadInput, "palp-fem: --vtu shows a tip straight above the inclusion alone"};
    }
    auto found = solve_off_axis_curve(*request, approach);
    if (!found) return {ExitCode::BadInput, "palp-fem: " + found.error().text};
    rows = std::move(*found);
  } else {
    auto curve = solve_curve(*request);
    if (!curve) return {ExitCode::BadInput, "palp-fem: " + curve.error().text};
    if (!flags.vtu.empty()) {
      const auto written =
          config::write_whole_file(flags.vtu, vtu_text(*curve, request->specimen, request->model));
      if (!written) return {ExitCode::CannotOpen, "palp-fem: " + written.error().text};
    }
    rows = std::move(curve->rows);
  }
  const std::string text = csv_text(rows);
  if (flags.csv.empty()) return {ExitCode::Done, text};
  if (const auto written = config::write_whole_file(flags.csv, text); !written) {
    if (!flags.vtu.empty()) static_cast<void>(std::remove(flags.vtu.c_str()));
    return {ExitCode::CannotOpen, "palp-fem: " + written.error().text};
  }
  return {ExitCode::Done, ""};
}

}  // namespace palp::fem
