#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "common/core/random.h"
#include "common/core/time.h"

/// How a device answers that is not asked at every tick: a real one has its own pace.
namespace palp::lab {

struct DeviceTiming {
  double rate{};      ///< [Hz], of readings and commands; 0: each tick, at once
  Duration lag{};     ///< to 60 ms: of a command before it acts, of a reading behind the truth
  Duration jitter{};  ///< a reading comes late by up to so much

  [[nodiscard]] bool at_once() const noexcept { return rate <= 0; }
  friend bool operator==(const DeviceTiming&, const DeviceTiming&) = default;
};

/// Of a run's devices.
struct DeviceTimings {
  DeviceTiming hand{};
  DeviceTiming stage{};
  DeviceTiming sensor{};
};

/// When a device is asked. Thread: the lab's. A value.
class DevicePolls {
 public:
  DevicePolls(const DeviceTiming& timing, std::uint64_t seed, std::uint64_t stream) noexcept
      : timing_{timing}, chance_{seed, stream} {}

  /// It was asked since the last call; the first call is one.
  [[nodiscard]] bool due(TimePoint now) noexcept {
    if (count_ == 0) begun_at_ = next_ = now;
    const bool asked = next_ <= now;
    while (next_ <= now) {
      ++count_;
      const double late = seconds(timing_.jitter) * chance_.uniform(count_);
      next_ = begun_at_ + from_seconds(static_cast<double>(count_) / timing_.rate + late);
    }
    return asked;
  }

 private:
  DeviceTiming timing_;
  RandomStream chance_;
  TimePoint begun_at_{};
  TimePoint next_{};
  std::uint64_t count_{};
};

/// What was put in comes out `lag` later; the newest of it that is due. Thread: the lab's. A value.
template <class T>
class Delayed {
 public:
  explicit Delayed(Duration lag) noexcept : lag_{lag} {}

  void put(TimePoint now, const T& value) noexcept {
    kept_[count_ % kept_.size()] = {now, value};
    ++count_;
  }
  /// Before anything is due: `otherwise`.
  [[nodiscard]] T at(TimePoint now, const T& otherwise) const noexcept {
    const std::size_t held = count_ < kept_.size() ? count_ : kept_.size();
    for (std::size_t back = 1; back <= held; ++back) {
      const Kept& one = kept_[(count_ - back) % kept_.size()];
      if (one.at + lag_ <= now) return one.value;
    }
    return otherwise;
  }
  void clear() noexcept { count_ = 0; }

 private:
  struct Kept {
    TimePoint at{};
    T value{};
  };
  Duration lag_;
  std::array<Kept, 64> kept_{};
  std::size_t count_{};
};

}  // namespace palp::lab
