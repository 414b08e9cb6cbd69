#pragma once

#include "common/core/site_state.h"
#include "common/core/time.h"

namespace palp {

struct WatchdogConfig {
  Duration hold_after{std::chrono::milliseconds{100}};
  Duration lost_after{std::chrono::milliseconds{500}};
};

/// What a gap without accepted arrivals means: Live, Hold or Lost. Pure.
[[nodiscard]] LinkState judge_gap(const WatchdogConfig& config, Duration gap) noexcept;

}  // namespace palp
