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

ImpairedPath::ImpairedPath(const PathPlan& plan,
                           std::uint64_t seed,
                           Direction direction,
                           std::size_t in_flight_max,
                           std::size_t waiting_max,
                           TimePoint start)
    : model_{plan.impairment, seed, direction, start},
      in_flight_max_{in_flight_max},
      limit_{},
      last_arrival_{start},
      plan_{plan, start},
      due_{in_flight_max + waiting_max},
      flying_{in_flight_max + waiting_max},
      slot_stream_{Streams{seed, direction}.of(Stage::Slot)},
      places_{in_flight_max + waiting_max} {
  PALP_CHECK(in_flight_max > 0, "an impaired path has room for one datagram");
  collected_.reserve(places_.capacity());
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
  if (imposed_.held_until > at) told.held_until = imposed_.held_until;
  const std::span<const CopyOutcome> outcomes = model_.next(told);
  for (std::size_t copy = 0; copy < outcomes.size(); ++copy) {
    const CopyOutcome& outcome = outcomes[copy];
    Decision& decision = decisions_[copy];
    decision = {.index = index_,
                .copy = static_cast<std::uint32_t>(copy),
                .verdict = at < imposed_.dark_until ? Verdict::Blackout : outcome.verdict,
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
  const InFlight* first = flying_.first();
  if (first == nullptr) return std::nullopt;
  return kernel_slots_ ? kernel_slots_->look_at(first->release()) : first->release();
}

std::size_t ImpairedPath::in_line_by(TimePoint at, std::size_t most) const noexcept {
  const std::size_t end = std::min(most, flying_.in_line());
  std::size_t count = 0;
  while (count < end && flying_.in_line(count).release() <= at) ++count;
  return count;
}

std::optional<Decision> ImpairedPath::pop(TimePoint now) noexcept {
  if (kernel_slots_) settle(now);
  InFlight entry{};
  if (!due_.empty()) {
    entry = due_.front();
    if (entry.release() > now) return std::nullopt;
    due_.pop();
  } else {
    const InFlight* first = flying_.first();
    if (first == nullptr || first->release() > now || kernel_slots_) return std::nullopt;
    entry = flying_.take_first();
  }
  if (entry.release() > last_arrival_) {
    collected_.push_back(entry.release());
    std::push_heap(collected_.begin(), collected_.end(), std::greater<>{});
  }
  Decision& decision = places_[entry.place];
  decision.released_at = entry.release();
  places_.leave(entry.place);
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
      ramp_.to = nullptr;
      model_.change(*change.law);
      hold_law();
      break;
    case Change::Kind::Ramp:
      if (ramp_.to != nullptr) lean(now);
      ramp_ = {.to = change.law.get(), .from = now, .span = change.span};
      break;
    case Change::Kind::Blackout:
      imposed_.dark_until = std::max(imposed_.dark_until, until);
      break;
    case Change::Kind::Stall:
      imposed_.held_until = std::max(imposed_.held_until, until);
      break;
    case Change::Kind::Flood:
      model_.flood(change.copies);
      imposed_.flood = true;
      imposed_.flood_until = until;
      break;
    case Change::Kind::Rebind:
      ++rebinds_;
      break;
  }
  if (change.law) law_number_ = change.law_number;
  ++changes_acted_;
}

/// The plan's changes up to `at`, and what changes with time itself.
void ImpairedPath::apply_due(TimePoint at) noexcept {
  plan_.pass(at, [this](const PreparedChange& change, TimePoint due) { act(change, due); });
  if (ramp_.to != nullptr) lean(at);
  if (imposed_.flood && at >= imposed_.flood_until) {
    imposed_.flood = false;
    model_.flood(0);
  }
}

void ImpairedPath::lean(TimePoint at) noexcept {
  const Duration since = at - ramp_.from;
  if (since < ramp_.span) return model_.lean(*ramp_.to, seconds(since) / seconds(ramp_.span));
  model_.lean(*ramp_.to, 1);
  model_.change(*ramp_.to);
  hold_law();
  // One from outside holds now: it is in the way of the next ramp no more.
  if (ramp_.to == own_ramp_.get()) std::swap(own_law_, own_ramp_);
  ramp_.to = nullptr;
}

std::size_t ImpairedPath::room() const noexcept {
  const std::size_t taken = flying_.size() + collected_.size();
  const std::size_t most = std::min(in_flight_max_, limit_);
  return taken < most ? most - taken : 0;
}

/// Sorts out what is no longer on its way at `now`.
void ImpairedPath::settle(TimePoint now) noexcept {
  while (!collected_.empty() && collected_.front() <= now) {
    std::pop_heap(collected_.begin(), collected_.end(), std::greater<>{});
    collected_.pop_back();
  }
  if (kernel_slots_) {
    // The timer rings again and again until nothing is due any more.
    for (const InFlight* first = flying_.first(); first != nullptr; first = flying_.first()) {
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
  for (const InFlight* first = flying_.first(); first != nullptr && first->release() <= gone;
       first = flying_.first()) {
    due_.push(flying_.take_first());
  }
}

/// Linux looks at its queue at `now` and takes out what may leave.
void ImpairedPath::let_out(TimePoint now) noexcept {
  for (const InFlight* first = flying_.first(); first != nullptr; first = flying_.first()) {
    if (!kernel_slots_->opens(first->release(), now)) return;
    InFlight entry = flying_.take_first();
    kernel_slots_->left(places_[entry.place].length + kFrameHeaders, now);
    entry.release_ns = now.time_since_epoch().count();
    due_.push(entry);
  }
}

void ImpairedPath::enter(Decision& decision, bool immediate) noexcept {
  if (!places_.enter(decision)) {
    decision.verdict = Verdict::OverLimit;
    return;
  }
  const InFlight entry = flying_.number(decision.released_at, decision.place);
  if (immediate && kernel_slots_) {
    due_.push(entry);
  } else {
    flying_.push(entry);
  }
}

}  // namespace palp::netem
