#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "common/core/place.h"
#include "common/core/time.h"
#include "common/message/depth.h"
#include "judge/metrics.h"

/// Which motion of the hand a stroke of the tip came from.
namespace palp::judge {

/// The hand or the tip is in the tissue.
struct Stay {
  TimePoint began_at{};
  TimePoint ended_at{};
  Place place;
};

/// The one of `stays` at the place of `stroke` that shares most time with it. They are in order,
/// none overlaps another, and all times lie on one line. nullopt: none shares any.
[[nodiscard]] std::optional<std::size_t> partner_of(const Stay& stroke,
                                                    std::span<const Stay> stays) noexcept;

/// For each tap the estimate of its stroke, nullptr: there is none; where several strokes fall into
/// one tap, the one that shares most time with it. `strokes` are the estimates' on the line of the
/// taps' times, moved back by what a motion takes from the hand to the tip.
[[nodiscard]] std::vector<const DepthEstimate*> estimates_of(
    std::span<const TapMetrics> taps,
    std::span<const Stay> strokes,
    std::span<const DepthEstimate> estimates);

}  // namespace palp::judge
