#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "common/core/device_facts.h"
#include "common/core/place.h"
#include "common/core/site_state.h"
#include "common/core/time.h"

namespace palp::surgeon {

struct HandState {
  TimePoint sampled_at{};
  double position{};      ///< [m], device axis, + into the tissue
  double velocity{};      ///< [m/s]
  Place place{};          ///< on the undeformed surface
  bool pedal_held{};      ///< the pedal; up: no force
  bool emergency_stop{};  ///< latched by the device or by the user
  bool faulted{};
};

/// What the operator sees of the session: for a device's status lamp or screen, and for a scripted
/// operator, who aligns the hand with the tip before pressing the pedal, as a person would.
struct OperatorView {
  SiteState state{};
  SiteState peer_state{};
  LinkState link{};
  double tip_position{};  ///< [m], as last heard from the patient site, patient's axis
  bool tip_known{};
  std::uint32_t map{};    ///< number of the map, 0: none yet
  Place next{};           ///< where it proposes the next touch
  bool enough_touches{};  ///< it proposes none
};

/// Why a scripted operator let go for good.
enum class ScriptOutcome : std::uint8_t {
  None,         ///< not yet
  Completed,    ///< performed to the end
  Interrupted,  ///< the link was lost, and the operator was told not to engage again
  Refused,      ///< no engagement came about
  Stopped       ///< the site is in state Stopped
};

[[nodiscard]] constexpr std::string_view to_string(ScriptOutcome outcome) noexcept {
  switch (outcome) {
    case ScriptOutcome::None:
      return "";
    case ScriptOutcome::Completed:
      return "completed";
    case ScriptOutcome::Interrupted:
      return "interrupted";
    case ScriptOutcome::Refused:
      return "refused";
    case ScriptOutcome::Stopped:
      return "stopped";
  }
  return "?";
}

/// How far a scripted operator got; a device held by a person has no script.
struct ScriptProgress {
  bool scripted{};
  bool begun{};
  bool finished{};  ///< nothing more will happen
  ScriptOutcome outcome{};
  std::uint32_t phase{};              ///< 1, 2, ...: present or next
  std::array<char, 24> phase_name{};  ///< ends with 0
  double done{};                      ///< [-], 0 to 1
};

/// Thread: rt. Each call returns within 50 us and never blocks; a slow device has its own thread
/// and answers from a mailbox.
class HapticDevice {
 public:
  virtual ~HapticDevice() = default;
  /// What it is: the same for as long as it lives. Thread: any.
  [[nodiscard]] virtual HandFacts hand_facts() const noexcept = 0;
  virtual HandState read(TimePoint now) noexcept = 0;        ///< the last one again if none is new
  virtual void apply(double force) noexcept = 0;             ///< [N], + pushes out; |force| <= max
  virtual void show(const OperatorView& view) noexcept = 0;  ///< devices without a lamp ignore it
  /// The hand presses tissue, or no longer: a device that can lock its plane does so meanwhile.
  virtual void hold_in_plane(bool /*held*/) noexcept {}
  [[nodiscard]] virtual ScriptProgress progress() const noexcept { return {}; }
};

}  // namespace palp::surgeon
