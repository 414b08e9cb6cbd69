#pragma once

#include <memory>
#include <optional>

#include "common/core/mailbox.h"
#include "common/core/spsc_queue.h"
#include "common/coupling/any_coupling.h"
#include "common/link/link.h"
#include "common/record/recorder.h"
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

/// The hand, seen through the process's clock; and a foot that can be taken off the pedal.
class HandAtClock final : public surgeon::HapticDevice {
 public:
  HandAtClock(surgeon::SimulatedHand& hand, const LocalClock& clock) noexcept
      : hand_{hand}, clock_{clock} {}
  void lift_pedal(bool lifted) noexcept { lifted_ = lifted; }
  /// One of the device's own; None: it works.
  void fail(FaultKind how) noexcept { failing_ = how; }
  [[nodiscard]] bool pedal_held() const noexcept { return held_; }  ///< at the last read()

  [[nodiscard]] HandFacts hand_facts() const noexcept override { return hand_.hand_facts(); }
  surgeon::HandState read(TimePoint now) noexcept override;
  void apply(double force) noexcept override { hand_.apply(force); }
  void hold_in_plane(bool held) noexcept override { hand_.hold_in_plane(held); }
  void show(const surgeon::OperatorView& view) noexcept override { hand_.show(view); }
  [[nodiscard]] surgeon::ScriptProgress progress() const noexcept override {
    return hand_.progress();
  }

 private:
  surgeon::SimulatedHand& hand_;
  const LocalClock& clock_;
  bool lifted_{};
  bool held_{};
  FaultKind failing_{};
};

/// Stage and sensor, seen through the process's clock.
class PhantomAtClock final : public patient::Stage, public patient::ForceSensor {
 public:
  PhantomAtClock(patient::SimulatedPhantom& phantom, const LocalClock& clock) noexcept
      : phantom_{phantom}, clock_{clock} {}
  /// One of stage or sensor; None: they work.
  void fail(FaultKind how) noexcept { failing_ = how; }
  [[nodiscard]] StageFacts stage_facts() const noexcept override { return phantom_.stage_facts(); }
  [[nodiscard]] ForceSensorFacts sensor_facts() const noexcept override {
    return phantom_.sensor_facts();
  }
  patient::StageState read(TimePoint now) noexcept override;
  void move_to(const patient::StageTarget& target) noexcept override;
  void halt() noexcept override { phantom_.halt(); }
  std::optional<patient::ForceSample> sample(TimePoint now) noexcept override;

 private:
  patient::SimulatedPhantom& phantom_;
  const LocalClock& clock_;
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
    Mailbox<DepthEstimate>& depth;
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
