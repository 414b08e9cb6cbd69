#pragma once

#include <cstdint>

#include "common/core/time.h"
#include "netem/model/verdict.h"

namespace palp::netem {

/// What happened to one copy of a datagram: a line of the decision log.
struct Decision {
  std::uint64_t index{};  ///< of the datagram, in order of arrival from 0
  std::uint32_t copy{};   ///< 0: the original
  Verdict verdict{};
  bool floored{};
  bool open{};  ///< slots decide when it leaves: its release holds once it is popped
  std::uint8_t tos{};
  std::int32_t flipped_bit{-1};
  std::uint32_t length{};  ///< [bytes] of payload, as it leaves
  std::uint32_t place{};   ///< where its holder keeps it, when it is on its way
  Duration intended{};     ///< delay as the law drew it
  TimePoint arrived_at{};
  TimePoint released_at{};  ///< set when delivered
};

}  // namespace palp::netem
