#pragma once

#include <cstdint>
#include <type_traits>

#include "common/core/time.h"

namespace palp {

/// What a pointer on a screen says of itself: the finger that is down, and how far it has been
/// drawn since. Absolute, so the newest is enough. A press has a number of its own: one that ended
/// never comes back.
struct PointerReport {
  TimePoint arrived_at{};  ///< at this site; what is older than the dead-man's time counts no more
  std::uint32_t press{};   ///< 1, 2, ...; 0: none yet
  bool held{};
  double into{};  ///< [m], drawn since the press, + into the tissue
  double x{};     ///< [m], drawn along the surface since the press
  double y{};     ///< [m]
};
static_assert(std::is_trivially_copyable_v<PointerReport>, "crosses threads by copy");

}  // namespace palp
