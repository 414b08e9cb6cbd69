#include "judge/stroke_pairing.h"

#include <algorithm>

namespace palp::judge {
namespace {

Duration shared_time(const Stay& a, const Stay& b) noexcept {
  return elapsed(std::max(a.began_at, b.began_at), std::min(a.ended_at, b.ended_at));
}

}  // namespace

std::optional<std::size_t> partner_of(const Stay& stroke, std::span<const Stay> stays) noexcept {
  const auto behind = std::partition_point(stays.begin(), stays.end(), [&](const Stay& stay) {
    return stay.began_at < stroke.ended_at;
  });
  std::optional<std::size_t> best;
  Duration most{};
  for (auto i = static_cast<std::size_t>(behind - stays.begin()); i-- > 0;) {
    if (stays[i].ended_at <= stroke.began_at) break;  // as all before it
    if (distance(stays[i].place, stroke.place) > kSamePlace) continue;
    const Duration shared = shared_time(stroke, stays[i]);
    if (shared <= most) continue;
    most = shared;
    best = i;
  }
  return best;
}

std::vector<const DepthEstimate*> estimates_of(std::span<const TapMetrics> taps,
                                               std::span<const Stay> strokes,
                                               std::span<const DepthEstimate> estimates) {
  std::vector<Stay> stays;
  stays.reserve(taps.size());
  for (const TapMetrics& tap : taps) {
    stays.push_back(
        {TimePoint{from_seconds(tap.began_at)}, TimePoint{from_seconds(tap.ended_at)}, tap.place});
  }
  std::vector<const DepthEstimate*> found(taps.size(), nullptr);
  std::vector<Duration> most(taps.size());
  for (std::size_t k = 0; k < std::min(strokes.size(), estimates.size()); ++k) {
    const auto tap = partner_of(strokes[k], stays);
    if (!tap) continue;
    const Duration shared = shared_time(strokes[k], stays[*tap]);
    if (shared <= most[*tap]) continue;
    most[*tap] = shared;
    found[*tap] = &estimates[k];
  }
  return found;
}

}  // namespace palp::judge
