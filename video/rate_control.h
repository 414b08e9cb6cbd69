#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/core/time.h"
#include "video/media_wire.h"

namespace palp::video {

struct RateConfig {
  double start_kbps{200};  ///< [kbit/s]
  double max_kbps{1000};   ///< [kbit/s]
  double min_kbps{60};     ///< [kbit/s]; below it video is off for a while
};

/// How many bits video takes, and how fast it puts them on the path. It yields to the standing
/// delay of the force telegrams: above 4 ms it takes less, below 1.5 ms it feels its way up, slowly
/// near the rate at which it last had to yield. Where even its least is too much it is off for 5 s,
/// then twice as long each time, up to a minute. A value. Thread: one.
class RateControl {
 public:
  static constexpr Duration kFramePeriod = std::chrono::microseconds{33'333};  ///< of a camera

  explicit RateControl(const RateConfig& config) noexcept
      : config_{config}, target_{config.start_kbps} {}

  /// `round_trip`: 0: not known.
  void hear(const Report& report, Duration round_trip, TimePoint now) noexcept;

  [[nodiscard]] double target() const noexcept { return target_; }  ///< [kbit/s]
  [[nodiscard]] double pace() const noexcept { return pace_; }      ///< [kbit/s], within a frame
  /// Of the camera's frames every so manieth: 1, 2 or 4.
  [[nodiscard]] int stride() const noexcept;
  [[nodiscard]] bool holds(TimePoint now) const noexcept { return now < paused_until_ || off(now); }
  [[nodiscard]] bool off(TimePoint now) const noexcept { return now < off_until_; }
  [[nodiscard]] double loss() const noexcept { return loss_; }  ///< share, quick to rise

 private:
  void yield(Duration standing, Duration round_trip, TimePoint now) noexcept;
  void grow(Duration round_trip, TimePoint now) noexcept;
  void set_pace(const Report& report) noexcept;

  RateConfig config_;
  double target_;                  ///< [kbit/s]
  double pace_{600};               ///< [kbit/s]
  double loss_{};                  ///< [-]
  bool narrow_{};                  ///< the line was slower than the pace once
  std::optional<double> ceiling_;  ///< [kbit/s], where it had to yield last
  std::optional<TimePoint> cut_at_;
  std::optional<TimePoint> grown_at_;
  TimePoint paused_until_{TimePoint::min()};
  TimePoint off_until_{TimePoint::min()};
  Duration off_for_{std::chrono::seconds{5}};
  int cuts_at_least_{};  ///< cuts in a row that led to the least rate
};

/// How many parity fragments a frame gets, at a loss that was reported. A value.
class ParityPlan {
 public:
  void hear(const Report& report) noexcept { lost_of_frame_ = report.fragments_lost; }
  /// For `data` fragments. The least with which pictures freeze for 0.5 % of the time at most,
  /// where each frame that fails costs a round trip; or what was lost of a frame of late, if that
  /// is more: losses come in bursts.
  [[nodiscard]] std::size_t count(std::size_t data,
                                  double loss,
                                  Duration round_trip) const noexcept;

 private:
  std::size_t lost_of_frame_{};
};

}  // namespace palp::video
