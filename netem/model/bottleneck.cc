#include "netem/model/bottleneck.h"

#include <algorithm>
#include <cmath>

namespace palp::netem {
namespace {

/// Datagrams that may wait where the words give no number. Beyond it they are dropped.
constexpr std::size_t kWaitingMax = 65'536;  // a power of two
constexpr std::uint64_t kNanoseconds = 1'000'000'000;
/// CoDel leaves a queue alone that holds no more than one full frame (RFC 8289, section 4.4).
constexpr std::uint64_t kCodelBytes = 1514;

}  // namespace

std::uint64_t line_length(const RateLaw& law, std::uint64_t frame) noexcept {
  const std::int64_t whole =
      std::max<std::int64_t>(static_cast<std::int64_t>(frame) + law.overhead, 0);
  auto length = static_cast<std::uint64_t>(whole);
  if (law.cell > 0) {
    const std::uint64_t cells = (length + law.cell - 1) / law.cell;
    const std::int64_t cell = std::max<std::int64_t>(std::int64_t{law.cell} + law.cell_overhead, 0);
    length = cells * static_cast<std::uint64_t>(cell);
  }
  return length;
}

Duration line_time(const RateLaw& law, std::uint64_t frame) noexcept {
  // 18 s at 1 byte/s of a frame of 18 GB: no product of a datagram leaves 64 bits.
  const std::uint64_t length = std::min<std::uint64_t>(line_length(law, frame), 1'000'000'000);
  return Duration{static_cast<std::int64_t>(length * kNanoseconds / law.bytes_per_s)};
}

Bottleneck::Bottleneck(const Impairment& impairment)
    : rate_{impairment.rate},
      queue_{impairment.queue},
      queued_{!off() && impairment.queue != QueueLaw{}},
      waiting_{std::make_unique_for_overwrite<Waiting[]>(kWaitingMax)} {}

void Bottleneck::change(const Impairment& impairment) noexcept {
  rate_ = impairment.rate;
  queue_ = impairment.queue;
  timed_length_ = 0;
  queued_ = !off() && queue_ != QueueLaw{};
}

TimePoint Bottleneck::pass_queue(TimePoint at, std::uint64_t length) noexcept {
  forget(at);
  if (full(at, length)) return kDropped;
  const TimePoint head = std::max(at, free_at_);
  if (queue_.codel && codel_drops(at, head)) return kDropped;
  if (head > at) {
    waiting_[(first_ + count_++) % kWaitingMax] = {head.time_since_epoch().count(), length};
    bytes_ += length;
  }
  return serve(head, length);
}

bool Bottleneck::full(TimePoint at, std::uint64_t length) const noexcept {
  if (free_at_ <= at) return false;  // nobody in front: it does not wait
  return count_ == kWaitingMax || (queue_.packets > 0 && count_ >= queue_.packets) ||
         (queue_.bytes > 0 && bytes_ + length > queue_.bytes) ||
         (queue_.wait > Duration{} && free_at_ - at > queue_.wait);
}

/// RFC 8289, section 5, at the instant `head` at which the datagram reaches the head of the queue.
bool Bottleneck::codel_drops(TimePoint at, TimePoint head) noexcept {
  const auto next_drop = [&](TimePoint from) {
    return from + from_seconds(seconds(queue_.interval) / std::sqrt(static_cast<double>(drops_)));
  };
  bool may_drop = false;
  if (head - at < queue_.target || bytes_ <= kCodelBytes) {
    above_ = false;
  } else if (!above_) {
    above_ = true;
    above_until_ = head + queue_.interval;
  } else {
    may_drop = head >= above_until_;
  }
  if (dropping_) {
    if (!may_drop) {
      dropping_ = false;
    } else if (head >= drop_next_) {
      ++drops_;
      drop_next_ = next_drop(drop_next_);
      return true;
    }
    return false;
  }
  if (!may_drop) return false;
  dropping_ = true;
  const std::uint32_t since = drops_ - drops_before_;
  drops_ = since > 1 && head - drop_next_ < 16 * queue_.interval ? since : 1;
  drop_next_ = next_drop(head);
  drops_before_ = drops_;
  return true;
}

/// Who is being sent at `at` no longer waits.
void Bottleneck::forget(TimePoint at) noexcept {
  while (count_ > 0 && waiting_[first_].begins_ns <= at.time_since_epoch().count()) {
    bytes_ -= waiting_[first_].length;
    first_ = (first_ + 1) % kWaitingMax;
    --count_;
  }
}

}  // namespace palp::netem
