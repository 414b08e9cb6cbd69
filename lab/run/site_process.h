#pragma once

#include <memory>
#include <optional>

#include "common/core/mailbox.h"
#include "common/core/spsc_queue.h"
#include "common/coupling/any_coupling.h"
#include "common/link/link.h"
#include "common/record/recorder.h"
#include "lab/run/device_timing.h"
#include "lab/run/fault.h"
#include "lab/run/local_clock.h"
#include "lab/run/scenario.h"
#include "lab/run/session_setup.h"
#include "patient_site/patient_node.h"
#include "patient_site/simulated_phantom.h"
#include "surgeon_site/simulated_hand.h"
#include "surgeon_site/surgeon_node.h"

/// Each site as a process on its machine: what it has when it starts, loses when it is killed, and
/// reads its clock from. Devices live on without it, as a device does whose computer hangs. Thread:
/// the lab's. Times are the lab's.
namespace palp::lab {

/// The hand, seen through the process's clock and at its device's own pace; and a foot that can be
/// taken off the pedal.
class HandAtClock final : public surgeon::HapticDevice {
 public:
  HandAtClock(surgeon::SimulatedHand& hand,
              const Scenario& scenario,
              const LocalClock& clock) noexcept;
  /// Nobody writes to it any more: what was on its way is dropped.
  void let_go() noexcept;
  void lift_pedal(bool lifted) noexcept { lifted_ = lifted; }
  /// One of the device's own; None: it works.
  void fail(FaultKind how) noexcept { failing_ = how; }
  [[nodiscard]] bool pedal_held() const noexcept { return held_; }  ///< at the last read()

  [[nodiscard]] HandFacts hand_facts() const noexcept override { return facts_; }
  surgeon::HandState read(TimePoint now) noexcept override;
  void apply(double force) noexcept override;
  void hold_in_plane(bool held) noexcept override { hand_.hold_in_plane(held); }
  void show(const surgeon::OperatorView& view) noexcept override { hand_.show(view); }
  [[nodiscard]] surgeon::ScriptProgress progress() const noexcept override {
    return hand_.progress();
  }

 private:
  [[nodiscard]] surgeon::HandState poll(TimePoint now) noexcept;

  surgeon::SimulatedHand& hand_;
  HandFacts facts_;
  const LocalClock& clock_;
  bool at_once_;
  DevicePolls polls_;
  Delayed<double> commands_;    ///< [N]
  double asked_{};              ///< [N], last
  surgeon::HandState reading_;  ///< newest, in the lab's time
  bool lifted_{};
  bool held_{};
  FaultKind failing_{};
};

/// Stage and sensor, seen through the process's clock and each at its own pace.
class PhantomAtClock final : public patient::Stage, public patient::ForceSensor {
 public:
  PhantomAtClock(patient::SimulatedPhantom& phantom,
                 const Scenario& scenario,
                 const LocalClock& clock) noexcept;
  /// One of stage or sensor; None: they work.
  void fail(FaultKind how) noexcept { failing_ = how; }
  [[nodiscard]] StageFacts stage_facts() const noexcept override { return facts_.stage; }
  [[nodiscard]] ForceSensorFacts sensor_facts() const noexcept override { return facts_.sensor; }
  patient::StageState read(TimePoint now) noexcept override;
  void move_to(const patient::StageTarget& target) noexcept override;
  void halt() noexcept override;
  std::optional<patient::ForceSample> sample(TimePoint now) noexcept override;

 private:
  /// Of the stage; none: it holds.
  using Command = std::optional<patient::StageTarget>;
  void obey(const Command& command) noexcept;
  [[nodiscard]] patient::StageState poll_stage(TimePoint now) noexcept;
  [[nodiscard]] std::optional<patient::ForceSample> poll_sensor(TimePoint now) noexcept;

  patient::SimulatedPhantom& phantom_;
  PatientDevices facts_;
  const LocalClock& clock_;
  bool stage_at_once_;
  DevicePolls stage_polls_;
  Delayed<Command> commands_;
  Command asked_;                 ///< last
  patient::StageState standing_;  ///< newest reading, in the lab's time
  bool sensor_at_once_;
  DevicePolls sensor_polls_;
  Delayed<patient::ForceSample> felt_;
  FaultKind failing_{};
  double reading_{};  ///< [N], last that was given
};

class SurgeonProcess {
 public:
  SurgeonProcess(const Scenario& scenario,
                 surgeon::SimulatedHand& hand,
                 std::unique_ptr<link::Transport> end,
                 record::Recorder& recorder);

  void start(TimePoint now);
  void kill(TimePoint now);
  /// It stands still: its device holds the last force, and what arrives waits in its socket.
  void pause(bool paused) noexcept { paused_ = paused; }
  void tick(TimePoint now);
  [[nodiscard]] bool alive() const noexcept { return parts_.has_value(); }
  [[nodiscard]] bool paused() const noexcept { return paused_; }
  [[nodiscard]] LocalClock& clock() noexcept { return session_setup_.clock(); }
  [[nodiscard]] HandAtClock& hand() noexcept { return device_; }
  /// Alive, and the pedal down: the force at the hand is this process's own.
  [[nodiscard]] bool pressed() const noexcept { return alive() && device_.pedal_held(); }
  [[nodiscard]] const surgeon::SurgeonStatus& status() const noexcept { return status_; }
  [[nodiscard]] LinkHealth health(TimePoint now) const noexcept;

 private:
  const Scenario& scenario_;
  surgeon::SimulatedHand& hand_;
  SessionSetup session_setup_;
  HandAtClock device_;
  record::Recorder& recorder_;
  surgeon::SurgeonStatus status_;
  bool paused_{};
  struct Running {
    explicit Running(SurgeonProcess& owner);
    link::Link link;
    coupling::SurgeonCoupling law;
    surgeon::SurgeonNode node;
  };
  std::optional<Running> parts_;
};

class PatientProcess {
 public:
  /// All outlive it.
  struct Surroundings {
    patient::SimulatedPhantom& phantom;
    record::Recorder& recorder;
    SpscQueue<ContactSample>& contact;
    Mailbox<Findings>& found;
    Mailbox<MapCells>& cells;
  };
  PatientProcess(const Scenario& scenario,
                 const Surroundings& around,
                 std::unique_ptr<link::Transport> end);

  void start(TimePoint now);
  void kill(TimePoint now);
  /// It stands still: its stage goes on to the last target, and what arrives waits in its socket.
  void pause(bool paused) noexcept { paused_ = paused; }
  void tick(TimePoint now);
  [[nodiscard]] bool paused() const noexcept { return paused_; }
  [[nodiscard]] LocalClock& clock() noexcept { return session_setup_.clock(); }
  [[nodiscard]] PhantomAtClock& devices() noexcept { return device_; }
  [[nodiscard]] LinkHealth health(TimePoint now) const noexcept;

 private:
  const Scenario& scenario_;
  Surroundings around_;
  SessionSetup session_setup_;
  PhantomAtClock device_;
  bool paused_{};
  struct Running {
    explicit Running(PatientProcess& owner);
    link::Link link;
    coupling::PatientCoupling law;
    patient::PatientNode node;
  };
  std::optional<Running> parts_;
};

}  // namespace palp::lab
