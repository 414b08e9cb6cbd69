#include "judge/depth_summary.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "common/core/median.h"

namespace palp::judge {
namespace {

/// An estimator with error bars adds up the strokes of a place itself.
bool adds_up(const DepthEstimate& stroke) {
  return (stroke.verdict == DepthVerdict::Found && stroke.depth_stddev > 0) ||
         (stroke.verdict == DepthVerdict::None && stroke.depth_low > 0);
}

}  // namespace

DepthEstimate summarise_depths(std::span<const DepthEstimate> strokes) {
  if (strokes.empty()) return {};
  DepthEstimate summary = strokes.back();
  const bool added_up = std::any_of(strokes.begin(), strokes.end(), adds_up);
  if (added_up) {
    summary = *std::find_if(strokes.rbegin(), strokes.rend(), [](const DepthEstimate& stroke) {
      return stroke.verdict != DepthVerdict::Invalid;
    });
  }
  std::vector<double> depths;
  std::vector<double> hashes;
  std::size_t none = 0;
  for (const DepthEstimate& stroke : strokes) {
    if (stroke.verdict == DepthVerdict::None) ++none;
    if (stroke.verdict == DepthVerdict::Found) depths.push_back(stroke.depth);
    if (stroke.hash > 0) hashes.push_back(stroke.hash);
    summary.indentation_max = std::max(summary.indentation_max, stroke.indentation_max);
    summary.force_max = std::max(summary.force_max, stroke.force_max);
  }
  if (!hashes.empty()) summary.hash = median(hashes).value();
  if (added_up) return summary;
  if (depths.empty() && none == 0) {
    summary.verdict = DepthVerdict::Invalid;
    return summary;
  }
  summary.reason = DepthReason::Ok;
  summary.verdict = depths.size() >= none ? DepthVerdict::Found : DepthVerdict::None;
  summary.depth = summary.verdict == DepthVerdict::Found ? median(depths).value_or(0) : 0;
  summary.depth_stddev = 0;
  summary.depth_low = summary.depth;
  summary.depth_high = summary.depth;
  return summary;
}

}  // namespace palp::judge
