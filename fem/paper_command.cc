#include "fem/paper_command.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <utility>

#include "common/config/json.h"
#include "common/config/report.h"
#include "common/core/conventions.h"

namespace palp::fem {
namespace {

using config::ExitCode;
using config::ExitStatus;

/// Paper, Table I.
struct TableRow {
  double depth_mm{};         ///< [mm], exact
  double hash_n{};           ///< [N], of the paper's model
  double estimated_mm{};     ///< [mm], as printed
  double measured_hash_n{};  ///< [N], of the experiment
};
constexpr std::array<TableRow, 3> kTable{{{5, 0.0920196, 5.1039, 0.0925485},
                                          {10, 0.0691126, 9.8251, 0.0697493},
                                          {15, 0.0637914, 13.2451, 0.0654103}}};
constexpr double kOff = 0.01;         // of a published number
constexpr double kSampleStep = 0.25;  // [mm], between the points of a cubic

[[gnu::format(printf, 2, 3)]] void print(std::string& to, const char* format, ...) {
  std::array<char, 256> line{};
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line.data(), line.size(), format, arguments);
  va_end(arguments);
  to += line.data();
}

const TableRow* published(double depth_mm) {
  const auto* const row = std::find_if(kTable.begin(), kTable.end(), [&](const TableRow& one) {
    return std::abs(one.depth_mm - depth_mm) < 1e-9;
  });
  return row == kTable.end() ? nullptr : row;
}

Result<PaperPhantom> solve_phantom(const PaperFlags& flags, double depth_mm) {
  CurveRequest request;
  request.model = flags.model == "l1" ? Model::Linear : Model::NeoHookean;
  request.accuracy = flags.accuracy == "fine" ? Accuracy::Fine : Accuracy::Normal;
  request.with_error = false;
  if (depth_mm > 0) {
    request.specimen.inclusion = {.shape = InclusionShape::Ball,
                                  .depth = depth_mm * kMillimetre,
                                  .radius = flags.radius_mm * kMillimetre};
  }
  PaperPhantom phantom;
  phantom.depth_mm = depth_mm;
  const int count = std::max(4, static_cast<int>(std::lround(flags.range_mm / kSampleStep)));
  for (int i = 0; i <= count; ++i) {
    phantom.indentations_mm.push_back(flags.range_mm * i / count);
    request.indentations.push_back(phantom.indentations_mm.back() * kMillimetre);
  }
  const auto curve = solve_curve(request);
  if (!curve) return tl::unexpected<Error>(curve.error());
  for (const CurveRow& row : curve->rows) phantom.forces_n.push_back(row.force);
  phantom.cubic = fit_cubic(phantom.indentations_mm, phantom.forces_n);
  return phantom;
}

config::Json numbers(const std::array<double, 4>& values) {
  config::Json out;
  for (const double value : values) out.push_back(value);
  return out;
}

void print_phantom(std::string& to, const PaperStudy& study, const PaperPhantom& phantom) {
  const auto& c = phantom.cubic.coefficients;
  const double hash = phantom.cubic.hash();
  if (phantom.depth_mm > 0) {
    print(to, "%8.1f", phantom.depth_mm);
  } else {
    to += "    none";
  }
  print(to, " %11.3e %11.3e %11.3e %11.3e %9.5f", c[0], c[1], c[2], c[3], hash);
  const TableRow* const row = published(phantom.depth_mm);
  const double wanted = row != nullptr         ? row->hash_n
                        : phantom.depth_mm > 0 ? 0
                                               : kPaperFormula.pole;
  if (wanted > 0) {
    print(to, " %9.5f %7.2f", wanted, 100 * (hash / wanted - 1));
  } else {
    to += "         -       -";
  }
  if (phantom.depth_mm > 0) {
    print(to, " %9.2f %9.2f", kPaperFormula.depth_mm(hash), study.refitted.depth_mm(hash));
  }
  to += "\n";
}

void print_formula(std::string& to, const char* name, const DepthFormula& formula) {
  const auto& p = formula.numerator;
  print(to,
        "  %-9s depth = (%.5g h^3 %+.5g h^2 %+.5g h %+.5g) / (h - %.5f)\n",
        name,
        p[0],
        p[1],
        p[2],
        p[3],
        formula.pole);
}

void print_table(std::string& to, const PaperStudy& study) {
  to += "Table I: the paper's numbers and ours; depths in mm, h in N\n";
  to += "                 model's h      |  from the h the paper measured\n";
  to +=
      "   depth     paper      ours    |  h measured  printed  by (3)  error %  by refit  error "
      "%\n";
  for (const TableRow& row : kTable) {
    const PaperPhantom* const ours = study.at(row.depth_mm);
    const double refit = study.refitted.depth_mm(row.measured_hash_n);
    print(to,
          "%8.1f  %9.6f %9.6f   |   %9.6f %8.4f %7.2f %8.1f %9.2f %8.1f\n",
          row.depth_mm,
          row.hash_n,
          ours == nullptr ? 0 : ours->cubic.hash(),
          row.measured_hash_n,
          row.estimated_mm,
          kPaperFormula.depth_mm(row.measured_hash_n),
          100 * (row.estimated_mm / row.depth_mm - 1),
          refit,
          100 * (refit / row.depth_mm - 1));
  }
}

plot::Panel formula_panel(const PaperStudy& study) {
  plot::Panel panel;
  panel.axes = {
      .title = "Fig. 5: depth over hash, eq. (3)", .x_name = "hash h [N]", .y_name = "depth [mm]"};
  plot::Curve ours{
      .name = "our phantoms", .x = {}, .y = {}, .mark = plot::Mark::Points, .colour = 0};
  plot::Curve refit{.name = "(3) refitted", .x = {}, .y = {}, .colour = 0};
  for (const PaperPhantom& phantom : study.phantoms) {
    ours.x.push_back(phantom.cubic.hash());
    ours.y.push_back(phantom.depth_mm);
  }
  plot::Curve printed{
      .name = "(3) as printed", .x = {}, .y = {}, .mark = plot::Mark::Dashes, .colour = 1};
  const double most = std::max(kTable[0].measured_hash_n, ours.x.front());
  for (int i = 0; i <= 300; ++i) {
    // Denser near the pole, where it is steep.
    const double share = std::pow(i / 300.0, 2);
    const double least = ours.x.back();
    const double h = least + (most - least) * share;
    refit.x.push_back(h);
    refit.y.push_back(study.refitted.depth_mm(h));
    printed.x.push_back(h);
    printed.y.push_back(kPaperFormula.depth_mm(h));
  }
  plot::Curve model{
      .name = "the paper's model", .x = {}, .y = {}, .mark = plot::Mark::Points, .colour = 1};
  plot::Curve measured{
      .name = "the paper measured", .x = {}, .y = {}, .mark = plot::Mark::Points, .colour = 2};
  for (const TableRow& row : kTable) {
    model.x.push_back(row.hash_n);
    model.y.push_back(row.depth_mm);
    measured.x.push_back(row.measured_hash_n);
    measured.y.push_back(row.estimated_mm);
  }
  panel.curves = {refit, printed, ours, model, measured};
  return panel;
}

plot::Panel force_panel(const PaperStudy& study) {
  plot::Panel panel;
  panel.axes = {.title = "Fig. 8: force over indentation (points) and its cubic, eq. (2)",
                .x_name = "indentation [mm]",
                .y_name = "force [N]",
                .y_from = 0,
                .y_to = study.phantoms.front().forces_n.back()};
  std::vector<const PaperPhantom*> shown;
  for (const double depth : {5.0, 10.0, 15.0, 20.0, 25.0}) shown.push_back(study.at(depth));
  shown.push_back(&study.plain);
  int colour = 0;
  for (const PaperPhantom* const phantom : shown) {
    if (phantom == nullptr) continue;
    char name[32] = "no inclusion";
    if (phantom->depth_mm > 0) {
      std::snprintf(name, sizeof name, "%g mm deep", phantom->depth_mm);
    }
    plot::Curve cubic{.name = name, .x = {}, .y = {}, .colour = colour};
    const double most = phantom->indentations_mm.back();
    for (int i = 0; i <= 80; ++i) {
      cubic.x.push_back(most * i / 80);
      cubic.y.push_back(phantom->cubic.force(cubic.x.back()));
    }
    panel.curves.push_back(cubic);
    panel.curves.push_back({.name = "",
                            .x = phantom->indentations_mm,
                            .y = phantom->forces_n,
                            .mark = plot::Mark::Points,
                            .colour = colour});
    ++colour;
  }
  return panel;
}

}  // namespace

