#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "common/core/device_facts.h"
#include "common/core/time.h"

namespace palp::coupling {

/// Tip and force of one instant, from devices that each have their own pace and lag: paired as they
/// arrive, a force that is late by 20 ms looks like a tissue that is softer on the way in than on
/// the way out. Devices that answer at each tick are paired as they are; slower ones by straight
/// lines between readings, so late that both are there. Thread: rt. A value.
class PairedReadings {
 public:
  struct Pair {
    double position{};  ///< [m]
    double force{};     ///< [N]
  };

  /// `period` [s], of the control loop.
  PairedReadings(const PatientDevices& devices, double period) noexcept {
    const double pole = 1 / (2 * std::numbers::pi * devices.sensor.pole);
    // Lags are given to a tenth of a millisecond; the pole is the estimator's to allow for.
    const double hidden = std::max(0.0, devices.sensor.lag - pole);
    if (hidden > period / 2) hidden_ = from_seconds(std::min(hidden, kLongest));
    const double wait = std::max(wait_of(devices.stage.rate, period),
                                 wait_of(devices.sensor.rate, period) + seconds(hidden_));
    late_ = from_seconds(std::min(wait, kLongest));
  }

  /// Once a tick; when each was read, and what it said.
  [[nodiscard]] Pair step(TimePoint now,
                          TimePoint stood_at,
                          double position,
                          TimePoint felt_at,
                          double force) noexcept {
    if (late_ <= Duration{0}) return {position, force};
    tips_.add(stood_at, position);
    forces_.add(felt_at - hidden_, force);
    return {tips_.at(now - late_), forces_.at(now - late_)};
  }
  /// What is given is so much older than what came [s].
  [[nodiscard]] double late() const noexcept { return seconds(late_); }

 private:
  static constexpr double kLongest = 0.2;  // [s]

  /// Readings over time, straight lines between them.
  class Track {
   public:
    void add(TimePoint at, double value) noexcept {
      if (count_ > 0 && at <= newest().at) return;
      kept_[count_ % kept_.size()] = {at, value};
      ++count_;
    }
    [[nodiscard]] double at(TimePoint time) const noexcept {
      const std::size_t held = std::min(count_, kept_.size());
      Reading later = newest();
      for (std::size_t back = 1; back <= held; ++back) {
        const Reading& one = kept_[(count_ - back) % kept_.size()];
        if (one.at <= time) {
          if (later.at <= time) return later.value;
          const double share = seconds(time - one.at) / seconds(later.at - one.at);
          return one.value + share * (later.value - one.value);
        }
        later = one;
      }
      return later.value;
    }

   private:
    struct Reading {
      TimePoint at{};
      double value{};  ///< [m or N]
    };
    [[nodiscard]] const Reading& newest() const noexcept {
      return kept_[(count_ + kept_.size() - 1) % kept_.size()];
    }
    std::array<Reading, 512> kept_{};
    std::size_t count_{};
  };

  /// [s], until a reading of a device of `rate` [Hz] has come, a little late.
  [[nodiscard]] static double wait_of(double rate, double period) noexcept {
    constexpr double kLate = 1.3;
    return 1 / rate > 1.01 * period ? kLate / rate : 0;
  }

  Duration hidden_{};  ///< of a force behind its stamp
  Duration late_{};
  Track tips_;
  Track forces_;
};

}  // namespace palp::coupling
