#include "depth/seen_balls.h"

#include <cmath>

namespace palp::depth {
namespace {

constexpr std::size_t kBalls = 200;

}  // namespace

double SeenBall::log_ratio(const Place& place) const noexcept {
  return std::log(effect.ratio(distance(ball.place, place))[kMiddleNode]);
}

std::vector<SeenBall> seen_balls(const BallField& field, const MapPosterior& posterior) {
  std::vector<SeenBall> out;
  double sum = 0;
  double next = 0.5 / kBalls;
  for (const LikelyBall& one : posterior.balls) {
    sum += one.share;
    for (; next < sum && out.size() < kBalls; next += 1.0 / kBalls) {
      const MapBall& ball = one.ball;
      out.push_back(
          {.ball = ball,
           .effect = field.at(ball.log_depth, ball.radius, effect_of(std::exp(ball.log_ratio)))});
    }
  }
  return out;
}

}  // namespace palp::depth
