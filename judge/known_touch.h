#pragma once

#include <vector>

#include "judge/metrics.h"
#include "judge/permitted_press.h"

namespace palp::judge {

/// How right the force is once a law can know the tissue: at one site, of taps no deeper than the
/// tip had touched long enough before, and of presses held for long enough after the first contact.
/// What no law can give is left out: a tissue steeper than may be shown, a force that the device's
/// motors do not stand for ever, a hold that the bound of energy does not permit whole. Errors of
/// several taps do not make up for each other's offsets, those of several holds not for their
/// signs. Thread: any one.
class KnownTouch {
 public:
  static constexpr double kContact = 0.05;       ///< [N], of the tip
  static constexpr double kTapAfter = 0.35;      ///< [s], and a round trip: the aim for learning
  static constexpr double kHoldAfter = 2;        ///< [s], and a round trip
  static constexpr double kBeyond = 0.2e-3;      ///< [m], deeper than touched: the same tissue
  static constexpr double kDepthStep = 0.1e-3;   ///< [m], of what is kept of the depth
  static constexpr double kTapSpread = 0.15e-3;  ///< [m], rms of a tap's indentations: a slope over
                                                 ///< less says more of the encoder
  static constexpr double kHeldLeast = 0.05;     ///< [N], true force of a hold that counts
  static constexpr double kSaturated = 0.95;     ///< [-], of the continuous force

  explicit KnownTouch(const MetricsConfig& config) : config_{config}, press_{config.bound} {}

  /// A press that was held: means of it.
  struct Hold {
    double from{};      ///< [s]
    double until{};     ///< [s]
    double position{};  ///< [m], of the hand past the surface
    double felt{};      ///< [N]
    double truth{};     ///< [N]; NaN: nobody knows
  };

  /// Every tick at this site, in order of time: `at` [s], the `tip`'s indentation [m] and force
  /// [N].
  void look(double at, double tip, double contact_force);
  /// A tap is over.
  void tap(const TapMetrics& tap);
  /// Every tick at this site, in order of time, at the hand.
  void feel(const PermittedPress::Look& hand);
  void hold(const Hold& hold) noexcept;

  [[nodiscard]] double tap_error() const noexcept;   ///< [-], felt/true - 1; NaN: no such tap
  [[nodiscard]] double held_error() const noexcept;  ///< [-] >= 0, of the force; NaN: no such hold

 private:
  struct Depth {
    double at{};   ///< [s]
    double tip{};  ///< [m], deeper than ever before
  };
  [[nodiscard]] double touched_by(double at) const noexcept;

  MetricsConfig config_;
  PermittedPress press_;       ///< of the newest contact
  bool pressed_{};             ///< at the last tick
  std::vector<Depth> depths_;  ///< in contact
  double tap_felt_{};          ///< [N m]
  double tap_truth_{};         ///< [N m]
  double held_off_{};          ///< [N]
  double held_truth_{};        ///< [N]
};

}  // namespace palp::judge
