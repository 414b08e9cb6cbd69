#pragma once

#include <cstdint>

#include "common/core/mailbox.h"
#include "common/core/spsc_queue.h"
#include "common/core/time.h"
#include "common/core/user_command.h"
#include "common/coupling/any_coupling.h"
#include "common/link/link.h"
#include "common/message/depth.h"
#include "common/message/map_report.h"
#include "common/record/recorder.h"
#include "patient_site/force_sensor.h"
#include "patient_site/patient_control.h"
#include "patient_site/patient_status.h"
#include "patient_site/stage.h"

namespace palp::patient {

/// The patient's site, one tick at a time: reads stage and force, hears the link, does what its
/// control decides of them, and lets it write all down. The estimator's newest result rides on
/// every telegram. Owns the control, makes no parts. Thread: rt.
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
    Mailbox<Findings>& found;           ///< writer: the estimator's thread; reader: rt
    Mailbox<MapCells>& cells;           ///< likewise
  };

  PatientNode(const PatientConfig& config, Parts parts);

  /// The only thing that moves this site. Once a period; a late call counts the periods missed.
  void tick(TimePoint now) noexcept;

  /// Writer: the user's thread. Reader: rt.
  [[nodiscard]] Mailbox<UserCommand>& commands() noexcept { return commands_; }
  /// Writer: rt. Reader: the display's thread.
  [[nodiscard]] Mailbox<PatientStatus>& status() noexcept { return status_; }

 private:
  [[nodiscard]] PatientInputs read(TimePoint now) noexcept;
  void act(const PatientOutputs& out, TimePoint now) noexcept;

  Parts parts_;
  PatientControl control_;
  Mailbox<UserCommand> commands_;
  Mailbox<PatientStatus> status_;
};

}  // namespace palp::patient
