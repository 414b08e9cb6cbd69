#include "depth/place_data.h"

#include <algorithm>
#include <cmath>

#include "common/core/small_solver.h"

namespace palp::depth {
namespace {

constexpr int kFitPasses = 3;         // the steps' bias needs the force, and that the surface
constexpr double kScaleSpread = 0.7;  // [-], of the fit to one place: anything
constexpr double kCurveSpread = 0.3;  // [-], of its shape: an inclusion is in it
constexpr std::size_t kFitted = 3 + kTissueShapes;

/// The normal equations of the force in nodes instead of terms: block (i, j) is that of
/// (curve, curve * shift, curve * rate factor).
struct NodalEquations {
  using Block = std::array<NodalCurve, kCurveNodes>;
  std::array<std::array<Block, 3>, 3> matrix{};
  std::array<NodalCurve, 3> right{};

  explicit NodalEquations(const NormalEquations& sums) {
    for (std::size_t a = 0; a < kCurveNodes; ++a) {
      for (std::size_t i = 0; i < 3; ++i) {
        const NormalEquations::Columns rows = sums.rows(i, node_terms()[a]);
        right[i][a] = sums.along(i, node_terms()[a]);
        for (std::size_t j = i; j < 3; ++j) {
          for (std::size_t b = 0; b < kCurveNodes; ++b) {
            matrix[i][j][a][b] = NormalEquations::between(rows, j, node_terms()[b]);
            matrix[j][i][b][a] = matrix[i][j][a][b];
          }
        }
      }
    }
  }
  [[nodiscard]] double between(std::size_t i,
                               const NodalCurve& one,
                               std::size_t j,
                               const NodalCurve& other) const noexcept {
    double sum = 0;
    for (std::size_t a = 0; a < kCurveNodes; ++a) {
      double row = 0;
      for (std::size_t b = 0; b < kCurveNodes; ++b) row += matrix[i][j][a][b] * other[b];
      sum += one[a] * row;
    }
    return sum;
  }
  [[nodiscard]] double along(std::size_t i, const NodalCurve& curve) const noexcept {
    double sum = 0;
    for (std::size_t a = 0; a < kCurveNodes; ++a) sum += right[i][a] * curve[a];
    return sum;
  }
};

/// The curve that fits one place, whatever lies below: size, shape, surface, rate factor.
struct PlaceFit {
  NodalCurve curve{};  ///< [-], over the plain block's force
  double scale{1};
  double shift{};  ///< [m]
  double rate_factor{};
  double misfit{};
  bool regular{};
};

PlaceFit fit(const NodalEquations& sums,
             const NormalEquations& all,
             const PlaceReadings& readings,
             const NodalCurve& near,
             double scale) {
  NodalCurve one{};
  one.fill(1);
  // Columns: the plain block's curve, its shapes, the surface and the rate of the curve so far.
  std::array<NodalCurve, kFitted> curves{one, tissue_shapes()[0], tissue_shapes()[1], near, near};
  constexpr std::array<std::size_t, kFitted> kBlocks{0, 0, 0, 1, 2};
  SmallSystem<kFitted> system;
  for (std::size_t i = 0; i < kFitted; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      system.matrix[i][j] = sums.between(kBlocks[i], curves[i], kBlocks[j], curves[j]);
    }
    system.right[i] = sums.along(kBlocks[i], curves[i]);
  }
  const double shape = 1 / (scale * scale * kCurveSpread * kCurveSpread);
  const StiffnessPrior& known = readings.stiffness;
  const std::array<double, kFitted> information{
      1 / (kScaleSpread * kScaleSpread),
      shape,
      shape,
      1 / (kSurfaceSpread * kSurfaceSpread),
      1 / (known.rate_factor_stddev * known.rate_factor_stddev)};
  const std::array<double, kFitted> expected{
      known.scale, 0, 0, readings.surface - all.surface(), known.rate_factor};
  for (std::size_t i = 0; i < kFitted; ++i) {
    system.matrix[i][i] += information[i];
    system.right[i] += information[i] * expected[i];
  }
  const auto solution = solve(system);
  PlaceFit out;
  out.regular = solution.regular && solution.x[0] > 0;
  if (!out.regular) return out;
  out.scale = solution.x[0];
  for (std::size_t m = 0; m < kCurveNodes; ++m) {
    out.curve[m] = solution.x[0] + solution.x[1] * tissue_shapes()[0][m] +
                   solution.x[2] * tissue_shapes()[1][m];
  }
  out.shift = solution.x[3];
  out.rate_factor = solution.x[4];
  double known_square = 0;
  double known_now = 0;
  for (std::size_t i = 0; i < kFitted; ++i) {
    known_square += information[i] * expected[i] * expected[i];
    const double off = solution.x[i] - expected[i];
    known_now += information[i] * off * off;
  }
  out.misfit = all.squares() + known_square - solution.explained - known_now;
  return out;
}

TouchModel expected_of(const PlaceFit& fit, double surface) {
  TouchModel out{.curve = {}, .surface = surface, .scale = 1, .rate_factor = fit.rate_factor};
  for (std::size_t n = 0; n < kCurveNodes; ++n) {
    for (std::size_t m = 0; m < kCurveTerms; ++m) out.curve[m] += fit.curve[n] * node_terms()[n][m];
  }
  return out;
}

/// The quadratic form of curve and rate factor. Shift and rate factor multiply the curve that fits,
/// which is near enough whatever the curve turns out to be; the shift, of which the tracker says
/// `off`, goes.
void reduce(const NormalEquations& sums, const PlaceFit& best, double off, PlaceData& out) {
  const NodalEquations nodal{sums};
  const double v = out.rate_factor;
  constexpr std::size_t kLast = kCurveNodes;
  // Of curve, rate factor, and the surface, which goes.
  PlaceData::Row beside{};
  for (std::size_t a = 0; a < kCurveNodes; ++a) {
    for (std::size_t b = 0; b < kCurveNodes; ++b) {
      out.information[a][b] = nodal.matrix[0][0][a][b] + v * nodal.matrix[0][2][a][b] +
                              v * nodal.matrix[2][0][a][b] + v * v * nodal.matrix[2][2][a][b];
      out.information[a][kLast] +=
          (nodal.matrix[0][2][a][b] + v * nodal.matrix[2][2][a][b]) * best.curve[b];
      beside[a] += (nodal.matrix[0][1][a][b] + v * nodal.matrix[2][1][a][b]) * best.curve[b];
    }
    out.pull[a] = nodal.right[0][a] + v * nodal.right[2][a];
    out.information[kLast][a] = out.information[a][kLast];
  }
  out.information[kLast][kLast] = nodal.between(2, best.curve, 2, best.curve);
  out.pull[kLast] = nodal.along(2, best.curve);
  beside[kLast] = nodal.between(1, best.curve, 2, best.curve);
  constexpr double kKnown = 1 / (kSurfaceSpread * kSurfaceSpread);
  const double along = nodal.between(1, best.curve, 1, best.curve) + kKnown;
  const double pulled = nodal.along(1, best.curve) + kKnown * off;
  out.square = sums.squares() + kKnown * off * off - pulled * pulled / along;
  for (std::size_t a = 0; a < PlaceData::kSize; ++a) {
    for (std::size_t b = 0; b < PlaceData::kSize; ++b) {
      out.information[a][b] -= beside[a] * beside[b] / along;
    }
    out.pull[a] -= beside[a] * pulled / along;
  }
}

}  // namespace

