#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/core/time.h"

namespace palp::site_program {

/// How long a recording can go on before its disk is full: from its own rate, and from how fast the
/// disk's room shrinks, whoever fills it; the faster counts. Pure. Thread: one.
class DiskForecast {
 public:
  /// Between two looks that count.
  static constexpr Duration kLookEvery = std::chrono::seconds{1};
  /// Nothing is said before: the start of a file says little of its rate.
  static constexpr Duration kAtFirst = std::chrono::seconds{2};
  /// Looks back so many: what fills a disk in a minute is seen within seconds.
  static constexpr std::size_t kLooks = 30;

  /// `written`: so far, `room`: left on the disk [bytes]. Times do not fall.
  void look(TimePoint now, std::uint64_t written, std::uint64_t room) noexcept;
  /// As of the newest look; nothing where it is not known yet, or where nothing is written.
  [[nodiscard]] std::optional<Duration> left() const noexcept { return left_; }

 private:
  struct Look {
    TimePoint at{};
    std::uint64_t written{};  ///< [bytes]
    std::uint64_t room{};     ///< [bytes]
  };
  std::array<Look, kLooks> looks_{};
  std::size_t count_{};
  std::optional<Duration> left_;
};

}  // namespace palp::site_program
