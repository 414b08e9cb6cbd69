#pragma once

#include <string>

#include "common/core/depth_verdict.h"
#include "common/core/number_text.h"
#include "common/core/place_text.h"

namespace palp {

/// What an estimate says, for people.
struct DepthStatement {
  DepthVerdict verdict{DepthVerdict::Invalid};
  DepthReason reason{DepthReason::Ok};
  double depth{};  ///< [m]
  double low{};    ///< [m], as DepthEstimate::depth_low
  double high{};   ///< [m]
};

/// "11.8 mm, between 11.1 and 12.6", "no inclusion of radius >= 5 mm above 12 mm", or why nothing
/// can be said.
[[nodiscard]] std::string depth_text(const DepthStatement& statement);

/// Of a DepthEstimate or what a telegram carries of it.
template <typename Estimate>
[[nodiscard]] std::string depth_text_of(const Estimate& estimate) {
  return depth_text({.verdict = estimate.verdict,
                     .reason = estimate.reason,
                     .depth = estimate.depth,
                     .low = estimate.depth_low,
                     .high = estimate.depth_high});
}

/// On a status line: "depth -" before the first estimate, and behind what was found or not the
/// hash and the place.
template <typename Estimate>
[[nodiscard]] std::string depth_line_of(const Estimate& estimate) {
  if (estimate.number == 0) return "depth -";
  const std::string hash =
      number_text(" (h ", estimate.hash, 4, " N) at ") + place_text(estimate.place);
  const std::string text = depth_text_of(estimate);
  if (estimate.verdict == DepthVerdict::None) return text + hash;
  return "depth " + text + (estimate.verdict == DepthVerdict::Found ? hash : "");
}

/// The same in few characters: what was found, or that nothing was.
template <typename Estimate>
[[nodiscard]] std::string depth_brief_of(const Estimate& estimate) {
  if (estimate.number == 0) return "depth -";
  switch (estimate.verdict) {
    case DepthVerdict::Found:
      return number_text("depth ", estimate.depth * 1e3, 1, " mm");
    case DepthVerdict::None:
      return "no inclusion";
    case DepthVerdict::Invalid:
      break;
  }
  return "depth ?";
}

}  // namespace palp
