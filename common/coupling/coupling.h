#pragma once

#include <concepts>
#include <limits>
#include <span>

#include "common/core/lapse.h"
#include "common/core/place.h"
#include "common/core/site_state.h"
#include "common/core/time.h"
#include "common/message/port_sample.h"

/// A coupling is a control law in two halves, one per site, that talk in PortSamples. Pure: no
/// clock, no I/O, no allocation in step(). Signs and units: common/core/conventions.h.
namespace palp::coupling {

struct SurgeonInput {
  TimePoint now{};
  SiteState state{};                  ///< laws fade and freeze by it
  double position{};                  ///< [m], hand, clutched to the patient's axis
  double velocity{};                  ///< [m/s]
  double force_applied{};             ///< [N], behind the gate, while it moved so: to book energy
  std::span<const Incoming> arrived;  ///< since the last tick, by number; often none or several
  Duration round_trip{};              ///< smoothed; for tuning only, never for safety
};

struct SurgeonOutput {
  double force{};  ///< [N], + pushes the hand out; unlimited, the gate limits
  PortSample to_patient;
  /// [N], most that may push the hand out while a gate that closes fades it: what the law's books
  /// can still pay for.
  double fade_max{std::numeric_limits<double>::infinity()};
  /// [N], of the tissue that the law believes in, the force that it cannot give here and now.
  double force_missing{};
  /// [N], beside that: what this tissue is stiffer by than the law may show.
  double force_too_stiff{};
};

struct PatientInput {
  TimePoint now{};
  SiteState state{};
  double position{};                  ///< [m], tip
  double velocity{};                  ///< [m/s]
  double contact_force{};             ///< [N], measured; noise may make it negative
  Duration position_age{};            ///< since the stage was read
  Duration force_age{};               ///< since the sensor was
  Place place{};                      ///< along the surface; a new place is new tissue
  std::span<const Incoming> arrived;  ///< since the last tick, by number
  Duration round_trip{};
};

struct PatientOutput {
  double target_position{};  ///< [m]; unlimited, the gate limits
  PortSample to_surgeon;
  /// [N], the tip is to press no harder on its way in: the gate brakes in time.
  double force_most{std::numeric_limits<double>::infinity()};
};

/// A law is a value: copy it and both copies go on alike.
template <class Law, class Input, class Output>
concept HalfOfLaw = std::copyable<Law> &&
    requires(Law law, const Input& in, double position, const Lapse& lapse) {
  { law.begin_epoch(position) }
  noexcept;  // sums restart; an energy tank is never refilled
  { law.step(in, lapse) }
  noexcept->std::same_as<Output>;
};

/// The newest fresh sample, or nullptr: late and repaired samples never pass for it.
[[nodiscard]] inline const Incoming* newest(std::span<const Incoming> arrived) noexcept {
  return arrived.empty() || !arrived.back().fresh ? nullptr : &arrived.back();
}

}  // namespace palp::coupling
