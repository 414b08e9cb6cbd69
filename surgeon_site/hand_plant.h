#pragma once

#include <array>
#include <string_view>

#include "common/core/result.h"
#include "common/core/time.h"
#include "surgeon_site/reaction.h"
#include "surgeon_site/tanh_table.h"

namespace palp::surgeon {

/// Impedance of a hand at the device, at rest: a spring, damper and mass between intent and handle.
struct Grip {
  double mass{};       ///< [kg], moves with the handle
  double damping{};    ///< [N s/m]
  double stiffness{};  ///< [N/m]
};

// Inside published ranges of pinch and finger impedance, where damping and stiffness rise with
// grip.
inline constexpr Grip kLightGrip{0.01, 1, 80};
inline constexpr Grip kMidGrip{0.04, 4, 300};
inline constexpr Grip kFirmGrip{0.12, 10, 900};
inline constexpr Grip kArmGrip{0.3, 6, 150};  ///< a loose hand on a relaxed arm

inline constexpr std::array<std::string_view, 4> kGripNames{"light", "mid", "firm", "arm"};

/// The grip of that name, or a sentence that lists the names there are.
[[nodiscard]] Result<Grip> grip_named(std::string_view name);

/// Mechanics of the hand and of the haptic device's handle.
struct HandPlantConfig {
  Grip grip{kMidGrip};
  ReactionConfig reaction{};
  double mass{0.075};           ///< [kg], handle
  double damping{0.05};         ///< [N s/m], handle
  double friction{0.02};        ///< [N], Coulomb, as friction * tanh(v / friction_speed)
  double friction_speed{2e-3};  ///< [m/s]
  Duration step{std::chrono::microseconds{100}};  ///< of the integration, > 0
};

/// The most reflex [-] with which the hand does not swing by itself, whatever the delay, in air
/// or against any spring: three quarters of where the small-gain theorem ends.
///
/// With A(jw) of the activation, a spring k_e >= 0 and no damping but the grip's, the hand is
/// stable where reflex k |A| < |k + k_e - M w^2 + j b w| at all w, since a delay only turns the
/// left side. Below w_n = sqrt(k/M) the right side is least without a spring; above, it is b w or
/// more, and b w / |A| grows. So only w <= w_n count, with k_e = 0. Co-contraction raises k and w_n
/// and keeps the damping ratio, so |A| falls and the border rises; that its slow change swings
/// nothing either is swept by ReactionTest, as are springs that are sampled.
[[nodiscard]] double reflex_borne(const HandPlantConfig& config) noexcept;

/// Where the hand's intent is at one instant.
struct Pull {
  double position{};  ///< [m]
  double velocity{};  ///< [m/s]
};

/// (M + m_h) a = k_h (x_i - x) + b_h (v_i - v) - F - b_m v - friction: a hand at a handle that
/// pushes back with F. One that reacts has c k_h (x_i - x + r) + sqrt(c) b_h (v_i - v) instead, by
/// its tension c and its reflex r (`Reaction`). Semi-implicit Euler in steps of `step`; F is held
/// between calls, the intent is a cubic between its ends. A value; thread: rt-safe.
class HandPlant {
 public:
  HandPlant(const HandPlantConfig& config, double position) noexcept;  ///< [m], at rest

  /// `span` > 0 onwards, against `force` [N], + pushes out.
  void advance(const Pull& begin, const Pull& end, double force, Duration span) noexcept;

  [[nodiscard]] double position() const noexcept { return position_; }  ///< [m]
  [[nodiscard]] double velocity() const noexcept { return velocity_; }  ///< [m/s]
  /// Work the hand did on the device since the start, integral of F dx [J]: exact, as F is held.
  [[nodiscard]] double work() const noexcept { return work_; }

 private:
  /// [N], of the hand on the handle; the handle is `stretch` [m] and `rate` [m/s] behind the
  /// intent.
  [[nodiscard]] double pull(double stretch, double rate, double load) noexcept;

  HandPlantConfig config_;
  TanhTable tanh_;
  Reaction reaction_;
  double position_;    ///< [m]
  double velocity_{};  ///< [m/s]
  double work_{};      ///< [J]
};

}  // namespace palp::surgeon
