#include "common/core/watchdog.h"

namespace palp {

LinkState judge_gap(const WatchdogConfig& config, Duration gap) noexcept {
  if (gap > config.lost_after) return LinkState::Lost;
  if (gap > config.hold_after) return LinkState::Hold;
  return LinkState::Live;
}

}  // namespace palp
