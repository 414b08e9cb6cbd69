#pragma once

#include <cstdint>
#include <optional>

#include "common/core/filters.h"
#include "common/core/mailbox.h"
#include "common/core/spsc_queue.h"
#include "common/core/time.h"
#include "common/coupling/any_coupling.h"
#include "common/link/link.h"
#include "common/message/depth.h"
#include "common/record/link_events.h"
#include "common/record/recorder.h"
#include "patient_site/device_watch.h"
#include "patient_site/force_sensor.h"
#include "patient_site/motion_gate.h"
#include "patient_site/patient_status.h"
#include "patient_site/stage.h"
#include "patient_site/supervisor.h"

namespace palp::patient {

struct PatientConfig {
  Duration period{std::chrono::milliseconds{1}};
  MotionGateConfig gate;
  DeviceWatchConfig watch;
  double sensor_cut_off{20};  ///< [Hz], the transducer's pole: the position is given the same
  Duration sensor_stale{std::chrono::milliseconds{50}};  ///< older force is a device fault
  Duration link_status_every{std::chrono::milliseconds{100}};
};

/// What the user asks of the site by other means than a device. The newest counts.
struct UserCommand {
  bool emergency_stop{};   ///< as long as it is set
  std::uint32_t resets{};  ///< one more: leave state Stopped
};

/// The patient's site, one tick at a time: reads stage and force, hears the link, lets the
/// supervisor decide, steps the law, passes its target through the gate, and sends and records all
/// of it. While Engaged each tick gives the depth estimator a sample; its newest result rides on
/// every telegram. Owns supervisor and gate, makes no parts. Thread: rt.
class PatientNode {
 public:
  /// All outlive the node.
  struct Parts {
    Stage& stage;
    ForceSensor& sensor;
    coupling::PatientCoupling& law;
    link::Link& link;
    record::Recorder& recorder;
    SpscQueue<ContactSample>& contact;  ///< writer: rt; reader: the estimator's thread
    Mailbox<DepthEstimate>& depth;      ///< writer: the estimator's thread; reader: rt
  };

  PatientNode(const PatientConfig& config, Parts parts);

  /// The only thing that moves this site. Once a period; a late call counts the periods missed.
  void tick(TimePoint now) noexcept;

  /// Writer: the user's thread. Reader: rt.
  [[nodiscard]] Mailbox<UserCommand>& commands() noexcept { return commands_; }
  /// Writer: rt. Reader: the display's thread.
  [[nodiscard]] Mailbox<PatientStatus>& status() noexcept { return status_; }

 private:
  [[nodiscard]] Duration time_passed(TimePoint now) noexcept;
  void read_stage() noexcept;
  void read_force() noexcept;
  void watch_devices(Duration dt) noexcept;
  void note_not_finite(bool finite, bool& was_finite) noexcept;
  [[nodiscard]] SupervisorOutput supervise(const link::Arrivals& arrived) noexcept;
  void record_decision(const SupervisorOutput& decision, SiteState before) noexcept;
  [[nodiscard]] coupling::PatientInput law_input(const link::Arrivals& arrived) const noexcept;
  [[nodiscard]] MotionAnswer move(double target, const Place& place, Duration dt) noexcept;
  void give_contact_sample() noexcept;
  [[nodiscard]] DepthReport depth_report() noexcept;
  void record_link() noexcept;
  void note(record::NoteCode code, double detail = 0) noexcept;
  void record(const Record& record) noexcept;

  PatientConfig config_;
  Parts parts_;
  PatientSupervisor supervisor_;
  MotionGate gate_;
  DeviceWatch watch_;
  Mailbox<UserCommand> commands_;
  Mailbox<PatientStatus> status_;
  PatientStatus now_;  ///< of this tick: what is shown, and what one tick leaves to the next
  record::LinkEvents link_events_;
  LowPass co_filter_;  ///< of the tip, the transducer's pole
  bool begun_{};
  bool device_faulted_{};  ///< in this tick
  bool stage_was_finite_{true};
  bool force_was_finite_{true};
  TimePoint force_sampled_at_{};
  std::uint32_t resets_{};  ///< last heard of
  std::optional<TimePoint> link_recorded_at_;
};

}  // namespace palp::patient
