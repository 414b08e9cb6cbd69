#include "netem/model/impaired_path.h"

#include <algorithm>
#include <functional>
#include <limits>

#include "common/core/check.h"

namespace palp::netem {
namespace {

constexpr std::size_t kKernelLimit = 1000;  ///< tc's default

}  // namespace

std::size_t limit_of(const Impairment& impairment) noexcept {
  if (impairment.limit > 0) return impairment.limit;
  if (impairment.mode == Mode::Netem61) return kKernelLimit;
  return std::numeric_limits<std::size_t>::max();
}

bool may_overtake(const Impairment& impairment) noexcept {
  if (impairment.mode == Mode::Netem61 || !impairment.replay.rows.empty()) return true;
  const bool slots = impairment.slot.max > Duration{};  // what has no order gets it there
  return !slots && (impairment.order != Order::Keep || impairment.reorder.gap > 0);
}

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

ImpairedPath::ImpairedPath(const PathPlan& plan,
                           std::uint64_t seed,
                           Direction direction,
                           std::size_t in_flight_max,
                           std::size_t waiting_max,
                           TimePoint start)
    : model_{plan.impairment, seed, direction, start},
      in_flight_max_{in_flight_max},
      limit_{},
      start_{start},
      last_arrival_{TimePoint::min()},
      plan_loop_{plan.loop},
      dark_until_{TimePoint::min()},
      held_until_{TimePoint::min()},
      flood_until_{TimePoint::min()},
      due_{in_flight_max + waiting_max},
      line_{in_flight_max + waiting_max},
      slot_stream_{Streams{seed, direction}.of(Stage::Slot)},
      places_{in_flight_max + waiting_max} {
  PALP_CHECK(in_flight_max > 0, "an impaired path has room for one datagram");
  for (const Change& change : plan.changes) {
    plan_.push_back(prepare(change));
    plan_.back().law_number = plan_.size();
  }
  heap_.reserve(places_);
  collected_.reserve(places_);
  held_.reserve(places_);
  free_places_.reserve(places_);
  last_arrival_ = start;
  hold_law();
  last_arrival_ = TimePoint::min();
}

/// What follows from the law that holds now.
void ImpairedPath::hold_law() noexcept {
  const Impairment& law = impairment();
  limit_ = limit_of(law);
  const bool slots = law.mode == Mode::Netem61 && law.slot.max > Duration{};
  if (!slots) {
    kernel_slots_.reset();
  } else if (kernel_slots_) {
    kernel_slots_->change(model_.law());
  } else {
    kernel_slots_.emplace(model_.law(), slot_stream_, last_arrival_);
  }
}

// NOLINTNEXTLINE(bugprone-exception-escape): as ImpairmentModel::next()
std::span<const Decision> ImpairedPath::push(const Arrival& arrival) noexcept {
  const TimePoint at = std::max(arrival.at, last_arrival_);
  apply_due(at);
  settle(at);
  last_arrival_ = at;
  Arrival told = arrival;
  told.at = at;
  told.room = std::min(arrival.room, room());
  if (held_until_ > at) told.held_until = held_until_;
  const std::span<const CopyOutcome> outcomes = model_.next(told);
  for (std::size_t copy = 0; copy < outcomes.size(); ++copy) {
    const CopyOutcome& outcome = outcomes[copy];
    Decision& decision = decisions_[copy];
    decision = {.index = index_,
                .copy = static_cast<std::uint32_t>(copy),
                .verdict = at < dark_until_ ? Verdict::Blackout : outcome.verdict,
                .floored = outcome.floored,
                .open = kernel_slots_.has_value(),
                .tos = outcome.tos,
                .flipped_bit = outcome.flipped_bit,
                .length = outcome.length,
                .place = 0,
                .intended = outcome.delay,
                .arrived_at = at,
                .released_at = outcome.release};
    if (decision.verdict == Verdict::Delivered) enter(decision, outcome.immediate);
    decision.open = decision.open && decision.verdict == Verdict::Delivered;
  }
  ++index_;
  if (kernel_slots_) let_out(at);
  return std::span{decisions_}.first(outcomes.size());
}

std::optional<TimePoint> ImpairedPath::next_release() const noexcept {
  if (!due_.empty()) return due_.front().release();
  const Entry* first = first_on_way();
  if (first == nullptr) return std::nullopt;
  return kernel_slots_ ? kernel_slots_->look_at(first->release()) : first->release();
}

std::size_t ImpairedPath::in_line_by(TimePoint at, std::size_t most) const noexcept {
  const std::size_t end = std::min(most, line_.size());
  std::size_t count = 0;
  while (count < end && line_[count].release() <= at) ++count;
  return count;
}

std::optional<Decision> ImpairedPath::pop(TimePoint now) noexcept {
  if (kernel_slots_) settle(now);
  Entry entry{};
  if (!due_.empty()) {
    entry = due_.front();
    if (entry.release() > now) return std::nullopt;
    due_.pop();
  } else {
    const Entry* first = first_on_way();
    if (first == nullptr || first->release() > now || kernel_slots_) return std::nullopt;
    entry = take_first_on_way();
  }
  if (entry.release() > last_arrival_) {
    collected_.push_back(entry.release());
    std::push_heap(collected_.begin(), collected_.end(), std::greater<>{});
  }
  Decision& decision = held_[entry.place];
  decision.released_at = entry.release();
  free_places_.push_back(entry.place);
  return decision;
}

void ImpairedPath::apply(PreparedChange& change, TimePoint now) noexcept {
  apply_due(now);
  act(change, now);
  // The law is this path's from here on; the one that it replaced may go.
  if (change.kind == Change::Kind::Set) std::swap(own_law_, change.law);
  if (change.kind == Change::Kind::Ramp) std::swap(own_ramp_, change.law);
}

void ImpairedPath::act(const PreparedChange& change, TimePoint now) noexcept {
  const TimePoint until = now + change.span;
  switch (change.kind) {
    case Change::Kind::Set:
      ramp_ = nullptr;
      model_.change(*change.law);
      hold_law();
      break;
    case Change::Kind::Ramp:
      if (ramp_ != nullptr) lean(now);
      ramp_ = change.law.get();
      ramp_from_ = now;
      ramp_span_ = change.span;
      break;
    case Change::Kind::Blackout:
      dark_until_ = std::max(dark_until_, until);
      break;
    case Change::Kind::Stall:
      held_until_ = std::max(held_until_, until);
      break;
    case Change::Kind::Flood:
      model_.flood(change.copies);
      flooding_ = true;
      flood_until_ = until;
      break;
    case Change::Kind::Rebind:
      ++rebinds_;
      break;
  }
  if (change.law) law_number_ = change.law_number;
  ++changes_applied_;
}

std::uint64_t ImpairedPath::law_number(TimePoint at) const noexcept {
  const Duration since = at - start_ - plan_shift_;
  if (plan_at_ == plan_.size() || plan_[plan_at_].at > since) return law_number_;
  std::uint64_t number = law_number_;
  const auto pass = [&](std::size_t from, Duration until) {
    for (std::size_t i = from; i < plan_.size() && plan_[i].at <= until; ++i) {
      if (plan_[i].law) number = plan_[i].law_number;
    }
  };
  pass(plan_at_, since);
  if (plan_loop_ > Duration{} && since >= 2 * plan_loop_) pass(0, plan_loop_);
  if (plan_loop_ > Duration{} && since >= plan_loop_) pass(0, since % plan_loop_);
  return number;
}

/// The plan's changes up to `at`, and what changes with time itself.
void ImpairedPath::apply_due(TimePoint at) noexcept {
  while (plan_at_ < plan_.size() && start_ + plan_shift_ + plan_[plan_at_].at <= at) {
    skip_rounds(at);
    const PreparedChange& change = plan_[plan_at_];
    act(change, start_ + plan_shift_ + change.at);
    if (++plan_at_ == plan_.size() && plan_loop_ > Duration{}) {
      plan_at_ = 0;
      plan_shift_ += plan_loop_;
    }
  }
  if (ramp_ != nullptr) lean(at);
  if (flooding_ && at >= flood_until_) {
    flooding_ = false;
    model_.flood(0);
  }
}

/// Of rounds that began and ended while nobody came the last one says all: what it leaves behind
/// does not depend on the one before.
void ImpairedPath::skip_rounds(TimePoint at) noexcept {
  if (plan_loop_ == Duration{}) return;
  const auto begun = (at - start_) / plan_loop_;
  const auto here = plan_shift_ / plan_loop_;
  if (begun - here < 2) return;
  const auto missed = static_cast<std::uint64_t>(begun - here - 1);
  changes_applied_ += missed * plan_.size() - plan_at_;
  plan_at_ = 0;
  plan_shift_ = (begun - 1) * plan_loop_;
}

void ImpairedPath::lean(TimePoint at) noexcept {
  const Duration since = at - ramp_from_;
  if (since < ramp_span_) return model_.lean(*ramp_, seconds(since) / seconds(ramp_span_));
  model_.lean(*ramp_, 1);
  model_.change(*ramp_);
  hold_law();
  // One from outside holds now: it is in the way of the next ramp no more.
  if (ramp_ == own_ramp_.get()) std::swap(own_law_, own_ramp_);
  ramp_ = nullptr;
}

std::size_t ImpairedPath::room() const noexcept {
  const std::size_t taken = line_.size() + heap_.size() + collected_.size();
  const std::size_t most = std::min(in_flight_max_, limit_);
  return taken < most ? most - taken : 0;
}

const ImpairedPath::Entry* ImpairedPath::first_on_way() const noexcept {
  if (heap_.empty()) return line_.empty() ? nullptr : &line_.front();
  if (line_.empty() || later(line_.front(), heap_.front())) return &heap_.front();
  return &line_.front();
}

/// There is one: first_on_way() said so.
ImpairedPath::Entry ImpairedPath::take_first_on_way() noexcept {
  const bool from_line = heap_.empty() || (!line_.empty() && later(heap_.front(), line_.front()));
  if (from_line) {
    const Entry entry = line_.front();
    line_.pop();
    return entry;
  }
  std::pop_heap(heap_.begin(), heap_.end(), later);
  const Entry entry = heap_.back();
  heap_.pop_back();
  return entry;
}

/// Sorts out what is no longer on its way at `now`.
void ImpairedPath::settle(TimePoint now) noexcept {
  while (!collected_.empty() && collected_.front() <= now) {
    std::pop_heap(collected_.begin(), collected_.end(), std::greater<>{});
    collected_.pop_back();
  }
  if (kernel_slots_) {
    // The timer rings again and again until nothing is due any more.
    for (const Entry* first = first_on_way(); first != nullptr; first = first_on_way()) {
      const TimePoint look = kernel_slots_->look_at(first->release());
      if (look > now) return;
      let_out(look);
    }
    return;
  }
  // Linux's timer rings after its time: who comes on the same instant still finds the other. But
  // each arrival is followed by a look, so the next one of that instant does not.
  const bool looked = impairment().mode == Mode::Exact || now == last_arrival_;
  const TimePoint gone = looked ? now : now - Duration{1};
  for (const Entry* first = first_on_way(); first != nullptr && first->release() <= gone;
       first = first_on_way()) {
    due_.push(take_first_on_way());
  }
}

/// Linux looks at its queue at `now` and takes out what may leave.
void ImpairedPath::let_out(TimePoint now) noexcept {
  for (const Entry* first = first_on_way(); first != nullptr; first = first_on_way()) {
    if (!kernel_slots_->opens(first->release(), now)) return;
    Entry entry = take_first_on_way();
    kernel_slots_->left(held_[entry.place].length + kFrameHeaders, now);
    entry.release_ns = now.time_since_epoch().count();
    due_.push(entry);
  }
}

void ImpairedPath::enter(Decision& decision, bool immediate) noexcept {
  if (!free_places_.empty()) {
    decision.place = free_places_.back();
    free_places_.pop_back();
    held_[decision.place] = decision;
  } else if (held_.size() < places_) {
    decision.place = static_cast<std::uint32_t>(held_.size());
    held_.push_back(decision);
  } else {
    decision.verdict = Verdict::OverLimit;
    return;
  }
  const Entry entry{decision.released_at.time_since_epoch().count(), number_++, decision.place};
  if (immediate && kernel_slots_) {
    due_.push(entry);
  } else if (line_.empty() || line_.back().release_ns <= entry.release_ns) {
    line_.push(entry);
  } else {
    heap_.push_back(entry);
    std::push_heap(heap_.begin(), heap_.end(), later);
  }
}

}  // namespace palp::netem
