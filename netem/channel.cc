#include "netem/channel.h"

#include <algorithm>
#include <cstring>
#include <functional>

#include "common/core/check.h"
#include "common/link/transport.h"

namespace palp::netem {
namespace {

/// Places for what is due beside what is on its way: a host that polls once in a while collects
/// at most link::kDatagramsPerTickMax at a time.
constexpr std::size_t kDueMax = 4 * link::kDatagramsPerTickMax;

}  // namespace

Channel::Channel(const Impairment& impairment,
                 std::uint64_t seed,
                 Direction direction,
                 std::size_t in_flight_max,
                 TimePoint start)
    : fates_{impairment, seed, direction, start},
      in_flight_max_{in_flight_max},
      slot_count_{in_flight_max + kDueMax},
      last_arrival_{TimePoint::min()},
      due_{slot_count_},
      line_{slot_count_},
      bytes_{std::make_unique_for_overwrite<std::byte[]>(slot_count_ * link::kDatagramSizeMax)},
      slots_(slot_count_) {
  PALP_CHECK(in_flight_max > 0, "a channel has room for one datagram");
  heap_.reserve(slot_count_);
  collected_.reserve(slot_count_);
  free_slots_.reserve(slot_count_);
  for (std::size_t slot = slot_count_; slot > 0; --slot) {
    free_slots_.push_back(static_cast<std::uint32_t>(slot - 1));
  }
}

void Channel::push(std::span<const std::byte> datagram, TimePoint now) noexcept {
  const TimePoint at = std::max(now, last_arrival_);
  last_arrival_ = at;
  settle(at);
  const std::size_t taken = line_.size() + heap_.size() + collected_.size();
  const std::size_t room = taken < in_flight_max_ ? in_flight_max_ - taken : 0;
  const Fate fate = fates_.next({.at = at, .length = datagram.size(), .room = room});
  ++counters_.pushed;
  counters_.copies += fate.count - 1;
  for (std::size_t copy = 0; copy < fate.count; ++copy) {
    const CopyFate& copy_fate = fate.copies[copy];
    switch (copy_fate.verdict) {
      case Verdict::Delivered:
        counters_.floored += copy_fate.floored ? 1 : 0;
        intended_.record(copy_fate.delay);
        place(
            datagram,
            {.size = datagram.size(), .arrived_at = at, .index = fate.index, .duplicate = copy > 0},
            copy_fate.release);
        break;
      case Verdict::Lost:
        ++counters_.lost;
        break;
      case Verdict::Blackout:
        ++counters_.blackout;
        break;
      case Verdict::OverLimit:
        ++counters_.over_limit;
        break;
    }
  }
}

std::optional<TimePoint> Channel::next_release() const noexcept {
  if (!due_.empty()) return due_.front().release;
  if (const Entry* first = first_on_way()) return first->release;
  return std::nullopt;
}

std::optional<Released> Channel::pop(std::span<std::byte> out, TimePoint now) noexcept {
  Entry entry;
  if (!due_.empty()) {
    entry = due_.front();
    if (entry.release > now) return std::nullopt;
    due_.pop();
  } else {
    const Entry* first = first_on_way();
    if (first == nullptr || first->release > now) return std::nullopt;
    entry = take_first_on_way();
    if (entry.release > last_arrival_) {
      collected_.push_back(entry.release);
      std::push_heap(collected_.begin(), collected_.end(), std::greater<>{});
    }
  }
  const Slot& slot = slots_[entry.slot];
  const std::size_t length = std::min(slot.size, out.size());
  if (length > 0) {
    std::memcpy(out.data(), bytes_.get() + entry.slot * link::kDatagramSizeMax, length);
  }
  free_slots_.push_back(entry.slot);
  ++counters_.popped;
  achieved_.record(entry.release - slot.arrived_at);
  if (!slot.duplicate) {
    if (slot.index < index_next_) ++counters_.reordered;
    index_next_ = std::max(index_next_, slot.index + 1);
  }
  return Released{slot.size, slot.arrived_at, entry.release, slot.index, slot.duplicate};
}

const Channel::Entry* Channel::first_on_way() const noexcept {
  if (heap_.empty()) return line_.empty() ? nullptr : &line_.front();
  if (line_.empty() || later(line_.front(), heap_.front())) return &heap_.front();
  return &line_.front();
}

/// There is one: first_on_way() said so.
Channel::Entry Channel::take_first_on_way() noexcept {
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
void Channel::settle(TimePoint now) noexcept {
  while (!collected_.empty() && collected_.front() <= now) {
    std::pop_heap(collected_.begin(), collected_.end(), std::greater<>{});
    collected_.pop_back();
  }
  for (const Entry* first = first_on_way(); first != nullptr && first->release <= now;
       first = first_on_way()) {
    due_.push(take_first_on_way());
  }
}

void Channel::place(std::span<const std::byte> datagram,
                    const Slot& slot,
                    TimePoint release) noexcept {
  if (free_slots_.empty()) {
    ++counters_.over_limit;
    return;
  }
  const std::uint32_t at = free_slots_.back();
  free_slots_.pop_back();
  slots_[at] = slot;
  if (!datagram.empty()) {
    std::memcpy(bytes_.get() + at * link::kDatagramSizeMax, datagram.data(), datagram.size());
  }
  const Entry entry{release, number_++, at};
  if (line_.empty() || line_.back().release <= release) {
    line_.push(entry);
  } else {
    heap_.push_back(entry);
    std::push_heap(heap_.begin(), heap_.end(), later);
  }
}

}  // namespace palp::netem
