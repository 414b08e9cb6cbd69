#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "common/core/time.h"
#include "netem/model/impairment.h"

namespace palp::netem {

/// [bytes] that a frame takes on a line with this rate law.
[[nodiscard]] std::uint64_t line_length(const RateLaw& law, std::uint64_t frame) noexcept;
/// Time of one frame on the line, rounded down as Linux does.
[[nodiscard]] Duration line_time(const RateLaw& law, std::uint64_t frame) noexcept;

/// A line of a given rate with a queue before it: endless, or with tail drop, CoDel or both. First
/// in, first out, so that when a datagram arrives it is known when it will leave; CoDel (RFC 8289)
/// is run on the instants at which datagrams reach the head, with the queue as each found it.
/// Thread: its owner's, fit for rt.
class Bottleneck {
 public:
  explicit Bottleneck(const Impairment& impairment);

  void change(const Impairment& impairment) noexcept;
  [[nodiscard]] bool off() const noexcept { return rate_.bytes_per_s == 0; }
  /// Not an optional: reading one back in one piece, written in two, costs a tenth of a decision.
  static constexpr TimePoint kDropped = TimePoint::max();
  /// When the last bit of a frame of `length` bytes that comes at `at` has left, or kDropped.
  [[nodiscard]] TimePoint pass(TimePoint at, std::uint64_t length) noexcept {
    return queued_ ? pass_queue(at, length) : serve(at > free_at_ ? at : free_at_, length);
  }

 private:
  struct Waiting {
    TimePoint::rep begins_ns;  ///< to be sent; from then on it no longer waits
    std::uint64_t length;      ///< [bytes]
  };
  [[nodiscard]] TimePoint pass_queue(TimePoint at, std::uint64_t length) noexcept;
  TimePoint serve(TimePoint head, std::uint64_t length) noexcept {
    if (length != timed_length_) {
      timed_length_ = length;
      time_ = line_time(rate_, length);
    }
    free_at_ = head + time_;
    return free_at_;
  }
  [[nodiscard]] bool full(TimePoint at, std::uint64_t length) const noexcept;
  [[nodiscard]] bool codel_drops(TimePoint at, TimePoint head) noexcept;
  void forget(TimePoint at) noexcept;

  RateLaw rate_;
  QueueLaw queue_;
  bool queued_{};                 ///< somebody may be dropped: who waits is kept
  std::uint64_t timed_length_{};  ///< [bytes] that time_ belongs to; 0: none yet
  Duration time_{};
  TimePoint free_at_{};  ///< when the line has sent all it was given
  /// A ring, there from the start, as a queue may come later; not touched before it is used.
  std::unique_ptr<Waiting[]> waiting_;
  std::size_t first_{};
  std::size_t count_{};
  std::uint64_t bytes_{};  ///< [bytes], waiting

  bool above_{};             ///< the wait has been above the target ...
  TimePoint above_until_{};  ///< ... and if it still is then, dropping begins
  bool dropping_{};
  TimePoint drop_next_{};
  std::uint32_t drops_{};  ///< in this or the last dropping state
  std::uint32_t drops_before_{};
};

}  // namespace palp::netem
