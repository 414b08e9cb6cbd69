#include "depth/map_prior.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace palp::depth {
namespace {

constexpr std::size_t kAreaPoints = 200;  // of each disc
constexpr int kRadiusParts = 32;

/// A point of a sequence that fills a disc evenly.
Place in_disc(const Place& centre, double radius, std::size_t index) noexcept {
  const double away = radius * (1 - 1e-9) * std::sqrt(even_number(index, 2));
  const double angle = 2 * std::numbers::pi * even_number(index, 3);
  return {centre.x + away * std::cos(angle), centre.y + away * std::sin(angle)};
}

}  // namespace

double even_number(std::size_t index, std::size_t base) noexcept {
  double out = 0;
  double digit = 1;
  for (std::size_t rest = index + 1; rest > 0; rest /= base) {
    digit /= static_cast<double>(base);
    out += digit * static_cast<double>(rest % base);
  }
  return out;
}

BallPrior::BallPrior(const MapPrior& prior, const std::vector<PlaceData>& places)
    : prior_{prior},
      log_depth_low_{std::log(prior.ball.depth_min)},
      log_depth_high_{std::max(std::log(prior.ball.depth_max), log_depth_low_ + 1e-6)},
      radius_width_{std::max(prior.ball.radius_max - prior.ball.radius_min, kNoWidth)},
      log_ratio_low_{std::log(prior.ball.ratio_min)},
      log_ratio_width_{std::max(std::log(prior.ball.ratio_max / prior.ball.ratio_min), kNoWidth)} {
  for (const PlaceData& touched : places) places_.push_back(touched.place);
  log_area_ = std::log(area());
  double depths = 0;  // [m], mean over the radii
  for (int i = 0; i < kRadiusParts; ++i) {
    const double radius = prior.ball.radius_min + radius_width_ * (i + 0.5) / kRadiusParts;
    depths += (std::exp(log_deepest(radius)) - prior.ball.depth_min) / kRadiusParts;
  }
  log_total_ = std::log(std::max(depths, kNoWidth) * radius_width_ * log_ratio_width_);
}

std::size_t BallPrior::covering(const Place& place) const noexcept {
  return static_cast<std::size_t>(
      std::count_if(places_.begin(), places_.end(), [&](const Place& touched) {
        return distance(touched, place) <= prior_.reach;
      }));
}

/// [m^2], of all discs together: a point of one counts by how many it is in.
double BallPrior::area() const noexcept {
  double sum = 0;
  for (const Place& touched : places_) {
    for (std::size_t i = 0; i < kAreaPoints; ++i) {
      sum += 1.0 / static_cast<double>(covering(in_disc(touched, prior_.reach, i)));
    }
  }
  return sum / kAreaPoints * std::numbers::pi * prior_.reach * prior_.reach;
}

double BallPrior::log_deepest(double radius) const noexcept {
  const double room = std::max(prior_.block_height - 2 * radius, prior_.ball.depth_min);
  return std::clamp(std::log(room), log_depth_low_, log_depth_high_);
}

/// Even in the depth, not in its logarithm.
double BallPrior::log_density(const MapBall& ball) const noexcept {
  const bool inside = ball.log_depth > log_depth_low_ - 1e-9 &&
                      ball.log_depth < log_deepest(ball.radius) + 1e-9 && covering(ball.place) > 0;
  return inside ? ball.log_depth - log_area_ : -std::numeric_limits<double>::infinity();
}

MapBall BallPrior::draw(std::size_t index, double rank) const noexcept {
  const DepthPrior& ball = prior_.ball;
  return {.place = in_disc(places_[index % places_.size()], prior_.reach, index / places_.size()),
          .log_depth = std::log(ball.depth_min + (ball.depth_max - ball.depth_min) * rank),
          .radius = ball.radius_min + radius_width_ * even_number(index, 5),
          .log_ratio = log_ratio_low_ + log_ratio_width_ * even_number(index, 7)};
}

double BallPrior::draw_density(const MapBall& ball) const noexcept {
  const double discs =
      static_cast<double>(places_.size()) * std::numbers::pi * prior_.reach * prior_.reach;
  const double depths = std::max(prior_.ball.depth_max - prior_.ball.depth_min, kNoWidth);
  return static_cast<double>(covering(ball.place)) / discs * std::exp(ball.log_depth) /
         (depths * radius_width_ * log_ratio_width_);
}

}  // namespace palp::depth
