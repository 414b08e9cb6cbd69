#include "common/coupling/contact_model.h"

#include <algorithm>
#include <cmath>

namespace palp::coupling {
namespace {

constexpr double kSwingMax = 5e-3;    // [m]
constexpr double kSwingRateMax = 10;  // [rad/s]
constexpr double kOnsetMax = 20e-3;   // [m], deeper than any model was pressed
constexpr int kOnsetHalvings = 24;    // to 1.2 nm
constexpr double kSoundDepth = 5e-3;  // [m], where the slope of a received model is judged

double sum(const std::array<double, kModelTerms>& c,
           const std::array<double, kModelTerms>& shapes) noexcept {
  return c[0] * shapes[0] + c[1] * shapes[1] + c[2] * shapes[2] + c[3] * shapes[3] +
         c[4] * shapes[4];
}

/// [N] per unit of xi.
double rise(const std::array<double, kModelTerms>& c, double xi) noexcept {
  const double bend = 1 + xi / kModelBend;
  const double bent = std::sqrt(xi / bend) * (1.5 - 0.5 * xi / (kModelBend * bend));
  const double square = xi * xi;
  return c[0] + c[1] * bent + 2 * c[2] * xi + 3 * c[3] * square + 5 * c[4] * square * square;
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

/// Integrals of the shapes from 0.
std::array<double, kModelTerms> shape_energies(double xi) noexcept {
  const double square = xi * xi;
  const double cube = square * xi;
  return {square / 2, bent_energy(xi), cube / 3, square * square / 4, cube * cube / 6};
}

}  // namespace

std::array<double, kModelTerms> model_shapes(double xi) noexcept {
  const double square = xi * xi;
  const double cube = square * xi;
  return {xi, xi * std::sqrt(xi / (1 + xi / kModelBend)), square, cube, cube * square};
}

double ContactModel::force(double depth) const noexcept {
  if (!(depth > 0)) return 0;
  const double inside = std::min(depth, reach) / kModelDepthScale;
  const double beyond = std::max(0.0, depth - reach) / kModelDepthScale;
  const double within = sum(c, model_shapes(inside));
  return beyond > 0 ? within + beyond * rise(c, inside) : within;
}

double ContactModel::energy(double depth) const noexcept {
  if (!(depth > 0)) return 0;
  const double inside = std::min(depth, reach) / kModelDepthScale;
  const double beyond = std::max(0.0, depth - reach) / kModelDepthScale;
  double scaled = sum(c, shape_energies(inside));
  if (beyond > 0) {
    scaled += beyond * (sum(c, model_shapes(inside)) + 0.5 * beyond * rise(c, inside));
  }
  return kModelDepthScale * scaled;
}

double ContactModel::slope(double depth) const noexcept {
  if (!(depth > 0)) return 0;
  return rise(c, std::min(depth, reach) / kModelDepthScale) / kModelDepthScale;
}

void RelaxingContact::become(const ContactModel& elastic, const Shares& relaxing) noexcept {
  elastic_ = elastic;
  relaxing_ = relaxing;
  find_onset();
}

void RelaxingContact::forget() noexcept {
  past_ = {};
  find_onset();
}

void RelaxingContact::age(double depth, double span) noexcept {
  remember(depth, span);
  find_onset();
}

void RelaxingContact::age_into(const ContactModel& elastic,
                               const Shares& relaxing,
                               double depth,
                               double span) noexcept {
  remember(depth, span);
  become(elastic, relaxing);
}

void RelaxingContact::remember(double depth, double span) noexcept {
  const double now = elastic_.force(depth);
  for (std::size_t k = 0; k < past_.size(); ++k) {
    past_[k] += std::min(1.0, span / kModelTimes[k]) * (now - past_[k]);
  }
}

void RelaxingContact::find_onset() noexcept {
  gain_ = 1;
  pull_ = 0;
  for (std::size_t k = 0; k < past_.size(); ++k) {
    gain_ += relaxing_[k];
    pull_ += relaxing_[k] * past_[k];
  }
  onset_ = onset_energy_ = 0;
  if (!(pull_ > 0)) return;
  double low = 0;
  double high = kOnsetMax;
  for (int i = 0; i < kOnsetHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (gain_ * elastic_.force(middle) >= pull_ ? high : low) = middle;
  }
  onset_ = high;
  onset_energy_ = elastic_.energy(onset_);
}

double RelaxingContact::force(double depth) const noexcept {
  if (!(depth > onset_)) return 0;
  return std::max(0.0, gain_ * elastic_.force(depth) - pull_);
}

double RelaxingContact::energy(double depth) const noexcept {
  if (!(depth > onset_)) return 0;
  const double stored = gain_ * (elastic_.energy(depth) - onset_energy_) - pull_ * (depth - onset_);
  return std::max(0.0, stored);
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
  double gain = 1;
  for (const double share : model.relaxing) {
    if (!(share >= 0 && share <= 1)) return false;
    gain += share;
  }
  const bool swings = std::abs(model.swing) <= kSwingMax &&
                      std::abs(model.swing_quadrature) <= kSwingMax &&
                      std::abs(model.swing_rate) <= kSwingRateMax;
  if (!swings) return false;
  const ContactModel contact{model.surface, model.c, kSoundDepth};
  return gain * contact.slope(kSoundDepth) <= slope_max;
}

}  // namespace palp::coupling
