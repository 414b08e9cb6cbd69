#pragma once

#include <array>
#include <cstddef>

#include "common/core/device_facts.h"

namespace palp::surgeon {

/// Does the tip measure more than the hand was given? A law does not know that its model is wrong;
/// the peer's sensor does. The measured force is held against the one that the hand got a round
/// trip and the devices' lags ago, as means over 10 ms; with the newest one too where the hand is
/// as deep as the tip, since there the tissue gives no less. Only a hand that rested then says
/// something: one that moves presses what relaxes and damps. What exceeds a limit is summed up: so
/// much is said soon, little is said later, and noise is not said. Thread: rt. A value.
class TipComparison {
 public:
  struct Look {
    double given{};       ///< [N], to the hand
    double measured{};    ///< [N], newest, of the tip: what the law means to give of it
    double position{};    ///< [m], of the hand
    double tip{};         ///< [m], newest
    double round_trip{};  ///< [s]
  };

  /// Another session or engagement: nothing is known.
  void restart() noexcept { *this = TipComparison{}; }
  /// Once a tick. `passed` [s] since the last one.
  void look(const Look& now, const PatientDevices& devices, double passed) noexcept;

  /// It does, for long or by much.
  [[nodiscard]] bool says_more() const noexcept { return says_; }
  [[nodiscard]] double more() const noexcept { return more_; }  ///< [N], mean of late

 private:
  struct Bin {
    double force{};  ///< [N], mean
    double way{};    ///< [m], of the hand since the bin before
  };
  struct Sums {
    double given{};     ///< [N]
    double measured{};  ///< [N]
    double position{};  ///< [m]
    double tip{};       ///< [m]
    double span{};      ///< [s]
  };
  static constexpr std::size_t kBins = 256;

  void compare(const Sums& mean, double round_trip, const PatientDevices& devices) noexcept;
  void judge(double limit) noexcept;

  std::array<Bin, kBins> given_{};  ///< a ring
  std::size_t count_{};             ///< of bins so far
  Sums now_;                        ///< of the bin that is not full yet
  double position_{};               ///< [m], mean, of the newest full one
  double measured_{};               ///< [N], mean of late
  double more_{};                   ///< [N]
  double sum_{};                    ///< [N s], beyond the limit
  double rested_{};                 ///< [s]
  double below_{};                  ///< [s], since it says more
  bool says_{};
};

}  // namespace palp::surgeon
