#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/core/time.h"
#include "netem/model/impairment.h"

namespace palp::netem {

/// Something that happens to one direction at a given time.
struct Change {
  enum class Kind : std::uint8_t {
    Set,       ///< another impairment holds
    Ramp,      ///< its delay, jitter and random losses come within `span`; then it holds
    Blackout,  ///< nothing gets through for `span`
    Stall,     ///< what arrives within `span` is held to its end
    Flood,     ///< `copies` more of each datagram for `span`
    Rebind     ///< the relay goes on from another port; other hosts have none
  };
  Duration at{};  ///< since the start of the channel
  Kind kind{Kind::Set};
  Impairment impairment{};
  Duration span{};
  std::size_t copies{};
  std::string words{};  ///< for logs
};

/// What one direction of a path does over time: an impairment and, if there are any, changes.
struct PathPlan {
  Impairment impairment{};
  std::vector<Change> changes{};  ///< by time
  Duration loop{};                ///< the changes begin again after so long; 0: once
};

}  // namespace palp::netem
