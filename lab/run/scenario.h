#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/core/time.h"
#include "common/coupling/any_coupling.h"
#include "common/link/link.h"
#include "depth/depth_estimator.h"
#include "judge/metrics.h"
#include "lab/run/device_timing.h"
#include "lab/run/fault.h"
#include "netem/model/impairment.h"
#include "netem/model/path_plan.h"
#include "patient_site/patient_node.h"
#include "patient_site/phantom.h"
#include "patient_site/simulated_phantom.h"
#include "surgeon_site/gesture_script.h"
#include "surgeon_site/simulated_hand.h"
#include "surgeon_site/surgeon_node.h"

namespace palp::lab {

/// The sites' settings, as each would have them of the document.
struct SiteTexts {
  std::string surgeon;
  std::string patient;
};

/// What a hand does at the tissue with its own finger (direct_touch.h); NaN, 0: nobody asked.
struct OwnFinger {
  double force{judge::kUndefined};  ///< [N], most that it presses
  double swing{};                   ///< [m], of its own swinging, as judge::SwingFinder has it
  double bump{judge::kUndefined};   ///< [N], most in a drag, as judge::DragBump has it
};

/// Everything that decides a run: two runs of equal scenarios give equal bits.
struct Scenario {
  std::string name;
  std::string text{};  ///< the document it was made of
  SiteTexts site_texts{};
  std::uint64_t seed{1};
  coupling::CouplingConfig coupling;
  std::optional<coupling::OutsideLaw> outside{};  ///< runs in place of what `coupling` names
  link::LinkConfig link;
  surgeon::SurgeonConfig surgeon;
  surgeon::SimulatedHandConfig hand;
  surgeon::GestureScript script;
  patient::PatientConfig patient;
  patient::SimulatedPhantomConfig tissue;
  patient::Phantom phantom;
  DeviceTimings timings{};
  depth::DepthEstimatorConfig estimator;
  netem::Impairment up;    ///< surgeon to patient
  netem::Impairment down;  ///< patient to surgeon
  /// What happens on the way down as the run goes on.
  std::vector<netem::Change> down_changes{};
  Duration duration{};  ///< virtual; 0: until the script is done
  bool bare{};          ///< telegrams as raw structs and no session log: the laws alone, fast
  bool depths{true};    ///< the estimator of the inclusion's depth runs too
  bool lying{};         ///< the patient site's models are random (adversary.h)
  /// > 0: nothing passes for 2 s from there on.
  Duration blackout_at_script_time{};
  Fault fault;         ///< with one, sites meet by the handshake
  OwnFinger finger{};  ///< what the run is held against; it decides nothing of it
};

/// What the devices of a run say of themselves, their timing included.
[[nodiscard]] HandFacts hand_facts_of(const Scenario& scenario) noexcept;
[[nodiscard]] PatientDevices patient_devices_of(const Scenario& scenario) noexcept;

}  // namespace palp::lab