const PaperPhantom* PaperStudy::at(double depth_mm) const noexcept {
  for (const PaperPhantom& phantom : phantoms) {
    if (std::abs(phantom.depth_mm - depth_mm) < 1e-9) return &phantom;
  }
  return nullptr;
}

void declare_paper(config::CommandLine& line, PaperFlags& flags) {
  line.choice("--model", flags.model, {"l1", "neo"}, "small strain, or finite neo-Hookean");
  line.choice("--accuracy", flags.accuracy, {"normal", "fine"}, "of the mesh");
  line.number("--radius-mm",
              flags.radius_mm,
              {.min = 1, .max = 15.8, .unit = "mm"},
              "of the ball; the paper does not print it");
  line.number("--range-mm",
              flags.range_mm,
              {.min = 1, .max = 4, .unit = "mm"},
              "indentations of the cubic, from 0");
  plot::declare_picture(line, flags.picture, "a picture: Fig. 5 and Fig. 8");
  line.report(flags.report, "palp.paper/1");
}

Result<PaperStudy> study_paper(const PaperFlags& flags) {
  PaperStudy study;
  auto plain = solve_phantom(flags, 0);
  if (!plain) return tl::unexpected<Error>(plain.error());
  study.plain = std::move(*plain);
  std::vector<double> hashes;
  std::vector<double> depths;
  const int steps = static_cast<int>(std::lround(20 / flags.step_mm));
  for (int i = 0; i <= steps; ++i) {
    const double depth = 5 + 20.0 * i / steps;
    auto phantom = solve_phantom(flags, depth);
    if (!phantom) return tl::unexpected<Error>(phantom.error());
    hashes.push_back(phantom->cubic.hash());
    depths.push_back(depth);
    study.phantoms.push_back(std::move(*phantom));
  }
  const auto formula = fit_formula(hashes, depths, study.plain.cubic.hash());
  if (!formula) return tl::unexpected<Error>(formula.error());
  study.refitted = *formula;
  return study;
}

