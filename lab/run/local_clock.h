#pragma once

#include "common/core/time.h"

namespace palp::lab {

/// A process's clock beside the lab's: what a step of it moves.
struct LocalClock {
  Duration ahead{};
  [[nodiscard]] TimePoint local(TimePoint world) const noexcept { return world + ahead; }
  [[nodiscard]] TimePoint world(TimePoint local) const noexcept { return local - ahead; }
};

}  // namespace palp::lab
