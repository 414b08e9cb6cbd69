#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "common/core/time.h"
#include "common/message/port_sample.h"

namespace palp::coupling {

/// What came out before a late tick, whatever there was to be played: that is skipped.
struct HeldWave {
  double wave{};  ///< [sqrt(W)]
  double span{};  ///< [s] >= 0
};

/// Plays the integral of a wave out on the sender's own time line: the mean wave over each tick,
/// never with more energy than the sender put in. Averaging cannot raise energy (Cauchy-Schwarz),
/// and what was played is held against what is known to have been sent. Needs no common clock: an
/// offset of the clocks cancels.
///
/// It plays as far behind as the news has lately been old, which over an even path is no later than
/// it can be: where samples overtake each other the newest one tells the integral of all before it.
/// Older news than that makes it wait, and what it then was late by is its delay from there on:
/// nothing is lost. Only what a pause brings that is longer than a few milliseconds is dropped:
/// played in less time than it was sent in, it would need more energy than was sent.
/// Thread: rt; constant memory. A value.
class PlayOut {
 public:
  explicit PlayOut(double period) noexcept : period_{period} {}  ///< [s] > 0
  void restart() noexcept;
  /// The wave [sqrt(W)] of this tick.
  double step(TimePoint now, std::span<const Incoming> arrived, const HeldWave& held = {}) noexcept;

  [[nodiscard]] double energy_received() const noexcept { return energy_received_; }  ///< [J]
  [[nodiscard]] double energy_played() const noexcept { return energy_played_; }      ///< [J]
  [[nodiscard]] double integral_played() const noexcept { return integral_played_; }

 private:
  struct Point {
    double at{};        ///< [s], sender's line
    double integral{};  ///< [sqrt(W) s]
  };
  static constexpr std::size_t kPointsMax = 2048;

  void hear(const Incoming& incoming) noexcept;
  void insert(const Point& point) noexcept;
  void follow_age(double clock) noexcept;
  [[nodiscard]] double integral_at(double at, bool& in_gap) const noexcept;
  void forget_before(double at) noexcept;
  void skip(const HeldWave& held) noexcept;

  double period_;                           ///< [s]
  std::array<Point, kPointsMax> points_{};  ///< by time
  std::size_t count_{};
  bool heard_{};
  PeerTimePoint sent_first_{};
  TimePoint arrived_first_{};
  double newest_at_{};        ///< [s], sender's line since the first sample
  double age_{};              ///< [s], of the newest sample at the last tick
  double delay_{};            ///< [s], the age that is played; as age_, the first sample's is 0
  double played_to_{};        ///< [s], sender's line since the first sample
  double integral_played_{};  ///< [sqrt(W) s]
  bool playing_{};
  std::uint64_t newest_number_{};
  double energy_received_{};  ///< [J]
  double energy_played_{};    ///< [J]
};

}  // namespace palp::coupling
