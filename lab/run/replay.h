#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "common/core/result.h"
#include "common/coupling/any_coupling.h"
#include "depth/depth_estimator.h"
#include "patient_site/patient_control.h"
#include "surgeon_site/surgeon_control.h"

namespace palp::lab {

/// What came of doing a session file's ticks again.
struct ReplayReport {
  std::uint64_t ticks{};
  std::uint64_t records{};    ///< of the site, made again and compared
  std::uint64_t estimates{};  ///< of the depth estimator, likewise
  std::string difference;     ///< the first; empty: every bit is the same
};

/// Does the ticks of a surgeon's session file again: a new control and a new law are given what
/// the file says that devices, link and user said, and must record what the file holds. The
/// devices describe themselves in the file. Allocates.
/// @returns a sentence where the file does not hold all that a tick was given.
[[nodiscard]] Result<ReplayReport> replay_surgeon(std::span<const std::byte> file,
                                                  const surgeon::SurgeonConfig& config,
                                                  const coupling::CouplingConfig& coupling);

/// The same for a patient's. With an `estimator`, it is given the contact samples that come of it,
/// and must give the file's estimates.
[[nodiscard]] Result<ReplayReport> replay_patient(
    std::span<const std::byte> file,
    const patient::PatientConfig& config,
    const coupling::CouplingConfig& coupling,
    const std::optional<depth::DepthEstimatorConfig>& estimator);

}  // namespace palp::lab
