#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "common/core/time.h"

namespace palp::link {

/// Least value of the last 16 s, kept per second. A value.
class RecentMinimum {
 public:
  void add(Duration value, TimePoint at) noexcept;
  [[nodiscard]] std::optional<Duration> least(TimePoint now) const noexcept;

 private:
  static constexpr std::int64_t kSeconds = 16;
  struct Bin {
    std::int64_t second{};
    Duration least{};
    bool used{};
  };
  [[nodiscard]] std::optional<Duration> search(std::int64_t second) const noexcept;

  std::array<Bin, kSeconds> bins_{};
  std::int64_t newest_second_{};
  std::optional<Duration> least_{};  ///< as seen in newest_second_: asked for at every telegram
};

/// What echoed stamps say of the way to the peer and back: everything on one clock at a time, so no
/// common clock is needed and a constant asymmetry does not show. A value. Thread: its Link's.
class PeerClock {
 public:
  /// RTT = (arrival - echo) - hold, `echo` on our line. @returns false where that is impossible:
  /// an echo from the future or a hold longer than the whole way.
  bool add_round_trip(TimePoint echo, Duration hold, TimePoint arrived_at) noexcept;
  /// One way, with an unknown constant in it; only differences of it mean something.
  /// @returns how far this one lies above the least of the last 16 s.
  Duration add_one_way(Duration relative, TimePoint arrived_at) noexcept;

  [[nodiscard]] bool measured() const noexcept { return measured_; }
  [[nodiscard]] Duration smoothed() const noexcept { return smoothed_; }    ///< 1/8, 0: none
  [[nodiscard]] Duration deviation() const noexcept { return deviation_; }  ///< 1/4
  [[nodiscard]] Duration least(TimePoint now) const noexcept;  ///< of 16 s; older: the smoothed one

 private:
  RecentMinimum round_trip_;
  RecentMinimum one_way_;
  Duration smoothed_{};
  Duration deviation_{};
  bool measured_{};
};

}  // namespace palp::link
