#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

#include "common/core/time.h"
#include "patient_site/devices/device_profile.h"

namespace palp::patient {

/// What became of tares that were asked for.
struct TareNews {
  std::uint32_t taken{};    ///< so many, the first not counted
  std::uint32_t refused{};  ///< or given up
  double moved{};           ///< [N], the zero by the last of them: its drift
  std::string_view why;     ///< of the last refusal; lives for ever
};

/// Whether a person asks for a tare in this cycle, and what speaks against it.
struct TareAsk {
  bool asked{};
  bool ready{};      ///< the sensor
  bool may_touch{};  ///< the tip, something
};

/// What a force sensor's readings are worth: takes the tare in quiet air, refuses it where
/// something touches, and notices readings that are saturated, not finite, or always the same. The
/// tare is taken once, and again when asked for; a sensor that comes back may be pressed. Thread:
/// its device's. A value.
class LoadCheck {
 public:
  enum class Verdict : std::uint8_t {
    Taring,
    Good,
    Saturated,
    NotFinite,
    Stuck,
    Touched,
    Overloaded  ///< saturated as long as a tare takes, before there was one
  };

  explicit LoadCheck(const DeviceInstallation& config) noexcept : config_{config} {}

  /// `force` [N] as the device gives it, at each new reading.
  [[nodiscard]] Verdict take(double force, TimePoint now) noexcept {
    if (!std::isfinite(force)) return Verdict::NotFinite;
    if (!begun_ || force != last_) changed_at_ = now;
    begun_ = true;
    last_ = force;
    if (std::abs(force) >= kFull * config_.force_range) return saturated(now);
    saturated_since_.reset();
    if (config_.stuck_after > Duration{0} && now - changed_at_ > config_.stuck_after) {
      return Verdict::Stuck;
    }
    if (tared_ && !again_) return Verdict::Good;
    const Verdict verdict = tare(force, now);
    return again_ ? judge_again(verdict) : verdict;
  }
  /// Once a cycle. A tare that is asked for is taken beside the readings, which keep the old one
  /// until then; one that may not be, or no longer, is refused.
  void heed(const TareAsk& ask) noexcept {
    if (ask.ready && !ask.may_touch) {
      if (ask.asked) begin_tare_again();
    } else if (ask.asked || again_) {
      refuse(ask.ready ? "the tip may touch something" : "the sensor is not ready");
    }
  }
  /// After a gap: sameness before it proves nothing, and no tare reaches over it.
  void resume() noexcept {
    begun_ = false;
    count_ = 0;
    saturated_since_.reset();
    if (again_) refuse("the sensor is not ready");
  }

  [[nodiscard]] bool tared() const noexcept { return tared_; }
  [[nodiscard]] double zero() const noexcept { return zero_; }    ///< [N]
  [[nodiscard]] double noise() const noexcept { return noise_; }  ///< [N], rms, in that quiet air
  [[nodiscard]] const TareNews& news() const noexcept { return news_; }

 private:
  static constexpr double kFull = 0.99;  // [-], of the range
  static constexpr std::uint32_t kLeast = 8;
  static constexpr std::string_view kTouches = "something touches the sensor";

  [[nodiscard]] Verdict tare(double force, TimePoint now) noexcept {
    if (count_ == 0) {
      tare_began_ = now;
      sum_ = square_ = 0;
    }
    ++count_;
    sum_ += force - config_.force_zero;
    square_ += (force - config_.force_zero) * (force - config_.force_zero);
    if (count_ < kLeast || now - tare_began_ < config_.tare_time) return Verdict::Taring;
    const double mean = sum_ / count_;
    noise_ = std::sqrt(std::fmax(0, square_ / count_ - mean * mean));
    count_ = 0;
    if (std::abs(mean) > config_.tare_within || noise_ > config_.tare_noise) {
      return Verdict::Touched;
    }
    news_.moved = config_.force_zero + mean - zero_;
    zero_ = config_.force_zero + mean;
    tared_ = true;
    return Verdict::Good;
  }
  void begin_tare_again() noexcept {
    again_ = tared_;
    count_ = 0;
  }
  void refuse(std::string_view why) noexcept {
    again_ = false;
    ++news_.refused;
    news_.why = why;
  }
  [[nodiscard]] Verdict judge_again(Verdict verdict) noexcept {
    if (verdict == Verdict::Touched) refuse(kTouches);
    if (verdict == Verdict::Good) {
      again_ = false;
      ++news_.taken;
    }
    return Verdict::Good;
  }
  [[nodiscard]] Verdict saturated(TimePoint now) noexcept {
    if (again_) refuse(kTouches);
    if (!saturated_since_) saturated_since_ = now;
    return !tared_ && now - *saturated_since_ > config_.tare_time ? Verdict::Overloaded
                                                                  : Verdict::Saturated;
  }

  DeviceInstallation config_;
  bool begun_{};
  bool tared_{};
  bool again_{};  ///< a tare that was asked for is under way
  TareNews news_;
  std::optional<TimePoint> saturated_since_;
  double last_{};  ///< [N]
  TimePoint changed_at_{};
  TimePoint tare_began_{};
  std::uint32_t count_{};
  double sum_{};     ///< [N], above the expected zero
  double square_{};  ///< [N^2]
  double zero_{};    ///< [N]
  double noise_{};   ///< [N]
};

}  // namespace palp::patient
