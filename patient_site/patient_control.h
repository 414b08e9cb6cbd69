#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "common/core/device_facts.h"
#include "common/core/spsc_queue.h"
#include "common/core/time.h"
#include "common/core/user_command.h"
#include "common/coupling/any_coupling.h"
#include "common/link/telegram.h"
#include "common/message/depth.h"
#include "common/message/map_report.h"
#include "common/record/recorder.h"
#include "common/record/site_account.h"
#include "patient_site/device_watch.h"
#include "patient_site/force_sensor.h"
#include "patient_site/motion_gate.h"
#include "patient_site/patient_status.h"
#include "patient_site/stage.h"
#include "patient_site/supervisor.h"

namespace palp::patient {

struct PatientConfig {
  Duration period{std::chrono::milliseconds{1}};
  MotionGateConfig gate;    ///< the stage's own limits are kept as well
  DeviceWatchConfig watch;  ///< the sensor's steps are allowed for as well
  Duration sensor_stale{std::chrono::milliseconds{50}};  ///< older force is a device fault
  Duration link_status_every{std::chrono::milliseconds{100}};
};

/// All that a tick is given. The session file holds the same.
struct PatientInputs {
  TimePoint now{};
  StageState stage;
  std::optional<ForceSample> force;
  UserCommand user;
  link::Arrivals arrived;  ///< its samples are valid until the next receive() of the link
  LinkHealth link;
  DeviceFacts peer_devices;  ///< says something where the session is another than a tick ago
  Findings found;            ///< newest
  std::span<const MapCell> map_cells;  ///< of the newest map; valid for this tick
};

/// All that a tick wants done.
struct PatientOutputs {
  bool halt{};  ///< and no target
  StageTarget target;
  Telegram to_peer;
};

/// What the patient's site does with a tick: from the same inputs, in the same order, the same
/// outputs and records, bit for bit. Touches no device and no link. Lets the supervisor decide,
/// steps the law, passes its target through the gate, and records all of it. While Engaged each
/// tick gives the depth estimator a sample. Owns supervisor and gate. Thread: rt.
class PatientControl {
 public:
  /// All outlive it.
  struct Parts {
    coupling::PatientCoupling& law;
    record::Recorder& recorder;
    SpscQueue<ContactSample>& contact;  ///< writer: rt; reader: the estimator's thread
  };

  PatientControl(const PatientConfig& config, const PatientDevices& devices, Parts parts) noexcept;

  /// Both halves of a tick, for whoever has nothing to do in between.
  PatientOutputs step(const PatientInputs& in) noexcept {
    const PatientOutputs out = decide(in);
    write_down(in, out);
    return out;
  }
  /// Once a tick, then write_down() with the same inputs: what is to be done is done in between.
  [[nodiscard]] PatientOutputs decide(const PatientInputs& in) noexcept;
  void write_down(const PatientInputs& in, const PatientOutputs& out) noexcept;

  /// After write_down().
  [[nodiscard]] const PatientStatus& status() const noexcept { return now_; }

 private:
  void take_stage(const StageState& read) noexcept;
  void take_force(const std::optional<ForceSample>& read) noexcept;
  void find_tip() noexcept;
  void watch_devices(const Lapse& lapse) noexcept;
  void note_not_finite(bool finite, bool& was_finite) noexcept;
  void find_fault(bool found, record::NoteCode what) noexcept;
  [[nodiscard]] SupervisorOutput supervise(const PatientInputs& in, const Lapse& lapse) noexcept;
  void record_decision(const SupervisorOutput& decision, SiteState before) noexcept;
  [[nodiscard]] coupling::PatientInput law_input(const link::Arrivals& arrived) const noexcept;
  [[nodiscard]] MotionAnswer limit(const coupling::PatientOutput& wanted,
                                   const Place& place,
                                   const Lapse& lapse) noexcept;
  [[nodiscard]] double stage_target(double tip) const noexcept;
  [[nodiscard]] DepthReport depth_report() const noexcept;
  [[nodiscard]] MapReport map_report() const noexcept;
  [[nodiscard]] MapCell map_cell(std::span<const MapCell> cells) const noexcept;
  void take_findings(const Findings& found) noexcept;
  void give_contact_sample() noexcept;
  void record_readings(const PatientInputs& in) noexcept;

  PatientConfig config_;
  PatientDevices devices_;
  Parts parts_;
  PatientSupervisor supervisor_;
  MotionGate gate_;
  DeviceWatch watch_;
  record::SiteAccount account_;
  PatientStatus now_;  ///< of this tick: what is shown, and what one tick leaves to the next
  bool begun_{};
  double stage_position_{};          ///< [m], the last one that was a number
  bool gate_begun_{};                ///< with the first reading that has numbers
  record::NoteCode device_fault_{};  ///< the first that was found in this tick
  bool stage_was_finite_{true};
  bool force_was_finite_{true};
  bool session_began_{};  ///< or ended, in this tick
  TimePoint stage_sampled_at_{};
  TimePoint force_sampled_at_{};
  TimePoint awake_since_{};       ///< the site stood still, until then
  std::uint32_t resets_{};        ///< last heard of
  std::uint32_t found_before_{};  ///< number of the last stroke before this session
};

}  // namespace palp::patient
