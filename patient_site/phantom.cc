#include "patient_site/phantom.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <span>
#include <sstream>
#include <utility>
#include <vector>

#include "common/core/check.h"
#include "common/core/conventions.h"
#include "depth/depth_database.h"
#include "patient_site/drawn_tissue.h"
#include "patient_site/phantom_tables.h"

namespace palp::patient {
namespace {

constexpr double kPaperRadius = 15e-3;  // [m], the ball that reproduces the paper's Table I
constexpr double kPaperRatio = 13.1e6 / 15.3e3;  // paper II.B: 13.1 MPa in 15.3 kPa
constexpr double kIndenterRadius = 5e-3;         // [m], paper II.A: 10 mm diameter round tip

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
          .shape = "ball"};
}

/// What a bonded layer of thickness `depth` adds above an inclusion: the thin-layer series
/// (Dimitriadis and others 2002), with half the weight for the finite size. 0: no inclusion.
double layer_factor(double indentation, double depth) noexcept {
  if (depth <= 0) return 1;
  const double chi = std::sqrt(kIndenterRadius * indentation) / depth;
  return 1 + 0.5 * chi * (1.133 + chi * (1.283 + chi * (0.769 + chi * 0.0975)));
}

/// Hertz' law with one round constant, 1897 N/m^1.5 (4/3 E/(1 - nu^2) sqrt(R) of the paper's block
/// is 1898.3).
double closed_form_force(double indentation) noexcept {
  return 1897 * indentation * std::sqrt(indentation);
}

/// Tissue that stiffens as Fung's law does: no shape by which a contact is modelled here.
double exponential_force(double indentation) noexcept {
  return 0.08 * std::expm1(450 * indentation);
}

using Law = double (*)(double indentation) noexcept;

/// A round tip in tissue that stiffens as Fung's law does (Lin, Shreiber, Dimitriadis and Horkay
/// 2009): 8 kPa at first, as liver has, twice as stiff as a linear one 4 mm deep.
double fung_force(double indentation) noexcept {
  constexpr double kModulus = 8e3;                         // [Pa]
  constexpr double kStiffening = 6;                        // [-]
  constexpr double kScale = 80 / 27.0 / std::numbers::pi;  // [-]: small strains are Hertz's
  const double area = std::numbers::pi * kIndenterRadius * indentation;
  const double stretch = 1 - 0.2 * std::sqrt(indentation / kIndenterRadius);
  const double stress = 1 / (stretch * stretch) - stretch;
  const double strain = stretch * stretch + 2 / stretch - 3;
  return kScale * kModulus * area * stress * std::exp(kStiffening * strain);
}

/// Skin over fat over muscle: a membrane and soft fat, and from 2 mm on, within some tenths of a
/// millimetre, muscle (moduli of the orders of Pailler-Mattei and others 2008).
double layered_force(double indentation) noexcept {
  constexpr double kSkin = 60;      // [N/m]
  constexpr double kFat = 503;      // [N/m^1.5], 4 kPa
  constexpr double kMuscle = 120;   // [N/m]
  constexpr double kBegins = 2e-3;  // [m]
  constexpr double kWithin = 2e-4;  // [m]
  const auto soft_step = [](double x) { return kWithin * std::log1p(std::exp(x / kWithin)); };
  return kSkin * indentation + kFat * indentation * std::sqrt(indentation) +
         kMuscle * (soft_step(indentation - kBegins) - soft_step(-kBegins));
}

/// Tabulated so finely that the table stands for the law (relative difference below 1e-5 from
/// 0.05 mm on), to as deep as any gate lets a stage go.
ForceTable law_table(Law law, double depth) {
  constexpr int kRows = 1500;
  constexpr double kStep = 1e-5;  // [m]
  std::vector<ForceRow> rows(kRows + 1);
  for (int i = 0; i <= kRows; ++i) {
    const double indentation = kStep * i;
    rows[static_cast<std::size_t>(i)] = {indentation,
                                         law(indentation) * layer_factor(indentation, depth)};
  }
  Result<ForceTable> table = ForceTable::make(std::move(rows));
  PALP_CHECK(table.has_value(), "the law makes a sound table");
  return std::move(*table);
}

/// A law and the depth of the inclusion, after the colon of its name.
struct NamedLaw {
  std::string_view name;
  Law force;
  Relaxation relaxation;
};

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

