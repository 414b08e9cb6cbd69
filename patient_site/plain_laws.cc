#include "patient_site/plain_laws.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "common/core/check.h"

namespace palp::patient {
namespace {

constexpr double kIndenterRadius = 5e-3;  // [m], paper II.A: 10 mm diameter round tip

/// Weights of the series' terms, by the power of sqrt(radius * indentation) / thickness.
constexpr std::array kLayerTerms{1.133, 1.283, 0.769, 0.0975};

/// What the layer adds to 1. [-]
double layer_share(double indentation, double thickness) noexcept {
  const double chi = std::sqrt(kIndenterRadius * indentation) / thickness;
  double sum = 0;
  for (std::size_t i = kLayerTerms.size(); i-- > 0;) sum = chi * (kLayerTerms[i] + sum);
  return sum;
}

/// Above an inclusion: half the weight, for its finite size. 0: no inclusion.
double cover_factor(double indentation, double depth) noexcept {
  return depth > 0 ? 1 + 0.5 * layer_share(indentation, depth) : 1;
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

}  // namespace

std::optional<NamedLaw> plain_law(std::string_view name) {
  // Silicone rubber loses about a tenth of its force within seconds, and so the one that relaxes.
  // What drains: flesh loses more than silicone, and at all times at once.
  const std::array laws{
      NamedLaw{"closed-form", closed_form_force, {}},
      NamedLaw{"exponential", exponential_force, {}},
      NamedLaw{"relaxing", closed_form_force, {{Relaxation::Part{.share = 0.1, .time = 1}}}},
      NamedLaw{"draining", fung_force, stretched_relaxation(0.2, 2)},
      NamedLaw{"layered", layered_force, {}}};
  const auto* const named =
      std::find_if(laws.begin(), laws.end(), [&](const NamedLaw& law) { return law.name == name; });
  return named == laws.end() ? std::nullopt : std::optional{*named};
}

double bonded_layer_factor(double indentation, double height) noexcept {
  return 1 + layer_share(indentation, height);
}

ForceTable law_table(PlainLaw law, double depth) {
  constexpr int kRows = 1500;
  constexpr double kStep = 1e-5;  // [m]
  std::vector<ForceRow> rows(kRows + 1);
  for (int i = 0; i <= kRows; ++i) {
    const double indentation = kStep * i;
    rows[static_cast<std::size_t>(i)] = {indentation,
                                         law(indentation) * cover_factor(indentation, depth)};
  }
  Result<ForceTable> table = ForceTable::make(std::move(rows));
  PALP_CHECK(table.has_value(), "the law makes a sound table");
  return std::move(*table);
}

}  // namespace palp::patient
