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
/// than the other, because that is what they would be wrong by. A value. Thread: its Link's.
class ClockOffsetEstimator {
 public:
  static constexpr std::int64_t kSeconds = 32;

  /// One exchange. `there`: arrival at the peer, on its clock, less our send, on ours; `here`: our
  /// arrival less the peer's send. Both contain the offset, with opposite signs.
  void add(Duration there, Duration here, TimePoint arrived_at) noexcept;

  /// As of the last whole second; nullopt before there was one.
  [[nodiscard]] const std::optional<ClockOffset>& estimate() const noexcept { return estimate_; }

  /// How long the ways take, smoothed (1/8), if the least of both are equal; 0 without an estimate.
  [[nodiscard]] Duration way_there() const noexcept;
  [[nodiscard]] Duration way_here() const noexcept;

 private:
  struct Way {
    double value{};  ///< [s]
    double at{};     ///< [s]
  };
  /// Of both directions.
  struct Ways {
    Way there{};
    Way here{};
  };
  struct Second {
    std::int64_t number{};
    bool used{};
    Ways least{};
    Ways middle{};
  };
  /// Some of the second that runs, from which its middle will be taken.
  struct Kept {
    static constexpr std::size_t kMax = 256;
    std::array<double, kMax> there{};  ///< [s]
    std::array<double, kMax> here{};   ///< [s]
    std::size_t count{};
    double newest_at{};  ///< [s]
  };
  void end_second() noexcept;
  void fit(std::int64_t until) noexcept;

  std::array<Second, kSeconds> seconds_{};
  Kept kept_;
  std::int64_t newest_{};  ///< [s]
  bool begun_{};
  TimePoint origin_{};  ///< the first exchange; near it doubles are exact enough
  Duration there_origin_{};
  Duration here_origin_{};
  TimePoint newest_at_{};
  Duration there_{};  ///< smoothed
  Duration here_{};   ///< smoothed
  std::optional<ClockOffset> estimate_;
};

}  // namespace palp::link