/// "12.5,-3" as millimetres.
std::optional<Place> place_in(std::string_view text) {
  const auto comma = text.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  std::array<double, 2> values{};
  std::array<std::string_view, 2> parts{text.substr(0, comma), text.substr(comma + 1)};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const char* end = parts[i].data() + parts[i].size();
    const auto [stop, error] = std::from_chars(parts[i].data(), end, values[i]);
    if (error != std::errc{} || stop != end) return std::nullopt;
    values[i] *= kMillimetre;
    if (!(std::abs(values[i]) <= kPlaceMax)) return std::nullopt;
  }
  return Place{values[0], values[1]};
}

/// "ball depth=12 radius=8 ratio=200 at=20,0": words of a phantom from the depth database; lengths
/// in mm. `axis` stays where it was unless the words say.
Result<depth::DepthDatabase::Query> database_query(std::string_view spec, Place& axis) {
  const auto wrong = [&](const std::string& sentence) {
    return fail("phantom '" + std::string{spec} + "': " + sentence);
  };
  depth::DepthDatabase::Query query{
      .shape = fem::InclusionShape::Ball, .depth = 0, .radius = kPaperRadius, .ratio = kPaperRatio};
  std::istringstream words{std::string{spec}};
  std::string word;
  words >> word;
  if (word == "cylinder") query.shape = fem::InclusionShape::Cylinder;
  while (words >> word) {
    const auto mark = word.find('=');
    const std::string name = word.substr(0, mark);
    const std::string text = mark == std::string::npos ? "" : word.substr(mark + 1);
    if (name == "at") {
      const std::optional<Place> place = place_in(text);
      if (!place) return wrong("'" + word + "' is not at=X_MM,Y_MM within 250 mm of the middle");
      axis = *place;
      continue;
    }
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || stop != text.data() + text.size() || !std::isfinite(value)) {
      return wrong("'" + word + "' is not NAME=NUMBER");
    }
    if (name == "depth") {
      query.depth = value * kMillimetre;
    } else if (name == "radius") {
      query.radius = value * kMillimetre;
    } else if (name == "ratio") {
      query.ratio = value;
    } else {
      return wrong("'" + name +
                   "' is unknown; there are depth, radius (mm), ratio and at=X_MM,Y_MM");
    }
  }
  return query;
}

ForceTable database_table(const depth::DepthDatabase& database,
                          const depth::DepthDatabase::Curve& curve) {
  constexpr double kStep = 20e-6;  // [m]; the table's own interpolation is exact to 1e-5 then
  std::vector<ForceRow> rows;
  const int count = static_cast<int>(curve.indentation_max / kStep + 1e-6);
  for (int i = 0; i <= count; ++i) rows.push_back({i * kStep, database.force(curve, i * kStep)});
  Result<ForceTable> table = ForceTable::make(std::move(rows));
  PALP_CHECK(table.has_value(), "the database makes a sound table");
  return std::move(*table);
}

Result<Phantom> database_phantom(std::string_view spec) {
  Place axis = kSiteB;
  const auto query = database_query(spec, axis);
  if (!query) return tl::unexpected(query.error());
  const auto database = depth::default_database();
  if (!database) return fail("phantom '" + std::string{spec} + "': " + database.error().text);
  if (const auto ok = database->contains(*query); !ok) {
    return fail("phantom '" + std::string{spec} + "': " + ok.error().text);
  }
  return Phantom{.name = std::string{spec},
                 .plain = database_table(*database, database->plain()),
                 .over = database_table(*database, database->curve(*query)),
                 .depth = query->depth,
                 .radius = query->radius,
                 .ratio = query->ratio,
                 .shape = std::string{to_string(query->shape)},
                 .axis = axis};
}

/// [m], where all of them still hold.
double common_depth(std::span<const PlacedCurve> curves) noexcept {
  double depth = INFINITY;
  for (const PlacedCurve& curve : curves) depth = std::min(depth, curve.table.depth_max());
  return depth;
}

