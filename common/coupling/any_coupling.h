#pragma once

#include <array>
#include <string>
#include <string_view>
#include <variant>

#include "common/core/result.h"
#include "common/coupling/coupling.h"
#include "common/coupling/direct.h"
#include "common/coupling/mmt.h"
#include "common/coupling/tdpa.h"
#include "common/coupling/wave.h"

/// The closed set of laws. To add one: one file pair here, one line in each list below and, where
/// it sends more than position and force, a payload in core/port_sample.h with its `oneof` member
/// in proto/link.proto.
namespace palp::coupling {

using SurgeonCoupling = std::variant<DirectSurgeon, WaveSurgeon, TdpaSurgeon, MmtSurgeon>;
using PatientCoupling = std::variant<DirectPatient, WavePatient, TdpaPatient, MmtPatient>;

inline constexpr std::array<std::string_view, 4> kCouplingNames{"direct", "wave", "tdpa", "mmt"};

struct CouplingConfig {
  std::string name{"mmt"};
  DirectConfig direct;
  WaveConfig wave;
  TdpaConfig tdpa;
  MmtConfig mmt;
};

/// The half named by `config.name`, or a sentence that lists the names there are.
[[nodiscard]] Result<SurgeonCoupling> make_surgeon_coupling(const CouplingConfig& config);
[[nodiscard]] Result<PatientCoupling> make_patient_coupling(const CouplingConfig& config);

// No half throws while it is moved, so that no law is ever valueless and no visit throws.
// NOLINTBEGIN(bugprone-exception-escape)
inline void begin_epoch(SurgeonCoupling& law, double position) noexcept {
  std::visit([&](auto& half) { half.begin_epoch(position); }, law);
}
inline void begin_epoch(PatientCoupling& law, double position) noexcept {
  std::visit([&](auto& half) { half.begin_epoch(position); }, law);
}
inline SurgeonOutput step(SurgeonCoupling& law, const SurgeonInput& in, Duration dt) noexcept {
  return std::visit([&](auto& half) { return half.step(in, dt); }, law);
}
inline PatientOutput step(PatientCoupling& law, const PatientInput& in, Duration dt) noexcept {
  return std::visit([&](auto& half) { return half.step(in, dt); }, law);
}
// NOLINTEND(bugprone-exception-escape)

}  // namespace palp::coupling
