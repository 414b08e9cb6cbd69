#include "judge/excursions.h"

#include <utility>

namespace palp::judge {

std::optional<Excursion> ExcursionFinder::look(const Motion& tick) {
  const double indentation = tick.position - surface_;
  if (!(indentation > 0)) contact_at_.reset();
  if (indentation > 0 && !contact_at_) contact_at_ = tick.at;
  if (!(indentation > 0.5 * kStrokeDepthMin)) return finish();
  const bool first = !std::exchange(inside_, true);
  if (first) {
    first_ = tick;
    stroke_contact_at_ = *contact_at_;
  }
  last_ = tick;
  if (FeltStiffness::takes(indentation, tick.velocity) && loading_.size() <= kLoadingMax) {
    loading_.push_back({indentation, tick.velocity, tick.force});
  }
  if (first || tick.position > deepest_.position) {
    deepest_ = tick;
    loading_size_ = loading_.size();
  }
  return std::nullopt;
}

std::optional<Excursion> ExcursionFinder::finish() {
  if (!std::exchange(inside_, false)) return std::nullopt;
  std::optional<Excursion> found;
  if (deepest_.position - surface_ > kStrokeDepthMin) {
    found = Excursion{.place = deepest_.place,
                      .indentation_max = deepest_.position - surface_,
                      .contact_at = stroke_contact_at_,
                      .began_at = first_.at,
                      .deepest_at = deepest_.at,
                      .ended_at = last_.at,
                      .stiffness = {}};
    for (std::size_t i = 0; i < loading_size_ && loading_size_ <= kLoadingMax; ++i) {
      const Loading& one = loading_[i];
      const auto truth =
          tissue_ == nullptr ? std::nullopt : tissue_->force(found->place, one.indentation);
      found->stiffness.add(one.indentation, one.velocity, one.force, truth);
    }
  }
  loading_.clear();
  loading_size_ = 0;
  return found;
}

}  // namespace palp::judge
