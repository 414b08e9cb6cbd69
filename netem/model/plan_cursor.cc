#include "netem/model/plan_cursor.h"

namespace palp::netem {

PreparedChange prepare(const Change& change) {
  PreparedChange prepared{.at = change.at,
                          .kind = change.kind,
                          .span = change.span,
                          .copies = change.copies,
                          .law = {},
                          .law_number = {}};
  if (change.kind == Change::Kind::Set || change.kind == Change::Kind::Ramp) {
    prepared.law = std::make_unique<PreparedLaw>(change.impairment);
  }
  return prepared;
}

PlanCursor::PlanCursor(const PathPlan& plan, TimePoint start) : start_{start}, loop_{plan.loop} {
  for (const Change& change : plan.changes) {
    changes_.push_back(prepare(change));
    changes_.back().law_number = changes_.size();
  }
}

std::uint64_t PlanCursor::law_number(TimePoint at, std::uint64_t held) const noexcept {
  const Duration since = at - start_ - shift_;
  if (next_ == changes_.size() || changes_[next_].at > since) return held;
  std::uint64_t number = held;
  const auto see = [&](std::size_t from, Duration until) {
    for (std::size_t i = from; i < changes_.size() && changes_[i].at <= until; ++i) {
      if (changes_[i].law) number = changes_[i].law_number;
    }
  };
  see(next_, since);
  if (loop_ > Duration{} && since >= 2 * loop_) see(0, loop_);
  if (loop_ > Duration{} && since >= loop_) see(0, since % loop_);
  return number;
}

/// Of rounds that began and ended while nobody came the last one says all: what it leaves behind
/// does not depend on the one before.
void PlanCursor::skip_rounds(TimePoint at) noexcept {
  if (loop_ == Duration{}) return;
  const auto begun = (at - start_) / loop_;
  const auto here = shift_ / loop_;
  if (begun - here < 2) return;
  const auto missed = static_cast<std::uint64_t>(begun - here - 1);
  skipped_ += missed * changes_.size() - next_;
  next_ = 0;
  shift_ = (begun - 1) * loop_;
}

}  // namespace palp::netem