Result<Phantom> file_phantom(std::string_view spec, std::string_view path) {
  if (path.empty()) return fail("phantom 'file:' names no file; write file:PATH.csv");
  Result<std::vector<PlacedCurve>> curves = load_tissue_curves(std::string{path}, kSiteB);
  if (!curves) return fail("phantom '" + std::string{spec} + "'", curves.error());
  const bool several = curves->size() > 1;
  const double depth = common_depth(*curves);
  const auto [softest, stiffest] = std::minmax_element(
      curves->begin(), curves->end(), [&](const PlacedCurve& a, const PlacedCurve& b) {
        return a.table.force(depth) < b.table.force(depth);
      });
  return Phantom{.name = std::string{spec},
                 .plain = several ? softest->table : embedded("neo_homog"),
                 .over = stiffest->table,
                 .depth = std::nullopt,
                 .radius = std::nullopt,
                 .ratio = std::nullopt,
                 .shape = "unknown",
                 .axis = stiffest->place,
                 .survey = several ? std::move(*curves) : std::vector<PlacedCurve>{}};
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

void append_rows(std::string& text, const Place& place, const ForceTable& table) {
  std::array<char, 96> line{};
  for (const ForceRow& row : table.rows()) {
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

/// exp(-sqrt(t/T)) is a sum over rates k of exp(-k t), of which those below k are
/// erfc(1/(2 sqrt(k T))) (Laplace): cut into parts by the mean of their logarithms.
Relaxation stretched_relaxation(double share, double time) noexcept {
  constexpr double kSlowest = 0.03;  // [-], least rate in units of 1/time, beyond it all is one
  constexpr double kPace = 3;        // [-], of rates
  const auto below = [](double rate) { return std::erfc(0.5 / std::sqrt(rate)); };
  Relaxation relaxation;
  double rate = kSlowest;
  double before = 0;
  for (std::size_t k = 0; k < Relaxation::kParts; ++k, rate *= kPace) {
    const double until = k + 1 < Relaxation::kParts ? below(rate * std::sqrt(kPace)) : 1;
    relaxation.parts[k] = {.share = share * (until - before), .time = time / rate};
    before = until;
  }
  return relaxation;
}

double Phantom::depth_max() const noexcept {
  return std::min({plain.depth_max(), over.depth_max(), common_depth(survey)});
}

std::unique_ptr<TissueField> make_field(const Phantom& phantom, double viscous_factor) {
  if (!phantom.survey.empty()) {
    return std::make_unique<SurveyField>(phantom.survey, viscous_factor);
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
                   .shape = "none"};
  }
  // Silicone rubber loses about a tenth of its force within seconds, and so the one that relaxes.
  // What drains: flesh loses more than silicone, and at all times at once.
  const std::array laws{
      NamedLaw{"closed-form", closed_form_force, {}},
      NamedLaw{"exponential", exponential_force, {}},
      NamedLaw{"relaxing", closed_form_force, {{Relaxation::Part{.share = 0.1, .time = 1}}}},
      NamedLaw{"draining", fung_force, stretched_relaxation(0.2, 2)},
      NamedLaw{"layered", layered_force, {}}};
  for (const NamedLaw& law : laws) {
    const bool named = spec.starts_with(law.name) &&
                       (spec.size() == law.name.size() || spec[law.name.size()] == ':');
    if (named) return law_phantom(spec, law);
  }
  if (spec.starts_with("ball ") || spec.starts_with("cylinder ")) return database_phantom(spec);
  constexpr std::string_view kRandom = "random:";
  if (spec.starts_with(kRandom)) return random_phantom(spec, spec.substr(kRandom.size()));
  constexpr std::string_view kFile = "file:";
  if (spec.starts_with(kFile)) return file_phantom(spec, spec.substr(kFile.size()));
  return fail("unknown phantom '" + std::string{spec} +
              "'; there are paper-5mm, paper-10mm, paper-15mm, paper-20mm, paper-25mm, none, "
              "closed-form[:DEPTH_MM], exponential[:DEPTH_MM], relaxing[:DEPTH_MM], "
              "draining[:DEPTH_MM], layered[:DEPTH_MM], random:SEED, file:PATH.csv and "
              "\"ball depth=12 radius=8 ratio=200 at=20,0\" (or cylinder)");
}

std::string tissue_csv(const Phantom& phantom) {
  std::string text = "x_mm,y_mm,d_mm,F_N\n";
  for (const PlacedCurve& curve : phantom.survey) append_rows(text, curve.place, curve.table);
  if (!phantom.survey.empty()) return text;
  append_rows(text, kSiteA, phantom.plain);
  append_rows(text, phantom.axis, phantom.over);
  return text;
}

}  // namespace palp::patient
