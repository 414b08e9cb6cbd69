#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/message/depth.h"
#include "depth/touch.h"

namespace palp::depth {

/// What is known of a place from all strokes there, and the last of them as they were measured.
struct TouchedPlace {
  std::size_t index{};  ///< below kPlacesMax; a new place may take an old one's
  Place place;
  double surface{};                ///< [m], as found
  double rate_factor{};            ///< [s/m], as found: the force is F (1 + factor * rate)
  double noise{};                  ///< [N], of one sample
  std::span<const Touch> touches;  ///< kTouchesKept at most; the last ends at its reversal
  std::size_t touched{};           ///< so many touches there were, these the last of them
  std::uint64_t generation{};      ///< another one: another tissue, or another place
};
inline constexpr std::size_t kPlacesMax = 32;
inline constexpr std::size_t kTouchesKept = 6;  ///< of a place

/// One stroke, contact to reversal, before anybody judges it.
struct Stroke {
  std::uint32_t number{};  ///< 1, 2, ... of this stream
  TimePoint began_at{};
  TimePoint ended_at{};
  Place place;
  double force_max{};  ///< [N], behind the low pass
  /// Ok: what follows is known. Else why the stroke says nothing; it never is StrokeTooShort or
  /// HashOutOfRange, which are for an estimator to say.
  DepthReason reason{DepthReason::Ok};
  double indentation_max{};  ///< [m]
  double hash{};             ///< [N], the paper's h of the place's law
  double fit_rms{};          ///< [N], of this stroke beside that law
  TouchedPlace known;        ///< of its place; valid until the tracker's next sample
};

/// What an estimate says whoever judges: the stroke, verdict Invalid, the stroke's reason.
[[nodiscard]] inline DepthEstimate unjudged(const Stroke& stroke) noexcept {
  DepthEstimate estimate;
  estimate.number = stroke.number;
  estimate.stroke_began_at = stroke.began_at;
  estimate.stroke_ended_at = stroke.ended_at;
  estimate.place = stroke.place;
  estimate.indentation_max = stroke.indentation_max;
  estimate.force_max = stroke.force_max;
  estimate.surface = stroke.known.surface;
  estimate.verdict = DepthVerdict::Invalid;
  estimate.reason = stroke.reason;
  estimate.hash = stroke.hash;
  estimate.fit_rms = stroke.fit_rms;
  return estimate;
}

}  // namespace palp::depth
