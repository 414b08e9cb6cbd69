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
/// nothing about force: a press that nobody hears of any more ends on rt, by its age. That age is
/// of the arrival: messages that queue up on the way come one after the other and are all late. So
/// the way is measured, and a press ends as soon as it is long. Thread: one.
class Pilot {
 public:
  /// [ns] of a round trip; above it no press begins, and one in progress ends.
  static constexpr Duration kRoundTripMax = std::chrono::milliseconds{50};

  /// @returns false: somebody else has it.
  bool take(std::uint32_t client, std::string_view name);
  /// Lets go, of the press too. @returns false: it was not this client's.
  bool give(std::uint32_t client);
  [[nodiscard]] std::uint32_t client() const noexcept { return client_; }  ///< 0: nobody
  [[nodiscard]] const std::string& name() const noexcept { return name_; }

  /// Of one round trip. @returns what rt is told where that ends a press.
  std::optional<PointerReport> heard_pong(std::uint32_t client,
                                          Duration round_trip,
                                          TimePoint now) noexcept;
  /// The same of one that has lasted so long already.
  std::optional<PointerReport> awaits_pong(std::uint32_t client,
                                           Duration age,
                                           TimePoint now) noexcept;
  /// What the way has to be taken for: the p95 of the newest ones, or the newest, or what an answer
  /// has been waited for, whichever is the longest. 0: nothing is known.
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
  static constexpr std::size_t kRoundTrips = 50;  ///< 5 s of them

  [[nodiscard]] std::optional<PointerReport> judge(Duration round_trip, TimePoint now) noexcept;

  std::uint32_t client_{};
  std::string name_;
  std::array<Duration, kRoundTrips> round_trips_{};
  std::size_t measured_{};
  Duration awaited_{};
  std::uint32_t presses_{};  ///< of all pilots, as rt is told
  std::uint32_t press_{};    ///< of this one, as it says
  std::uint32_t refused_{};  ///< this press of its might not begin, or not go on
  PointerReport newest_;
};

}  // namespace palp::monitor
