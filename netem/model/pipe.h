#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "common/core/time.h"
#include "common/link/transport.h"
#include "netem/model/channel.h"
#include "netem/model/impairment.h"

namespace palp::netem {

/// An impaired path between the two sites of one process: what one end sends, the other receives
/// when its channel releases it; `arrived_at` is the release time. A datagram without delay is
/// readable in the same tick by a receiver that runs later in it.
/// Thread: one for both ends. The ends refer to the pipe, which outlives them and does not move.
class Pipe {
 public:
  Pipe(const Impairment& up,
       const Impairment& down,
       std::uint64_t seed,
       std::size_t in_flight_max,
       TimePoint start = {});
  /// `start`: where the times of the plans begin.
  Pipe(const PathPlan& up,
       const PathPlan& down,
       std::uint64_t seed,
       std::size_t in_flight_max,
       TimePoint start = {});
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  [[nodiscard]] std::unique_ptr<link::Transport> surgeon_end();
  [[nodiscard]] std::unique_ptr<link::Transport> patient_end();
  [[nodiscard]] const Channel& channel(Direction direction) const noexcept {
    return direction == Direction::Up ? up_ : down_;
  }

 private:
  Channel up_;
  Channel down_;
};

}  // namespace palp::netem
