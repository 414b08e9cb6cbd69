#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "common/core/spsc_queue.h"
#include "common/core/time.h"

namespace palp::monitor {

/// What a participant chose on the page.
struct StudyAnswer {
  std::uint32_t trial{};   ///< as the shown text numbers it
  std::uint32_t choice{};  ///< from 1
  TimePoint at{};          ///< when it arrived at the site
};

/// Between a study and the participant's page: what is shown, JSON that the page understands, and
/// what comes back. Full queues drop.
struct StudyScreen {
  static constexpr std::size_t kWaitingMax = 64;

  SpscQueue<std::string> shown{kWaitingMax};    ///< writer: main, reader: monitor
  SpscQueue<StudyAnswer> answers{kWaitingMax};  ///< writer: monitor, reader: main
};

}  // namespace palp::monitor
