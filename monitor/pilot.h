#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/core/pointer_report.h"
#include "common/core/time.h"

namespace palp::monitor {

/// The one client whose pointer moves the hand, and whether its messages come in time. It decides
/// nothing about force: a press that nobody hears of any more ends on rt, by its age. Thread: one.
class Pilot {
 public:
  /// [ns] p95 of the newest round trips; above it no press begins.
  static constexpr Duration kRoundTripMax = std::chrono::milliseconds{50};

  /// @returns false: somebody else has it.
  bool take(std::uint32_t client, std::string_view name);
  /// Lets go, of the press too. @returns false: it was not this client's.
  bool give(std::uint32_t client);
  [[nodiscard]] std::uint32_t client() const noexcept { return client_; }  ///< 0: nobody
  [[nodiscard]] const std::string& name() const noexcept { return name_; }

  void heard_pong(std::uint32_t client, Duration round_trip) noexcept;
  /// 0: not measured yet.
  [[nodiscard]] Duration round_trip() const noexcept;
  /// Why no press begins now; empty: it may.
  [[nodiscard]] std::string_view obstacle() const noexcept;

  /// A pointer's message, JSON: press, held, into_m, x_m, y_m. nullopt: not from the pilot, or no
  /// such message, and then nothing changes.
  [[nodiscard]] std::optional<PointerReport> hear(std::uint32_t client,
                                                  std::string_view json,
                                                  TimePoint now);
  /// What rt is told once the pilot is gone: its finger is up.
  [[nodiscard]] PointerReport let_go(TimePoint now) const noexcept;

 private:
  static constexpr std::size_t kRoundTrips = 20;

  std::uint32_t client_{};
  std::string name_;
  std::array<Duration, kRoundTrips> round_trips_{};
  std::size_t measured_{};
  std::uint32_t presses_{};  ///< of all pilots, as rt is told
  std::uint32_t press_{};    ///< of this one, as it says
  std::uint32_t refused_{};  ///< this press of its began while it might not
  PointerReport newest_;
};

}  // namespace palp::monitor
