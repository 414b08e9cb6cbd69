#include "patient_site/block_tissue.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "common/core/conventions.h"
#include "common/core/number_text.h"
#include "common/core/random.h"
#include "fem/sneddon_sphere.h"

namespace palp::patient {
namespace {

constexpr double kSlopeMax = 0.364;     // [-], 20 degrees: steeper nothing was compared
constexpr double kCurvatureMax = 0.25;  // per tip radius
constexpr double kLawModulus = 15.3e3;  // [Pa], of the plain laws
constexpr std::size_t kWaves = 32;      // of a random field
constexpr std::uint64_t kWaveDraws = 0x7374'6966'6669'656cULL;  // "stiffiel"

double length_of(double x, double y) noexcept { return std::sqrt(x * x + y * y); }

/// [-], of the force on a surface of such curvature over that on a flat one.
double dome_factor(const fem::DepthGrid& grid, double curvature, double indentation) {
  const double modulus = grid.block.youngs_modulus / (1 - grid.block.poisson * grid.block.poisson);
  fem::SneddonSphere sphere{.radius = grid.indenter_radius, .modulus = modulus};
  const double flat = sphere.press(indentation).force;
  sphere.surface_curvature = curvature;
  return sphere.press(indentation).force / flat;
}

/// Of the centres of two inclusions, as deep as they lie. [m]
double centres_apart(const PlacedInclusion& a, const PlacedInclusion& b) noexcept {
  return std::hypot(distance(a.axis, b.axis),
                    a.body.depth + a.body.radius - b.body.depth - b.body.radius);
}

}  // namespace

double BlockSurface::rise(const Place& place) const noexcept {
  const double x = place.x - apex.x;
  const double y = place.y - apex.y;
  return slope_x * place.x + slope_y * place.y - 0.5 * curvature * (x * x + y * y);
}

Place BlockSurface::slope(const Place& place) const noexcept {
  return {slope_x - curvature * (place.x - apex.x), slope_y - curvature * (place.y - apex.y)};
}

Result<void> check(const BlockTissue& tissue) {
  const double tip = tissue.database->grid().indenter_radius;
  const BlockSurface& surface = tissue.surface;
  if (length_of(surface.slope_x, surface.slope_y) > kSlopeMax) {
    return fail("the surface slopes by more than 20 degrees, which nobody computed");
  }
  if (std::abs(surface.curvature) > kCurvatureMax / tip) {
    return fail(number_text("the surface's radius is below ",
                            tip / kCurvatureMax / kMillimetre,
                            0,
                            " mm, four tip radii, which nobody computed"));
  }
  const std::vector<PlacedInclusion>& all = tissue.inclusions;
  const double height = tissue.height.value_or(tissue.database->grid().block.height);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (auto ok = tissue.database->contains(all[i].body, height); !ok) return ok;
    if (all[i].body.shape == fem::InclusionShape::Ball && !tissue.database->solved_beside()) {
      return fail(
          "the depth database knows no force beside a ball; build it with palp-fem database "
          "--off-axis");
    }
    for (std::size_t j = 0; j < i; ++j) {
      const double a = all[i].body.radius;
      const double b = all[j].body.radius;
      if (centres_apart(all[i], all[j]) >= a + b + 2 * std::min(a, b)) continue;
      return fail("inclusions " + std::to_string(j + 1) + " and " + std::to_string(i + 1) +
                  " lie nearer to each other than the smaller one is wide: their effects do not "
                  "add up");
    }
  }
  return {};
}

Result<ForceTable> plain_table(const BlockTissue& tissue) {
  constexpr double kStep = 20e-6;  // [m]; the table's own interpolation is exact to 1e-5 then
  const depth::DepthDatabase& database = *tissue.database;
  const fem::DepthGrid& grid = database.grid();
  const depth::DepthDatabase::Curve plain = database.plain();
  const double modulus = tissue.law ? kLawModulus : grid.block.youngs_modulus;
  const double scale = tissue.youngs_modulus.value_or(modulus) / modulus;
  std::vector<ForceRow> rows{{0, 0}};
  const int count = static_cast<int>(plain.indentation_max / kStep + 1e-6);
  for (int i = 1; i <= count; ++i) {
    const double d = i * kStep;
    double force = scale * (tissue.law ? (*tissue.law)(d) : database.force(plain, d));
    if (tissue.height) {
      force *= bonded_layer_factor(d, *tissue.height) / bonded_layer_factor(d, grid.block.height);
    }
    if (tissue.surface.curvature != 0) force *= dome_factor(grid, tissue.surface.curvature, d);
    rows.push_back({d, force});
  }
  Result<ForceTable> table = ForceTable::make(std::move(rows));
  if (!table) return fail("the block's force", table.error());
  return table;
}

