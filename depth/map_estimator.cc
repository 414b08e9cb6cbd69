#include "depth/map_estimator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "depth/stiffness_map.h"

namespace palp::depth {
namespace {

constexpr double kShallow = 1.5e-3;  // [m]; a shorter stroke says too little of a tissue

Located located(const Estimated& one) noexcept {
  return {.median = one.median, .low = one.low, .high = one.high};
}

}  // namespace

MapStop map_stop(const MapPosterior& posterior,
                 const MapVerdict& verdict,
                 const std::optional<NextTouch>& next,
                 const MapEstimatorConfig& config) noexcept {
  const double widest = std::max({posterior.x.stddev, posterior.y.stddev, posterior.depth.stddev});
  if (verdict.found && verdict.doubts.empty() && widest <= config.known) return MapStop::Known;
  return next && next->gain >= config.news ? MapStop::GoOn : MapStop::NoMoreNews;
}

MapEstimator::Parts::Parts(const DepthDatabase& database, const DepthPrior& ball)
    : prior{.ball = ball, .block_height = database.grid().block.height},
      field{database, ball, lateral_share(database)} {}

MapEstimator::MapEstimator(DepthDatabase database,
                           const DepthPrior& ball,
                           const StiffnessPrior& stiffness,
                           const MapEstimatorConfig& config,
                           const StrokeTrackerConfig& strokes)
    : database_{std::make_unique<const DepthDatabase>(std::move(database))},
      ball_{ball},
      stiffness_{stiffness},
      config_{config},
      strokes_{strokes},
      basis_{*database_} {}

void MapEstimator::hear(const Stroke& stroke) {
  if (stroke.reason != DepthReason::Ok || stroke.indentation_max < kShallow) return;
  const TouchedPlace& known = stroke.known;
  const auto data = place_data({.place = known.place,
                                .touches = known.touches,
                                .surface = known.surface,
                                .noise = known.noise,
                                .quantum = strokes_.sensor.step,
                                .cut_off = strokes_.sensor.pole,
                                .stiffness = stiffness_},
                               basis_);
  std::erase_if(touched_, [&](const Touched& one) { return one.index == known.index; });
  heard_ = stroke.number;
  if (data) touched_.push_back({known.index, known.generation, *data});
}

void MapEstimator::forget() {
  touched_.clear();
  judged_ = heard_;
  answer_.reset();
}

std::optional<MapReport> MapEstimator::judge() {
  if (heard_ == judged_ || touched_.size() < kMapPlacesMin) return std::nullopt;
  judged_ = heard_;
  if (!parts_) parts_ = std::make_unique<const Parts>(*database_, ball_);
  std::vector<PlaceData> places;
  for (const Touched& one : touched_) places.push_back(one.data);
  MapLikelihood likelihood{parts_->field,
                           {.stiffness = stiffness_, .place_spread = config_.place_spread},
                           std::move(places)};
  MapPosterior posterior = map_posterior(likelihood, parts_->field, parts_->prior);
  MapVerdict verdict = map_verdict(likelihood, posterior, config_.verdict);
  auto next = next_touch(likelihood, parts_->field, posterior, config_.travel);
  answer_.emplace(Answer{std::move(likelihood), std::move(posterior), std::move(verdict), next});
  return report();
}

std::vector<MapCell> MapEstimator::cells() const {
  if (!answer_) return {};
  auto cells = stiffness_map(answer_->likelihood, parts_->field, answer_->posterior);
  for (MapCell& cell : cells) cell.number = judged_;
  return cells;
}

MapReport MapEstimator::report() const {
  const MapVerdict& verdict = answer_->verdict;
  const MapPosterior& posterior = answer_->posterior;
  MapReport out{.number = judged_,
                .places = static_cast<std::uint32_t>(touched_.size()),
                .verdict = verdict.found ? DepthVerdict::Found : DepthVerdict::None,
                .log_odds = posterior.log_evidence,
                .place_spread = config_.place_spread,
                .stop = map_stop(posterior, verdict, answer_->next, config_)};
  for (const MapDoubt one : verdict.doubts) out.doubts |= doubts_of(one);
  if (verdict.found) {
    out.x = located(posterior.x);
    out.y = located(posterior.y);
    out.depth = located(posterior.depth);
    out.radius = located(posterior.radius);
  }
  if (answer_->next) {
    out.next = answer_->next->place;
    out.next_gain = answer_->next->gain;
  }
  return out;
}

}  // namespace palp::depth
