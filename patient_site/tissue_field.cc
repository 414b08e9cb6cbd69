#include "patient_site/tissue_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "common/core/check.h"

namespace palp::patient {
namespace {

constexpr double kFloor = 1e-3;  // [N], on every force, less than any transducer here tells

/// A place that a telegram has rounded is still the axis: closer than any digit of a force.
constexpr double kOnAxis = 1 - 1e-12;  // [-]

double log_force(double force) noexcept { return std::log(force + kFloor); }

double from_log(double value) noexcept { return std::max(0.0, std::exp(value) - kFloor); }

}  // namespace

double inclusion_share(double distance) noexcept {
  const double ratio = distance / kInclusionReach;
  const double left = 1 - ratio * ratio;
  return left > 0 ? left * left * left : 0;
}

double InclusionField::elastic_force(const Place& place, double indentation) const noexcept {
  const double share = inclusion_share(distance(place, axis_));
  if (share <= 0) return plain_.force(indentation);
  if (share >= kOnAxis) return over_.force(indentation);
  return from_log(share * log_force(over_.force(indentation)) +
                  (1 - share) * log_force(plain_.force(indentation)));
}

double InclusionField::stiffness(const Place& place, double indentation) const noexcept {
  const double share = inclusion_share(distance(place, axis_));
  if (share <= 0) return plain_.derivative(indentation);
  if (share >= kOnAxis) return over_.derivative(indentation);
  const double rate_plain = plain_.derivative(indentation) / (plain_.force(indentation) + kFloor);
  const double rate_over = over_.derivative(indentation) / (over_.force(indentation) + kFloor);
  return (elastic_force(place, indentation) + kFloor) *
         (share * rate_over + (1 - share) * rate_plain);
}

SurveyField::SurveyField(std::span<const PlacedCurve> curves, double viscous_factor)
    : TissueField{viscous_factor}, curves_{curves} {
  PALP_CHECK(curves.size() >= 2 && curves.size() <= kPlacesMax,
             "a survey has several places, and not too many");
  for (std::size_t i = 0; i < curves_.size(); ++i) nodes_.push_back(node_of(i));
}

/// The plane through a place's own value that fits its neighbours' best, near ones more: normal
/// equations of two unknowns, with so much of a ridge that places in one line leave it level
/// across.
SurveyField::Node SurveyField::node_of(std::size_t index) const {
  constexpr double kRidge = 1e-3;  // [-], of the equations' trace
  const Place& here = curves_[index].place;
  std::vector<std::size_t> order(curves_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return distance(curves_[a].place, here) < distance(curves_[b].place, here);
  });
  const std::size_t count = std::min(order.size() - 1, kNeighboursMax);
  const double nearest = distance(curves_[order[1]].place, here);
  PALP_CHECK(nearest >= kPlacesApart, "the places of a survey lie apart");
  struct Pull {
    std::size_t index;
    double x;  // [m], weighted
    double y;  // [m], weighted
  };
  std::vector<Pull> pulls;
  double xx = 0;
  double xy = 0;
  double yy = 0;
  for (std::size_t k = 1; k <= count; ++k) {
    const Place& there = curves_[order[k]].place;
    const double x = there.x - here.x;
    const double y = there.y - here.y;
    const double weight = 1 / ((x * x + y * y) * (x * x + y * y));
    xx += weight * x * x;
    xy += weight * x * y;
    yy += weight * y * y;
    pulls.push_back({order[k], weight * x, weight * y});
  }
  const double ridge = kRidge * (xx + yy);
  xx += ridge;
  yy += ridge;
  const double determinant = xx * yy - xy * xy;
  Node node{.neighbours = {}, .nearest = nearest};
  for (const Pull& pull : pulls) {
    node.neighbours.push_back({pull.index,
                               (yy * pull.x - xy * pull.y) / determinant,
                               (xx * pull.y - xy * pull.x) / determinant});
  }
  return node;
}

std::size_t SurveyField::weigh(const Place& place, std::span<double> weights) const noexcept {
  constexpr double kSame = 1e-9;  // [m]
  std::fill(weights.begin(), weights.end(), 0.0);
  double total = 0;
  for (const PlacedCurve& curve : curves_) {
    const double far = distance(curve.place, place);
    if (far < kSame) return static_cast<std::size_t>(&curve - curves_.data());
    total += 1 / (far * far * far * far);
  }
  for (std::size_t i = 0; i < curves_.size(); ++i) {
    const double x = place.x - curves_[i].place.x;
    const double y = place.y - curves_[i].place.y;
    const double square = x * x + y * y;
    const double share = 1 / (square * square) / total;
    const double far = square / (nodes_[i].nearest * nodes_[i].nearest);
    const double level = 1 / (1 + far * far);
    weights[i] += share;
    for (const Neighbour& neighbour : nodes_[i].neighbours) {
      const double part = share * level * (x * neighbour.along_x + y * neighbour.along_y);
      weights[neighbour.index] += part;
      weights[i] -= part;
    }
  }
  return curves_.size();
}

SurveyField::Blend SurveyField::blend(const Place& place,
                                      double indentation,
                                      std::span<double> weights) const noexcept {
  const std::size_t alone = weigh(place, weights);
  if (alone < curves_.size()) return {.held = &curves_[alone].table};
  const auto known = [&](std::size_t i) { return log_force(curves_[i].table.force(indentation)); };
  std::size_t least = 0;
  std::size_t most = 0;
  Blend blend;
  for (std::size_t i = 0; i < curves_.size(); ++i) {
    blend.log += weights[i] * known(i);
    if (known(i) < known(least)) least = i;
    if (known(i) > known(most)) most = i;
  }
  if (blend.log <= known(least)) blend.held = &curves_[least].table;
  if (blend.log >= known(most)) blend.held = &curves_[most].table;
  return blend;
}

double SurveyField::elastic_force(const Place& place, double indentation) const noexcept {
  if (!(indentation > 0)) return 0;
  std::array<double, kPlacesMax> room{};
  const Blend found = blend(place, indentation, std::span{room}.first(curves_.size()));
  return found.held != nullptr ? found.held->force(indentation) : from_log(found.log);
}

double SurveyField::stiffness(const Place& place, double indentation) const noexcept {
  if (!(indentation > 0)) return 0;
  std::array<double, kPlacesMax> room{};
  const std::span<double> weights = std::span{room}.first(curves_.size());
  const Blend found = blend(place, indentation, weights);
  if (found.held != nullptr) return found.held->derivative(indentation);
  double rate = 0;
  for (std::size_t i = 0; i < curves_.size(); ++i) {
    const ForceTable& table = curves_[i].table;
    rate += weights[i] * table.derivative(indentation) / (table.force(indentation) + kFloor);
  }
  return (from_log(found.log) + kFloor) * rate;
}

}  // namespace palp::patient
