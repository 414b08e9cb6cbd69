#include "common/coupling/contact_model.h"

#include <algorithm>
#include <cmath>

namespace palp::coupling {
namespace {

constexpr double kSwingMax = 5e-3;    // [m]
constexpr double kSwingRateMax = 10;  // [rad/s]
constexpr double kSoundDepth = 5e-3;  // [m], where the slope of a received model is judged

double sum(const std::array<double, kModelTerms>& c,
           const std::array<double, kModelTerms>& shapes) noexcept {
  return c[0] * shapes[0] + c[1] * shapes[1] + c[2] * shapes[2] + c[3] * shapes[3];
}

/// [N] per unit of xi.
double rise(const std::array<double, kModelTerms>& c, double xi) noexcept {
  const double root = std::sqrt(xi);
  const double bend = 1 + xi / kModelBend;
  const double fourth = root * (1.5 - 0.5 * xi / (kModelBend * bend)) / std::sqrt(bend);
  return 1.5 * c[0] * root + 2 * c[1] * xi + 3 * c[2] * xi * xi + c[3] * fourth;
}

/// Integral of xi^1.5/sqrt(1 + xi/L) from 0: in closed form, and near 0, where its terms cancel, as
/// the beginning of its series.
double bent_energy(double xi) noexcept {
  constexpr double kSeriesBelow = 0.02;
  if (xi < kSeriesBelow) {
    const double share = xi / kModelBend;
    const double series =
        0.4 + share * (-1.0 / 7 + share * (1.0 / 12 + share * (-5.0 / 88 + share * 35.0 / 832)));
    return xi * xi * std::sqrt(xi) * series;
  }
  const double product = std::sqrt(xi * (xi + kModelBend));
  return std::sqrt(kModelBend) *
         (product * (0.5 * xi - 0.75 * kModelBend) +
          0.75 * kModelBend * kModelBend * std::asinh(std::sqrt(xi / kModelBend)));
}

}  // namespace

ModelShapes model_shapes(double xi) noexcept {
  const double root = std::sqrt(xi);
  const double square = xi * xi;
  return {{xi * root, square, square * xi, xi * root / std::sqrt(1 + xi / kModelBend)},
          {0.4 * square * root, square * xi / 3, 0.25 * square * square, bent_energy(xi)}};
}

double ContactModel::force(double depth) const noexcept {
  if (!(depth > 0)) return 0;
  const double inside = std::min(depth, reach) / kModelDepthScale;
  const double beyond = std::max(0.0, depth - reach) / kModelDepthScale;
  const double within = sum(c, model_shapes(inside).force);
  return beyond > 0 ? within + beyond * rise(c, inside) : within;
}

double ContactModel::energy(double depth) const noexcept {
  if (!(depth > 0)) return 0;
  const double inside = std::min(depth, reach) / kModelDepthScale;
  const double beyond = std::max(0.0, depth - reach) / kModelDepthScale;
  const ModelShapes shapes = model_shapes(inside);
  double scaled = sum(c, shapes.energy);
  if (beyond > 0) {
    scaled += beyond * (sum(c, shapes.force) + 0.5 * beyond * rise(c, inside));
  }
  return kModelDepthScale * scaled;
}

double ContactModel::slope(double depth) const noexcept {
  if (!(depth > 0)) return 0;
  return rise(c, std::min(depth, reach) / kModelDepthScale) / kModelDepthScale;
}

ContactModel contact_model(const ModelPayload& model) noexcept {
  const double deepest = std::clamp(model.depth_max, 0.0, kModelDepthMax);
  return {model.surface, model.c, deepest + kModelReachBeyond};
}

bool is_sound(const ModelPayload& model, double travel, double slope_max) noexcept {
  if (!std::isfinite(model.depth_max) || !(std::abs(model.surface) <= travel)) return false;
  for (const double coefficient : model.c) {
    if (!(coefficient >= 0) || !std::isfinite(coefficient)) return false;
  }
  const bool swings = std::abs(model.swing) <= kSwingMax &&
                      std::abs(model.swing_quadrature) <= kSwingMax &&
                      std::abs(model.swing_rate) <= kSwingRateMax;
  if (!swings) return false;
  const ContactModel contact{model.surface, model.c, kSoundDepth};
  return contact.slope(kSoundDepth) <= slope_max;
}

}  // namespace palp::coupling
