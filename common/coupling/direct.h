#pragma once

#include "common/core/limits.h"
#include "common/coupling/coupling.h"
#include "common/coupling/force_growth.h"

/// Coupling `direct`: eq. (1) of the paper, as it stands. Not stable under delay: use it below a
/// round trip of about 20 ms, and never with a light grip and a soft spring.
namespace palp::coupling {

struct DirectConfig {
  double force_scale{1.0};     ///< [-], alpha
  double position_scale{1.0};  ///< [-], beta
  double spring{200.0};        ///< [N/m], k_p
  double fade_out{0.2};        ///< [s], force to zero in Hold
  double fade_in{0.5};         ///< [s], and back in Engaged
  /// Of the force, to both sides. Stiffness: of the stiffest tissue; the spring's is added. The law
  /// has no damping that would explain more.
  ForceGrowthConfig change{.slew = 30, .stiffness = 450, .damping = 0};
};

/// F_h = alpha * F_s(newest) + k_p * (beta * x_m - x_s(newest)): paper eq. (1) in our signs.
/// Before the first sample of an epoch the force is zero; in Hold it fades. It changes no faster
/// than the hand's way explains, and 30 N/s beside, to either side: whatever the peer says is no
/// kick. This law has no books, so nobody counts what a force that is held up gives.
class DirectSurgeon {
 public:
  explicit DirectSurgeon(const DirectConfig& config) noexcept;
  void begin_epoch(double position) noexcept;
  SurgeonOutput step(const SurgeonInput& in, const Lapse& lapse) noexcept;
  /// [-], of the tip's force.
  [[nodiscard]] double force_scale() const noexcept { return config_.force_scale; }

 private:
  DirectConfig config_;
  PortSample tip_;  ///< last heard
  bool heard_{};
  Ramp fade_{1};
  ForceGrowth change_;
  double force_{};     ///< [N]
  double position_{};  ///< [m], of the hand
};

/// The stage follows beta * x_m(newest); it stays where it is until something was heard.
class DirectPatient {
 public:
  explicit DirectPatient(const DirectConfig& config) noexcept : config_{config} {}
  void begin_epoch(double position) noexcept;
  PatientOutput step(const PatientInput& in, const Lapse& lapse) noexcept;

 private:
  DirectConfig config_;
  double target_{};  ///< [m]
};

static_assert(HalfOfLaw<DirectSurgeon, SurgeonInput, SurgeonOutput>);
static_assert(HalfOfLaw<DirectPatient, PatientInput, PatientOutput>);

}  // namespace palp::coupling
