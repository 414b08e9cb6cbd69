#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/core/time.h"

namespace palp::link {

/// What the peer's line of time is to ours. Only the sum of the two ways can be measured: where one
/// takes longer than the other, the offset is wrong by half the difference, at most half the least
/// round trip. So it is told and logged, and nothing that protects anybody rests on it.
struct ClockOffset {
  Duration offset{};       ///< peer's time - ours, at `at`
  double skew{};           ///< [s/s], the peer's clock gains so much on ours
  Duration uncertainty{};  ///< of the offset: half the least round trip, what no exchange can see
  TimePoint at{};

  [[nodiscard]] Duration offset_at(TimePoint now) const noexcept {
    return offset + from_seconds(skew * seconds(now - at));
  }
};

/// Offset and skew of the peer's clock from the four times of each exchange. Queues only lengthen a
/// way, so the least of each second in each direction is nearly free of them; over the last 32 s a
/// straight line is laid through those of each direction, rising in one as it falls in the other.
/// Seconds above the lines, whose least was queued as well, count for less (minima and lines as in
/// Paxson, "On calibrating measurements of packet transit times", 1998).
/// Where a way's least is hardly ever reached, as where its jitter has no edge, the middle of all
/// ways of a second scatters less: lines through those are laid as well, and what both say counts
/// by how well it is known. Of the middles this includes by how much more one direction is spread
/// than the other, because that is what they would be wrong by. Where both ways move together, as
/// with another route or satellite, one line through half their differences takes the place of two.
/// A value. Thread: its Link's.
class ClockOffsetEstimator {
 public:
  static constexpr std::int64_t kSeconds = 32;

  /// How long the newest datagram that the peer had in one of its ticks was on its way: arrival, on
  /// its clock, less our send, on ours. `tick`: on its clock.
  void add_there(Duration way, Duration tick, TimePoint arrived_at) noexcept;
  /// The same of the newest that we had in one of our ticks: our arrival less the peer's send. Both
  /// contain the offset, with opposite signs. Only the newest of a tick, and of both directions in
  /// the same manner: else one way would seem longer than it is, for of those that come in a bunch
  /// the older ones waited longer, and the first after a gap comes late.
  void add_here(Duration way, TimePoint tick, TimePoint arrived_at) noexcept;

  /// As of the last whole second; nullopt before there was one.
  [[nodiscard]] const std::optional<ClockOffset>& estimate() const noexcept { return estimate_; }

  /// How long the ways take, smoothed (1/8), if the least of both are equal; 0 without an estimate.
  [[nodiscard]] Duration delay_out() const noexcept;
  [[nodiscard]] Duration delay_in() const noexcept;

 private:
  struct Way {
    double value{};  ///< [s]
    double at{};     ///< [s]
  };
  struct Second {
    std::int64_t number{};
    bool used{};
    Way least{};
    Way middle{};
  };
  /// One way.
  struct Direction {
    static constexpr std::size_t kKeptMax = 256;
    void add(Duration way, Duration tick, TimePoint arrived_at, double at) noexcept;
    void end_second(std::int64_t number, double centre) noexcept;

    std::array<Second, kSeconds> bins{};
    std::array<double, kKeptMax> kept{};  ///< [s], of the second that runs: for its middle
    std::size_t count{};                  ///< of those
    Duration kept_at{};                   ///< tick of the last of them
    bool begun{};
    Duration origin{};  ///< the first way; near it doubles are exact enough
    Duration smoothed{};
  };
  void begin_or_end_second(TimePoint arrived_at) noexcept;
  void fit(std::int64_t until) noexcept;

  Direction there_;
  Direction here_;
  std::int64_t newest_{};  ///< [s]
  bool begun_{};
  TimePoint origin_{};  ///< the first arrival
  TimePoint newest_at_{};
  std::optional<ClockOffset> estimate_;
};

}  // namespace palp::link