const std::array<NodalCurve, kTissueShapes>& tissue_shapes() noexcept {
  static const std::array<NodalCurve, kTissueShapes> shapes = [] {
    std::array<NodalCurve, kTissueShapes> out{};
    for (std::size_t n = 0; n < kCurveNodes; ++n) {
      const CurveTerms values = curve_polynomials(node_indentations()[n]);
      for (std::size_t m = 0; m < kTissueShapes; ++m) out[m][n] = values[m + 1];
    }
    return out;
  }();
  return shapes;
}

/// The force is linear in (curve, curve * shift, curve * rate factor).
std::optional<PlaceData> place_data(const PlaceReadings& readings, const CurveBasis& basis) {
  const SensorSteps steps{readings.noise, readings.quantum};
  double surface = readings.surface;
  std::optional<TouchModel> expected;
  PlaceFit best;
  best.curve.fill(readings.stiffness.scale);
  best.scale = readings.stiffness.scale;
  NormalEquations sums{surface};
  for (int pass = 0; pass < kFitPasses; ++pass) {
    sums = NormalEquations{surface};
    for (const Touch& touch : readings.touches) {
      sums.add(touch,
               {.basis = basis,
                .steps = steps,
                .cut_off = readings.cut_off,
                .noise = readings.noise,
                .expected = expected});
    }
    if (!(sums.weights() > 0)) return std::nullopt;
    const PlaceFit next = fit(NodalEquations{sums}, sums, readings, best.curve, best.scale);
    if (!next.regular) return std::nullopt;
    best = next;
    surface += std::clamp(best.shift, -kSurfaceSpread, kSurfaceSpread);
    expected = expected_of(best, surface);
  }
  sums.move_to(surface);
  PlaceData out{.place = readings.place,
                .rate_factor = readings.stiffness.rate_factor,
                .scale = best.scale,
                .surface = surface,
                .misfit = best.misfit,
                .samples = sums.samples(),
                .force = sums.squares()};
  reduce(sums, best, readings.surface - surface, out);
  return out;
}

FactorTold factor_told(const PlaceData& place,
                       const NodalCurve& force,
                       double rate_factor) noexcept {
  FactorTold out;
  for (std::size_t a = 0; a < kCurveNodes; ++a) {
    const double rate = rate_factor * place.information[a][PlaceData::kSize - 1];
    out.pull += force[a] * (place.pull[a] - rate);
    for (std::size_t b = 0; b < kCurveNodes; ++b) {
      out.information += force[a] * place.information[a][b] * force[b];
    }
  }
  return out;
}

}  // namespace palp::depth