BlockField::BlockField(const BlockTissue& tissue, const ForceTable& plain, double viscous_factor)
    : TissueField{viscous_factor},
      tissue_{tissue},
      plain_{plain},
      tip_radius_{tissue.database->grid().indenter_radius} {
  for (const PlacedInclusion& one : tissue.inclusions) {
    Inclusion made{.axis = one.axis,
                   .rise = tissue.surface.rise(one.axis),
                   .curve = tissue.database->curve(one.body),
                   .shape = std::nullopt};
    if (one.body.shape == fem::InclusionShape::Ball) {
      made.shape = tissue.database->shape(one.body);
    }
    inclusions_.push_back(std::move(made));
  }
  if (tissue.variation.spread <= 0) return;
  const RandomStream draws{tissue.variation.seed, kWaveDraws};
  for (std::size_t i = 0; i < kWaves; ++i) {
    // Correlation and density of the waves are Fourier transforms of each other (Bochner).
    waves_.push_back({draws.normal(3 * i) / tissue.variation.length,
                      draws.normal(3 * i + 1) / tissue.variation.length,
                      2 * std::numbers::pi * draws.uniform(3 * i + 2)});
  }
}

double BlockField::surface(const Place& place) const noexcept {
  if (tissue_.surface.level()) return 0;
  const Place slope = tissue_.surface.slope(place);
  const double steep = length_of(slope.x, slope.y);
  // A round tip touches a slope with its flank before its lowest point is there.
  const double sooner = tip_radius_ * (std::sqrt(1 + steep * steep) - 1);
  return -tissue_.surface.rise(place) - sooner;
}

/// ln E at a place over its mean.
double BlockField::log_stiffness(const Place& place) const noexcept {
  if (waves_.empty()) return 0;
  double sum = 0;
  for (const Wave& wave : waves_) sum += std::cos(wave.x * place.x + wave.y * place.y + wave.phase);
  return tissue_.variation.spread * std::sqrt(2.0 / kWaves) * sum;
}

double BlockField::log_excess(const Inclusion& inclusion,
                              double distance,
                              double indentation) const noexcept {
  const depth::DepthDatabase& database = *tissue_.database;
  if (inclusion.shape) {
    return database.log_excess(inclusion.curve, *inclusion.shape, distance, indentation);
  }
  return inclusion_share(distance) * database.log_excess(inclusion.curve, indentation);
}

double BlockField::elastic_force(const Place& place, double indentation) const noexcept {
  if (!(indentation > 0)) return 0;
  const BlockSurface& surface = tissue_.surface;
  double cosine = 1;
  Place foot = place;
  double rise = 0;
  if (!surface.level()) {
    const Place slope = surface.slope(place);
    cosine = 1 / std::sqrt(1 + slope.x * slope.x + slope.y * slope.y);
    const double uphill = cosine * (tip_radius_ - indentation * cosine);
    foot = {place.x + uphill * slope.x, place.y + uphill * slope.y};
    rise = surface.rise(foot);
  }
  const double normal = indentation * cosine;
  double log = log_stiffness(place);
  for (const Inclusion& inclusion : inclusions_) {
    const double along = distance(foot, inclusion.axis);
    const double up = rise - inclusion.rise;
    log += log_excess(inclusion, length_of(along, up), normal);
  }
  return cosine * plain_.force(normal) * std::exp(log);
}

double BlockField::stiffness(const Place& place, double indentation) const noexcept {
  if (!(indentation > 0)) return 0;
  const double step = std::min(1e-7, 0.5 * indentation);  // [m]
  return (elastic_force(place, indentation + step) - elastic_force(place, indentation - step)) /
         (2 * step);
}

}  // namespace palp::patient
