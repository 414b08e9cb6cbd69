#pragma once

#include <cstdint>

#include "common/core/random.h"
#include "common/core/time.h"
#include "netem/model/prepared_law.h"

namespace palp::netem {

/// The slots of mode netem-6.1. Linux looks at the head of its queue when a packet comes and when a
/// timer rings; a slot that lies before the head's time is then moved on, from that instant.
/// Thread: its owner's, fit for rt.
class KernelSlots {
 public:
  /// `law` outlives this object or the next change. The first slot is at `start`.
  KernelSlots(const PreparedLaw& law, RandomStream stream, TimePoint start) noexcept;

  void change(const PreparedLaw& law) noexcept { law_ = &law; }

  /// The queue is looked at, its head due at `due`. @returns whether the head may leave now.
  [[nodiscard]] bool opens(TimePoint due, TimePoint now) noexcept;
  /// A frame of that length has left.
  void left(std::uint64_t frame, TimePoint now) noexcept;
  /// When to look again for a head that is due at `due`.
  [[nodiscard]] TimePoint look_at(TimePoint due) const noexcept {
    return due > next_ ? due : next_;
  }

 private:
  void begin_next(TimePoint now) noexcept;

  const PreparedLaw* law_;
  RandomStream stream_;
  std::uint64_t number_{};
  TimePoint next_;
  std::int64_t packets_left_{};
  std::int64_t bytes_left_{};  ///< [bytes]
};

}  // namespace palp::netem