std::string paper_text(const PaperStudy& study) {
  std::string text =
      "The paper's phantom (section II.B) with a ball, and its estimator (eqs. (2), (3))\n"
      "eq. (2): f = c1 d^3 + c2 d^2 + c3 d + c4, d in mm, f in N; h = c1 + c2 + c3 + c4\n"
      "   depth          c1          c2          c3          c4         h   paper's  off by   "
      "depth "
      "by (3):  \n"
      "      mm                                                                  h       %   "
      "printed "
      " refitted\n";
  for (const PaperPhantom& phantom : study.phantoms) print_phantom(text, study, phantom);
  print_phantom(text, study, study.plain);
  text +=
      "(the paper's h of no inclusion is the pole of its eq. (3))\neq. (3), h in N, depth in mm\n";
  print_formula(text, "printed:", kPaperFormula);
  print_formula(text, "refitted:", study.refitted);
  print_table(text, study);
  return text;
}

plot::Figure paper_figure(const PaperStudy& study) {
  return {.title = "The paper's phantom and estimator",
          .panels = {formula_panel(study), force_panel(study)}};
}

std::string paper_report(const PaperStudy& study) {
  config::Json out;
  out["schema"] = "palp.paper/1";
  out["phantoms"] = config::Json::array();
  for (const PaperPhantom& phantom : study.phantoms) {
    config::Json row;
    const double hash = phantom.cubic.hash();
    const TableRow* const paper = published(phantom.depth_mm);
    row["depth_mm"] = phantom.depth_mm;
    row["coefficients"] = numbers(phantom.cubic.coefficients);
    row["h_n"] = hash;
    row["paper_h_n"] = nullptr;
    if (paper != nullptr) row["paper_h_n"] = paper->hash_n;
    row["printed_formula_mm"] = kPaperFormula.depth_mm(hash);
    row["refitted_formula_mm"] = study.refitted.depth_mm(hash);
    out["phantoms"].push_back(row);
  }
  out["plain_h_n"] = study.plain.cubic.hash();
  out["paper_pole_n"] = kPaperFormula.pole;
  out["refitted"] = {{"numerator", numbers(study.refitted.numerator)},
                     {"pole_n", study.refitted.pole}};
  out["table"] = config::Json::array();
  for (const TableRow& row : kTable) {
    out["table"].push_back(
        {{"depth_mm", row.depth_mm},
         {"measured_h_n", row.measured_hash_n},
         {"paper_estimate_mm", row.estimated_mm},
         {"refitted_estimate_mm", study.refitted.depth_mm(row.measured_hash_n)}});
  }
  out["missed"] = paper_misses(study);
  return out.dump(2) + "\n";
}

std::vector<std::string> paper_misses(const PaperStudy& study) {
  std::vector<std::string> missed;
  const auto compare = [&](const std::string& name, double found, double wanted) {
    if (std::abs(found / wanted - 1) <= kOff) return;
    char text[96];
    std::snprintf(
        text, sizeof text, "%s is %.5f N, the paper's %.5f N", name.c_str(), found, wanted);
    missed.emplace_back(text);
  };
  for (const TableRow& row : kTable) {
    const PaperPhantom* const ours = study.at(row.depth_mm);
    if (ours != nullptr) {
      compare("h at " + std::to_string(std::lround(row.depth_mm)) + " mm",
              ours->cubic.hash(),
              row.hash_n);
    }
  }
  compare("h of the plain block", study.plain.cubic.hash(), kPaperFormula.pole);
  return missed;
}

ExitStatus run_paper(const PaperFlags& flags) {
  const auto study = study_paper(flags);
  if (!study) return {ExitCode::BadInput, "palp-fem: " + study.error().text};
  auto written = plot::write_picture(paper_figure(*study), flags.picture);
  if (written && !flags.report.empty()) {
    written = config::write_whole_file(flags.report, paper_report(*study));
  }
  if (!written) return {ExitCode::CannotOpen, "palp-fem: " + written.error().text};
  const std::string text = paper_text(*study);
  const std::vector<std::string> missed = paper_misses(*study);
  if (missed.empty()) return {ExitCode::Done, text};
  std::fputs(text.c_str(), stdout);
  return {ExitCode::Missed, "palp-fem: " + missed.front() + ": more than 1 % apart"};
}

}  // namespace palp::fem
