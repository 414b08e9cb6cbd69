#include "patient_site/phantom.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <span>
#include <utility>
#include <vector>

#include "common/core/check.h"
#include "common/core/conventions.h"
#include "common/core/whole_file.h"
#include "patient_site/drawn_tissue.h"
#include "patient_site/phantom_tables.h"
#include "patient_site/plain_laws.h"
#include "patient_site/tissue_words.h"

namespace palp::patient {
namespace {

constexpr double kPaperTip = 5e-3;  // [m], paper II.A: 10 mm diameter round tip

ForceTable embedded(std::string_view name) {
  Result<ForceTable> table = parse_force_table(phantom_table(name), name);
  PALP_CHECK(table.has_value(), "an embedded table is sound");
  return std::move(*table);
}

Phantom paper_phantom(std::string_view spec, std::string_view table, double depth) {
  return {.name = std::string{spec},
          .plain = embedded("neo_homog"),
          .over = embedded(table),
          .depth = depth,
          .radius = kPaperRadius,
          .ratio = kPaperRatio,
          .shape = "ball",
          .tip_radius = kPaperTip};
}

/// A law and the depth of the inclusion, after the colon of its name.
Result<Phantom> law_phantom(std::string_view spec, const NamedLaw& law) {
  double depth_mm = 5;
  const std::string_view depth_text = spec.substr(std::min(spec.size(), law.name.size() + 1));
  if (spec.size() > law.name.size()) {
    const char* end = depth_text.data() + depth_text.size();
    const auto [stop, error] = std::from_chars(depth_text.data(), end, depth_mm);
    if (error != std::errc{} || stop != end || !(depth_mm >= 2 && depth_mm <= 100)) {
      return fail("phantom '" + std::string{spec} +
                  "': the depth must be a number from 2 to 100 (mm)");
    }
  }
  return Phantom{.name = std::string{spec},
                 .plain = law_table(law.force, 0),
                 .over = law_table(law.force, depth_mm * kMillimetre),
                 .depth = depth_mm * kMillimetre,
                 .radius = std::nullopt,
                 .ratio = std::nullopt,
                 .shape = "unknown",
                 .relaxation = law.relaxation};
}

/// The curves above the inclusions of a block hold to where all were solved.
double solved_depth(const BlockTissue& block) {
  double depth = block.database->plain().indentation_max;
  for (const PlacedInclusion& one : block.inclusions) {
    depth = std::min(depth, block.database->curve(one.body).indentation_max);
  }
  return depth;
}

/// The force at one place over the indentation. [m]
std::vector<ForceRow> rows_at(const TissueField& field, const Place& place, double depth) {
  constexpr double kStep = 20e-6;  // [m]
  std::vector<ForceRow> rows;
  const int count = static_cast<int>(depth / kStep + 1e-6);
  for (int i = 0; i <= count; ++i)
    rows.push_back({i * kStep, field.elastic_force(place, i * kStep)});
  return rows;
}

Result<Phantom> block_phantom(std::string_view spec, std::string_view text) {
  auto described = parse_tissue_words(text);
  if (!described) return fail("phantom '" + std::string{spec} + "'", described.error());
  BlockTissue block = std::move(described->block);
  auto made = plain_table(block);
  if (!made) return fail("phantom '" + std::string{spec} + "'", made.error());
  const ForceTable& plain = *made;
  Phantom phantom{.name = std::string{spec},
                  .plain = plain,
                  .over = plain,
                  .depth = std::nullopt,
                  .radius = std::nullopt,
                  .ratio = std::nullopt,
                  .shape = "none",
                  .relaxation = described->relaxation,
                  .tip_radius = block.database->grid().indenter_radius};
  if (!block.inclusions.empty()) {
    const PlacedInclusion& first = block.inclusions.front();
    phantom.axis = first.axis;
    phantom.depth = first.body.depth;
    phantom.radius = first.body.radius;
    phantom.ratio = first.body.ratio;
    phantom.shape = std::string{to_string(first.body.shape)};
  }
  auto over =
      ForceTable::make(rows_at(BlockField{block, plain, 0}, phantom.axis, solved_depth(block)));
  if (!over) {
    return fail("phantom '" + std::string{spec} + "': the force above the inclusion", over.error());
  }
  phantom.over = std::move(*over);
  phantom.block = std::move(block);
  phantom.words = std::string{text};
  return phantom;
}

/// [m], where all of them still hold.
double common_depth(std::span<const PlacedCurve> curves) noexcept {
  double depth = INFINITY;
  for (const PlacedCurve& curve : curves) depth = std::min(depth, curve.table.depth_max());
  return depth;
}

/// The one curve of a table without places, or with one.
Result<ForceTable> single_curve(const std::string& path) {
  auto curves = load_tissue_curves(path, kSiteA);
  if (!curves) return tl::unexpected(curves.error());
  if (curves->size() > 1) {
    return fail(path + " has curves at " + std::to_string(curves->size()) +
                " places, expected one: what lies beside the inclusion is one tissue");
  }
  return std::move(curves->front().table);
}

/// One curve: that over an inclusion. What lies beside it says `beside`, "paper" or a table's path.
Result<Phantom> two_curves(std::string_view spec,
                           const PlacedCurve& over,
                           const std::string& beside) {
  const bool told = !beside.empty() && beside != "paper";
  auto plain = told ? single_curve(beside) : Result<ForceTable>{embedded("neo_homog")};
  if (!plain) return fail("phantom '" + std::string{spec} + "'", plain.error());
  return Phantom{
      .name = std::string{spec},
      .plain = std::move(*plain),
      .over = over.table,
      .depth = std::nullopt,
      .radius = std::nullopt,
      .ratio = std::nullopt,
      .shape = "unknown",
      .axis = over.place,
      .caution = beside.empty()
                     ? "the table has one curve; beside it the tissue is the paper's block of 15.3 "
                       "kPa. Say beside=paper, or beside=TABLE.csv, or give curves at more places"
                     : ""};
}

Result<Phantom> surveyed_phantom(std::string_view spec, std::vector<PlacedCurve> curves) {
  const double depth = common_depth(curves);
  const auto [softest, stiffest] = std::minmax_element(
      curves.begin(), curves.end(), [&](const PlacedCurve& a, const PlacedCurve& b) {
        return a.table.force(depth) < b.table.force(depth);
      });
  return Phantom{.name = std::string{spec},
                 .plain = softest->table,
                 .over = stiffest->table,
                 .depth = std::nullopt,
                 .radius = std::nullopt,
                 .ratio = std::nullopt,
                 .shape = "unknown",
                 .axis = stiffest->place,
                 .survey = std::move(curves)};
}

/// "PATH" or "PATH beside=PATH": curves, or the words of a tissue.
Result<Phantom> file_phantom(std::string_view spec, std::string_view words) {
  constexpr std::string_view kBeside = " beside=";
  const auto mark = words.rfind(kBeside);
  const std::string path{words.substr(0, mark)};
  const std::string beside{mark == std::string_view::npos ? ""
                                                          : words.substr(mark + kBeside.size())};
  if (path.empty()) return fail("phantom 'file:' names no file; write file:PATH.csv");
  const auto text = read_whole_file(path, kTextSizeMax);
  if (!text) return fail("phantom '" + std::string{spec} + "'", text.error());
  if (are_tissue_words(*text)) return block_phantom(spec, *text);
  auto curves = parse_tissue_curves(*text, path, kSiteB);
  if (!curves) return fail("phantom '" + std::string{spec} + "'", curves.error());
  if (curves->size() == 1) return two_curves(spec, curves->front(), beside);
  if (!beside.empty()) {
    return fail("phantom '" + std::string{spec} +
                "': beside= is for a table of one curve; this one has several places");
  }
  return surveyed_phantom(spec, std::move(*curves));
}

Result<Phantom> random_phantom(std::string_view spec, std::string_view seed_text) {
  std::uint64_t seed = 0;
  const char* end = seed_text.data() + seed_text.size();
  const auto [stop, error] = std::from_chars(seed_text.data(), end, seed);
  if (error != std::errc{} || stop != end) {
    return fail("phantom '" + std::string{spec} + "': the seed must be a whole number");
  }
  return drawn_tissue(seed);
}

void append_rows(std::string& text, const Place& place, std::span<const ForceRow> rows) {
  std::array<char, 96> line{};
  for (const ForceRow& row : rows) {
    std::snprintf(line.data(),
                  line.size(),
                  "%.9g,%.9g,%.9g,%.9g\n",
                  place.x / kMillimetre,
                  place.y / kMillimetre,
                  row.indentation / kMillimetre,
                  row.force);
    text += line.data();
  }
}

}  // namespace

double Phantom::depth_max() const noexcept {
  return std::min({plain.depth_max(), over.depth_max(), common_depth(survey)});
}

std::unique_ptr<TissueField> make_field(const Phantom& phantom, double viscous_factor) {
  if (!phantom.survey.empty()) {
    return std::make_unique<SurveyField>(phantom.survey, viscous_factor);
  }
  if (phantom.block) {
    return std::make_unique<BlockField>(*phantom.block, phantom.plain, viscous_factor);
  }
  return std::make_unique<InclusionField>(
      phantom.plain, phantom.over, phantom.axis, viscous_factor);
}

Result<Phantom> make_phantom(std::string_view spec) {
  struct Named {
    std::string_view name;
    std::string_view table;
    double depth;  ///< [m]
  };
  constexpr std::array kPaper{Named{"paper-5mm", "neo_sphere_r15_d5_k856", 5e-3},
                              Named{"paper-10mm", "neo_sphere_r15_d10_k856", 10e-3},
                              Named{"paper-15mm", "neo_sphere_r15_d15_k856", 15e-3},
                              Named{"paper-20mm", "neo_sphere_r15_d20_k856", 20e-3},
                              Named{"paper-25mm", "neo_sphere_r15_d25_k856", 25e-3}};
  for (const Named& named : kPaper) {
    if (spec == named.name) return paper_phantom(spec, named.table, named.depth);
  }
  if (spec == "none") {
    return Phantom{.name = "none",
                   .plain = embedded("neo_homog"),
                   .over = embedded("neo_homog"),
                   .depth = std::nullopt,
                   .radius = std::nullopt,
                   .ratio = std::nullopt,
                   .shape = "none",
                   .tip_radius = kPaperTip};
  }
  if (const auto law = plain_law(spec.substr(0, spec.find(':')))) return law_phantom(spec, *law);
  if (are_tissue_words(spec)) return block_phantom(spec, spec);
  constexpr std::string_view kRandom = "random:";
  if (spec.starts_with(kRandom)) return random_phantom(spec, spec.substr(kRandom.size()));
  constexpr std::string_view kFile = "file:";
  if (spec.starts_with(kFile)) return file_phantom(spec, spec.substr(kFile.size()));
  return fail(
      "unknown phantom '" + std::string{spec} +
      "'; there are paper-5mm, paper-10mm, paper-15mm, paper-20mm, paper-25mm, none, "
      "closed-form[:DEPTH_MM], exponential[:DEPTH_MM], relaxing[:DEPTH_MM], "
      "draining[:DEPTH_MM], layered[:DEPTH_MM], random:SEED, file:PATH and words of a tissue "
      "(\"ball depth=12 radius=8 ratio=200 at=20,0; block e_kpa=18 varies=0.05\")");
}

std::string tissue_csv(const Phantom& phantom) {
  std::string text = "x_mm,y_mm,d_mm,F_N\n";
  for (const PlacedCurve& curve : phantom.survey)
    append_rows(text, curve.place, curve.table.rows());
  if (!phantom.survey.empty()) return text;
  if (!phantom.block) {
    append_rows(text, kSiteA, phantom.plain.rows());
    append_rows(text, phantom.axis, phantom.over.rows());
    return text;
  }
  std::vector<Place> places{kSiteA};
  for (const PlacedInclusion& one : phantom.block->inclusions) {
    if (distance(one.axis, kSiteA) >= kPlacesApart) places.push_back(one.axis);
  }
  const BlockField field{*phantom.block, phantom.plain, 0};
  for (const Place& place : places)
    append_rows(text, place, rows_at(field, place, phantom.depth_max()));
  return text;
}

}  // namespace palp::patient
