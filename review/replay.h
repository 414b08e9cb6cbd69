#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/core/result.h"
#include "common/coupling/any_coupling.h"
#include "common/message/depth.h"
#include "common/message/map_report.h"
#include "depth/depth_estimator.h"
#include "patient_site/patient_control.h"
#include "review/logged_ticks.h"
#include "surgeon_site/surgeon_control.h"

namespace palp::review {

/// What came of doing a session file's ticks again.
struct ReplayReport {
  std::uint64_t ticks{};
  std::uint64_t records{};    ///< of the site, made again and compared
  std::uint64_t estimates{};  ///< of the depth estimator, likewise
  std::uint64_t maps{};       ///< of all strokes together, likewise
  /// The first, as "topic, time, field: what it was and became", the time since the run began;
  /// empty: every bit is the same.
  std::string difference;
  std::string lack;  ///< of the files, as lack_of() has it, where all of them was done again
};

/// Does the ticks of a surgeon's files again: a new control and a new law are given what the files
/// say that devices, link and user said, and must record what the files hold. The devices describe
/// themselves in the file, at each start of the site. Allocates.
/// @returns a sentence where the files do not hold all that a tick was given.
[[nodiscard]] Result<ReplayReport> replay_surgeon(const RunBytes& files,
                                                  const surgeon::SurgeonConfig& config,
                                                  const coupling::CouplingConfig& coupling);

struct PatientParts {
  patient::PatientConfig config;
  coupling::CouplingConfig coupling;
  /// Given the contact samples that come of the ticks, it must give the files' estimates; absent:
  /// nobody asks.
  std::optional<depth::DepthEstimatorConfig> estimator;
};

/// The same for a patient's.
[[nodiscard]] Result<ReplayReport> replay_patient(const RunBytes& files, const PatientParts& parts);

/// An estimate of the files, and what another estimator would have said of the stroke.
struct OtherEstimate {
  std::optional<DepthEstimate> logged;
  std::optional<DepthEstimate> other;
};

/// What a patient's site with other parts would have done with the same readings. Nobody obeyed it:
/// stage, tissue and hand did what the files say.
struct WhatIf {
  std::uint64_t ticks{};
  std::uint64_t engaged{};      ///< ticks, of the files
  std::uint64_t other_state{};  ///< ticks in which it would have been in another state
  double target_rms{};          ///< [m], of its target less the files', while both were engaged
  double target_max{};          ///< [m], the same
  std::uint64_t gate_acted{};   ///< ticks, of the files
  std::uint64_t gate_would{};   ///< ticks
  std::vector<OtherEstimate> estimates;
  /// Of all places together, after the last stroke that the files tell one of.
  std::optional<MapReport> map_logged;
  std::optional<MapReport> map_other;
  std::string lack;  ///< as a report's
};
[[nodiscard]] Result<WhatIf> what_if_patient(const RunBytes& files, const PatientParts& parts);

}  // namespace palp::review
