#pragma once

#include <cstddef>

#include "common/core/time.h"

namespace palp::netem {

/// How long before a release the relay wakes and how long before it sends: learned from how late
/// the kernel wakes it and from what a send call takes. Thread: its owner's, fit for rt.
class ReleaseTiming {
 public:
  explicit ReleaseTiming(TimePoint start) noexcept : awake_since_{start} {}

  /// So long before a release it is awake and spins.
  [[nodiscard]] Duration spin() const noexcept { return spin_; }
  /// How long before a release to begin, so that what leaves then is on time. Of several that are
  /// due `together`, sent one after the other, the middle one is: the error of the first and of the
  /// last is then the least it can be.
  [[nodiscard]] Duration lead(std::size_t together) const noexcept;
  /// Since it last slept.
  [[nodiscard]] Duration awake(TimePoint now) const noexcept { return now - awake_since_; }

  /// The kernel woke it so late.
  void woken(Duration late) noexcept;
  /// A send call took so long for each datagram.
  void sent(Duration each) noexcept;
  /// It slept until `now`.
  void slept(TimePoint now) noexcept { awake_since_ = now; }

  /// The kernel wakes a sleeper some 10-50 us late, one that slept deeply later still; so much of a
  /// wait is spun instead: what the late ones of the last wakings make advisable, within these.
  static constexpr Duration kSpinMin = std::chrono::microseconds{60};
  static constexpr Duration kSpinMax = std::chrono::microseconds{600};
  /// A send call on a busy machine costs about 8 us; more is a disturbance, not a cost to lead by.
  static constexpr Duration kLeadMax = std::chrono::microseconds{20};
  /// Nothing is sent earlier than this before its time.
  static constexpr Duration kBunchLeadMax = std::chrono::microseconds{50};

 private:
  Duration lead_{};  ///< running median of what a send call takes
  Duration spin_{kSpinMin};
  TimePoint awake_since_;
};

}  // namespace palp::netem
