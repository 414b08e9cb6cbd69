#pragma once

#include <array>
#include <string>
#include <string_view>
#include <variant>

#include "common/core/device_facts.h"
#include "common/core/result.h"
#include "common/coupling/coupling.h"
#include "common/coupling/direct.h"
#include "common/coupling/mmt.h"
#include "common/coupling/outside_law.h"
#include "common/coupling/tdpa.h"
#include "common/coupling/wave.h"

/// The closed set of laws. To add one: one file pair here, one line in each list below and, where
/// it sends more than position and force, a payload in common/message/port_sample.h
/// (ARCHITECTURE.md, "A coupling").
namespace palp::coupling {

using SurgeonCoupling =
    std::variant<DirectSurgeon, WaveSurgeon, TdpaSurgeon, MmtSurgeon, OutsideSurgeon>;
using PatientCoupling =
    std::variant<DirectPatient, WavePatient, TdpaPatient, MmtPatient, OutsidePatient>;

inline constexpr std::array<std::string_view, 4> kCouplingNames{"direct", "wave", "tdpa", "mmt"};

struct CouplingConfig {
  std::string name{"mmt"};
  DirectConfig direct;
  WaveConfig wave;
  TdpaConfig tdpa;
  MmtConfig mmt;
};

/// The half named by `config.name`, or a sentence that lists the names there are.
/// `hand`, `devices`: the site's own.
[[nodiscard]] Result<SurgeonCoupling> make_surgeon_coupling(const CouplingConfig& config,
                                                            const HandFacts& hand = {});
[[nodiscard]] Result<PatientCoupling> make_patient_coupling(const CouplingConfig& config,
                                                            const PatientDevices& devices = {});

/// As std::visit, of a law that is never valueless, because no half throws while it is moved: so
/// nothing is thrown here.
template <std::size_t I = 0, class Law, class Act>
auto with_half(Law& law, const Act& act) noexcept {
  if constexpr (I + 1 < std::variant_size_v<Law>) {
    if (law.index() != I) return with_half<I + 1>(law, act);
  }
  return act(*std::get_if<I>(&law));
}

/// A session begins with a site that has these devices. Until then the law assumes the usual ones.
inline void meet(SurgeonCoupling& law, const PatientDevices& devices) noexcept {
  with_half(law, [&](auto& half) {
    if constexpr (requires { half.meet(devices); }) half.meet(devices);
  });
}
/// [-], what the law means to give of the tip's force.
[[nodiscard]] inline double force_scale(const SurgeonCoupling& law) noexcept {
  return with_half(law, [](const auto& half) {
    if constexpr (requires { half.force_scale(); }) {
      return half.force_scale();
    } else {
      return 1.0;
    }
  });
}
inline void begin_epoch(SurgeonCoupling& law, double position) noexcept {
  with_half(law, [&](auto& half) { half.begin_epoch(position); });
}
inline void begin_epoch(PatientCoupling& law, double position) noexcept {
  with_half(law, [&](auto& half) { half.begin_epoch(position); });
}
inline SurgeonOutput step(SurgeonCoupling& law,
                          const SurgeonInput& in,
                          const Lapse& lapse) noexcept {
  return with_half(law, [&](auto& half) { return half.step(in, lapse); });
}
inline PatientOutput step(PatientCoupling& law,
                          const PatientInput& in,
                          const Lapse& lapse) noexcept {
  return with_half(law, [&](auto& half) { return half.step(in, lapse); });
}

}  // namespace palp::coupling
