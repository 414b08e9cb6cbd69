#include "common/coupling/contact_model.h"

#include <algorithm>
#include <cmath>

namespace palp::coupling {
namespace {

constexpr double kSwingMax = 5e-3;     // [m]
constexpr double kSwingRateMax = 10;   // [rad/s]
constexpr double kOnsetMax = 20e-3;    // [m], deeper than any model was pressed
constexpr double kDepthStep = 0.5e-6;  // [m]
constexpr int kOnsetHalvings = 24;     // to 1.2 nm
constexpr double kSteepFrom = 0.25;    // [-], xi: no shape is too steep before

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

/// What the stiffness at the knots comes to at a depth [m].
struct Spline {
  double slope{};   ///< [N/m]
  double force{};   ///< [N]
  double energy{};  ///< [J]
};
Spline spline_at(const KnotStiffness& stiffness, double depth) noexcept {
  Spline at{.slope = stiffness[0]};
  for (std::size_t k = 0; k + 1 < stiffness.size(); ++k) {
    const double from = kModelKnots[k] * kModelDepthScale;
    if (!(depth > from)) return at;
    const double whole = (kModelKnots[k + 1] - kModelKnots[k]) * kModelDepthScale;
    const double span = std::min(depth - from, whole);
    const double bend = (stiffness[k + 1] - stiffness[k]) / whole;  // [N/m^2]
    at.energy += span * (at.force + span * (stiffness[k] / 2 + span * bend / 6));
    at.force += span * (stiffness[k] + span * bend / 2);
    at.slope = stiffness[k] + span * bend;
  }
  const double beyond = std::max(0.0, depth - kModelKnots.back() * kModelDepthScale);
  at.energy += beyond * (at.force + beyond * at.slope / 2);
  at.force += beyond * at.slope;
  return at;
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

double knot_ramp(std::size_t knot, double depth) noexcept {
  KnotStiffness alone{};
  alone[knot] = 1;
  return spline_at(alone, depth).force;
}

double ContactModel::force(double depth) const noexcept {
  if (!(depth > 0)) return 0;
  const double inside = std::min(depth, reach);
  const double xi = inside / kModelDepthScale;
  const Spline spline = spline_at(stiffness, inside);
  const double within = sum(c, model_shapes(xi)) + spline.force;
  if (depth <= inside) return within;
  return within + (depth - inside) * (rise(c, xi) / kModelDepthScale + spline.slope);
}

double ContactModel::energy(double depth) const noexcept {
  if (!(depth > 0)) return 0;
  const double inside = std::min(depth, reach);
  const double xi = inside / kModelDepthScale;
  const Spline spline = spline_at(stiffness, inside);
  const double within = kModelDepthScale * sum(c, shape_energies(xi)) + spline.energy;
  if (depth <= inside) return within;
  const double beyond = depth - inside;
  const double force = sum(c, model_shapes(xi)) + spline.force;
  return within + beyond * (force + beyond * (rise(c, xi) / kModelDepthScale + spline.slope) / 2);
}

double ContactModel::slope(double depth) const noexcept {
  if (!(depth > 0)) return 0;
  const double inside = std::min(depth, reach);
  return rise(c, inside / kModelDepthScale) / kModelDepthScale + spline_at(stiffness, inside).slope;
}

double ContactModel::depth(double wanted) const noexcept {
  double found = 0;
  double step = kModelDepthMax / 2;
  while (step > kDepthStep) {
    if (force(found + step) < wanted) found += step;
    step /= 2;
  }
  for (int newton = 0; newton < 2; ++newton) {
    const double rises = slope(found);
    if (rises > 0) found += std::clamp((wanted - force(found)) / rises, -kDepthStep, kDepthStep);
  }
  return std::max(0.0, found);
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
  return {model.surface, model.c, deepest + kModelReachBeyond, model.stiffness};
}

double quick_gain(const RelaxingContact::Shares& relaxing) noexcept {
  double gain = 1;
  for (const double share : relaxing) gain += share;
  return gain;
}

namespace {

/// What a stiff skin lost is given back where the tissue under it is softer, as steeply as may be
/// and never beyond the force there is. `most` [N/m], at each knot.
void make_good(const ContactModel& model, const KnotStiffness& most, ContactModel& limited) {
  double lost = 0;                                            // [N], at the knot before
  double losing = model.stiffness[0] - limited.stiffness[0];  // [N/m], there
  for (std::size_t k = 1; k + 1 < kModelKnots.size(); ++k) {
    const double before = (kModelKnots[k] - kModelKnots[k - 1]) * kModelDepthScale;
    const double after = (kModelKnots[k + 1] - kModelKnots[k]) * kModelDepthScale;
    double now = model.stiffness[k] - limited.stiffness[k];
    // Beyond its reach a model goes on along its tangent, so nothing is made good there.
    if (now <= 0 && kModelKnots[k + 1] * kModelDepthScale <= limited.reach) {
      const double owed = (2 * lost + losing * before) / (before + after);
      const double given = std::clamp(most[k] - limited.stiffness[k], 0.0, std::max(0.0, owed));
      limited.stiffness[k] += given;
      now -= given;
    }
    lost += 0.5 * (losing + now) * before;
    losing = now;
  }
}

}  // namespace

ContactModel no_steeper(const ContactModel& model, double slope_max) noexcept {
  ContactModel limited = model;
  // A first term that is too steep is so from the surface on. The others by themselves only later:
  // cut off by the reach alone, what is huge would come back as two models are blended.
  for (std::size_t term = 0; term < kModelTerms; ++term) {
    std::array<double, kModelTerms> alone{};
    alone[term] = 1;
    const double most = slope_max * kModelDepthScale / rise(alone, kSteepFrom);  // [N]
    limited.c[term] = std::min(limited.c[term], most);
  }
  ContactModel smooth = limited;
  smooth.stiffness = {};
  // The smooth shapes become steeper all the way.
  if (smooth.slope(smooth.reach) > slope_max) {
    double low = 0;
    double high = smooth.reach;
    for (int i = 0; i < kOnsetHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      (smooth.slope(middle) <= slope_max ? low : high) = middle;
    }
    smooth.reach = limited.reach = low;
  }
  KnotStiffness most{};  // [N/m]
  for (std::size_t k = 0; k < kModelKnots.size(); ++k) {
    // As far as a straight line from this knot goes.
    const bool last = k + 1 == kModelKnots.size();
    const double until = last ? smooth.reach : kModelKnots[k + 1] * kModelDepthScale;
    most[k] = std::max(0.0, slope_max - smooth.slope(until));
    limited.stiffness[k] = std::clamp(limited.stiffness[k], 0.0, most[k]);
  }
  make_good(model, most, limited);
  return limited;
}

bool is_sound(const ModelPayload& model, double travel) noexcept {
  if (!std::isfinite(model.depth_max) || !(std::abs(model.surface) <= travel)) return false;
  const auto is_amount = [](double x) { return x >= 0 && std::isfinite(x); };
  if (!std::ranges::all_of(model.c, is_amount)) return false;
  if (!std::ranges::all_of(model.stiffness, is_amount)) return false;
  if (!std::ranges::all_of(model.relaxing, [](double x) { return x >= 0 && x <= 1; })) return false;
  return std::abs(model.swing) <= kSwingMax && std::abs(model.swing_quadrature) <= kSwingMax &&
         std::abs(model.swing_rate) <= kSwingRateMax;
}

}  // namespace palp::coupling
