#include "netem/model/path_conditions.h"

#include <algorithm>

namespace palp::netem {

PathConditions::PathConditions(const Impairment& law,
                               const Streams& streams,
                               TimePoint start) noexcept
    : law_{&law},
      start_{start},
      burst_{streams.of(Stage::Burst)},
      gilbert_{streams.of(Stage::StayState), streams.of(Stage::StayLength)},
      stall_{streams.of(Stage::StallGap), streams.of(Stage::StallLength)} {}

void PathConditions::change(const Impairment& law, TimePoint at) noexcept {
  law_ = &law;
  calm_until_ = TimePoint::min();
  burst_.change(law.burst, at);
  gilbert_.change(law.gilbert, at);
  stall_.change(law.stall, at);
}

PathCondition PathConditions::at(TimePoint at, std::uint64_t index) noexcept {
  PathCondition condition{.onward = at, .dark = in_blackout(at)};
  if (burst_.on()) condition.lost = burst_.next(at);
  const auto& bitmap = law_->bitmap.lost;
  if (!bitmap.empty()) condition.lost = condition.lost || bitmap[index % bitmap.size()];
  if (gilbert_.on()) condition.loss_state = gilbert_.next(at);
  if (stall_.on()) condition.onward = stall_.next(at);
  calm_until_ = next_trouble(at);
  return condition;
}

/// When the next of what comes in time may act.
TimePoint PathConditions::next_trouble(TimePoint at) const noexcept {
  if (!law_->bitmap.lost.empty()) return TimePoint::min();
  TimePoint next = TimePoint::max();
  for (const Blackout& window : law_->blackouts) {
    if (at - start_ < window.from + window.length) next = std::min(next, start_ + window.from);
  }
  if (burst_.on()) next = std::min(next, burst_.harmless_until());
  if (gilbert_.on()) next = std::min(next, gilbert_.harmless_until());
  if (stall_.on()) next = std::min(next, stall_.begins());
  return next;
}

bool PathConditions::in_blackout(TimePoint at) const noexcept {
  const Duration elapsed = at - start_;
  return std::any_of(
      law_->blackouts.begin(), law_->blackouts.end(), [elapsed](const Blackout& window) {
        return elapsed >= window.from && elapsed < window.from + window.length;
      });
}

}  // namespace palp::netem
