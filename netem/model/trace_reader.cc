#include "netem/model/trace_reader.h"

#include <algorithm>

namespace palp::netem {

Duration TraceReader::delay(const DelayTrace& trace, Duration since) noexcept {
  const auto& points = trace.points;
  const Duration step = points.back().sent - points[points.size() - 2].sent;
  const Duration turn = points.back().sent - points.front().sent + step;
  Duration inside = since - points.front().sent;
  if (trace.loop && inside > Duration{}) inside = inside % turn;
  inside += points.front().sent;
  if (at_ >= points.size() || points[at_].sent > inside) at_ = 0;
  const auto after = std::upper_bound(
      points.begin() + static_cast<std::ptrdiff_t>(at_),
      points.end(),
      inside,
      [](Duration time, const DelayTrace::Point& point) { return time < point.sent; });
  if (after == points.begin()) return points.front().delay;
  const DelayTrace::Point& left = *(after - 1);
  at_ = static_cast<std::size_t>(after - points.begin()) - 1;
  if (after == points.end() || inside <= left.sent) return left.delay;
  const double part = seconds(inside - left.sent) / seconds(after->sent - left.sent);
  const Duration arrives = after->sent + after->delay - left.sent - left.delay;
  const Duration later{
      static_cast<std::int64_t>(part * static_cast<double>(arrives.count()) + 0.5)};
  return left.delay + later - (inside - left.sent);
}

}  // namespace palp::netem
