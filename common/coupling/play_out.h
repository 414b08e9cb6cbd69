#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "common/core/port_sample.h"
#include "common/core/time.h"

namespace palp::coupling {

/// Plays the integral of a wave out on the sender's own time line, late enough for nearly all of
/// its samples to have arrived: the mean wave over each tick, never with more energy than the
/// sender put in. Averaging cannot raise energy (Cauchy-Schwarz), and what was played is held
/// against what is known to have been sent. Needs no common clock: an offset of the clocks cancels.
/// Thread: rt; constant memory. A value.
class PlayOut {
 public:
  explicit PlayOut(double period) noexcept : period_{period} {}  ///< [s] > 0
  void restart() noexcept;
  /// The wave [sqrt(W)] of this tick.
  double step(TimePoint now, std::span<const Incoming> arrived) noexcept;

  [[nodiscard]] double energy_received() const noexcept { return energy_received_; }  ///< [J]
  [[nodiscard]] double energy_played() const noexcept { return energy_played_; }      ///< [J]

 private:
  struct Point {
    double at{};        ///< [s], sender's line
    double integral{};  ///< [sqrt(W) s]
  };
  static constexpr std::size_t kPointsMax = 2048;

  void hear(const Incoming& incoming) noexcept;
  void insert(const Point& point) noexcept;
  [[nodiscard]] double integral_at(double at, bool& in_gap) const noexcept;
  void forget_before(double at) noexcept;

  double period_;                           ///< [s]
  std::array<Point, kPointsMax> points_{};  ///< by time
  std::size_t count_{};
  bool heard_{};
  PeerTimePoint sent_first_{};
  TimePoint arrived_first_{};
  double delay_{};      ///< [s], running upper quantile of arrival - sending, first one 0
  double played_to_{};  ///< [s], sender's line since the first sample
  bool playing_{};
  std::uint64_t newest_number_{};
  double energy_received_{};  ///< [J]
  double energy_played_{};    ///< [J]
};

}  // namespace palp::coupling
