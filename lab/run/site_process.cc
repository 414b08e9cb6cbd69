#include "lab/run/site_process.h"

#include <cmath>
#include <utility>

#include "common/link/codec_wire.h"
#include "lab/run/adversary.h"

namespace palp::lab {
namespace {

std::unique_ptr<link::Codec> make_codec(const Scenario& scenario) {
  if (scenario.bare) return std::make_unique<link::RawCodec>();
  return std::make_unique<link::WireCodec>();
}

std::unique_ptr<link::Codec> patient_codec(const Scenario& scenario) {
  auto codec = make_codec(scenario);
  if (!scenario.lying) return codec;
  return std::make_unique<LyingCodec>(
      std::move(codec), scenario.seed, scenario.link.period, drawn_manner(scenario.seed));
}

coupling::SurgeonCoupling surgeon_law(const Scenario& scenario) {
  if (scenario.outside) return scenario.outside->surgeon;
  return coupling::make_surgeon_coupling(scenario.coupling, hand_facts_of(scenario)).value();
}

coupling::PatientCoupling patient_law(const Scenario& scenario) {
  if (scenario.outside) return scenario.outside->patient;
  return coupling::make_patient_coupling(scenario.coupling, patient_devices_of(scenario)).value();
}

// Streams of chance.
constexpr std::uint64_t kHandPolls = 0x68616e64;    // "hand"
constexpr std::uint64_t kStagePolls = 0x73746167;   // "stag"
constexpr std::uint64_t kSensorPolls = 0x73656e73;  // "sens"

}  // namespace

HandAtClock::HandAtClock(surgeon::SimulatedHand& hand,
                         const Scenario& scenario,
                         const LocalClock& clock) noexcept
    : hand_{hand},
      facts_{hand_facts_of(scenario)},
      clock_{clock},
      at_once_{scenario.timings.hand.at_once()},
      polls_{scenario.timings.hand, scenario.seed, kHandPolls},
      commands_{scenario.timings.hand.lag} {}

void HandAtClock::let_go() noexcept {
  asked_ = 0;
  commands_.clear();
}

void HandAtClock::apply(double force) noexcept {
  asked_ = force;
  if (at_once_) hand_.apply(force);
}

/// The person and the handle go on whether the device is asked or not.
surgeon::HandState HandAtClock::poll(TimePoint now) noexcept {
  const surgeon::HandState state = hand_.read(now);
  if (at_once_) return state;
  if (polls_.due(now)) {
    reading_ = state;
    commands_.put(now, asked_);
  }
  hand_.apply(commands_.at(now, 0));
  return reading_;
}

surgeon::HandState HandAtClock::read(TimePoint now) noexcept {
  surgeon::HandState state = poll(clock_.world(now));
  state.sampled_at = clock_.local(state.sampled_at);
  if (lifted_) state.pedal_held = false;
  held_ = state.pedal_held;
  if (failing_ == FaultKind::HandNotFinite) state.position = std::nan("");
  if (failing_ == FaultKind::HandFaulted) state.faulted = true;
  if (failing_ == FaultKind::EmergencyStop) state.emergency_stop = true;
  return state;
}

PhantomAtClock::PhantomAtClock(patient::SimulatedPhantom& phantom,
                               const Scenario& scenario,
                               const LocalClock& clock) noexcept
    : phantom_{phantom},
      facts_{patient_devices_of(scenario)},
      clock_{clock},
      stage_at_once_{scenario.timings.stage.at_once()},
      stage_polls_{scenario.timings.stage, scenario.seed, kStagePolls},
      commands_{scenario.timings.stage.lag},
      sensor_at_once_{scenario.timings.sensor.at_once()},
      sensor_polls_{scenario.timings.sensor, scenario.seed, kSensorPolls},
      felt_{scenario.timings.sensor.lag} {}

void PhantomAtClock::obey(const Command& command) noexcept {
  command ? phantom_.move_to(*command) : phantom_.halt();
}

patient::StageState PhantomAtClock::poll_stage(TimePoint now) noexcept {
  const patient::StageState state = phantom_.read(now);
  if (stage_at_once_) return state;
  if (stage_polls_.due(now)) {
    standing_ = state;
    commands_.put(now, asked_);
    obey(commands_.at(now, std::nullopt));
  }
  return standing_;
}

std::optional<patient::ForceSample> PhantomAtClock::poll_sensor(TimePoint now) noexcept {
  const auto sample = phantom_.sample(now);
  if (sensor_at_once_ || !sample) return sample;
  felt_.put(now, *sample);
  if (!sensor_polls_.due(now)) return std::nullopt;
  // It cannot know how old its own reading is.
  patient::ForceSample late = felt_.at(now, *sample);
  late.sampled_at = now;
  return late;
}

patient::StageState PhantomAtClock::read(TimePoint now) noexcept {
  patient::StageState state = poll_stage(clock_.world(now));
  state.sampled_at = clock_.local(state.sampled_at);
  if (failing_ == FaultKind::StageFaulted) state.faulted = true;
  return state;
}

void PhantomAtClock::move_to(const patient::StageTarget& target) noexcept {
  if (failing_ == FaultKind::StageStuck) return halt();
  asked_ = target;
  if (stage_at_once_) phantom_.move_to(target);
}

void PhantomAtClock::halt() noexcept {
  asked_.reset();
  if (stage_at_once_) phantom_.halt();
}

std::optional<patient::ForceSample> PhantomAtClock::sample(TimePoint now) noexcept {
  auto sample = poll_sensor(clock_.world(now));
  if (!sample || failing_ == FaultKind::SensorSilent) return std::nullopt;
  constexpr double kOffset = 1;  // [N]
  sample->sampled_at = clock_.local(sample->sampled_at);
  if (failing_ == FaultKind::SensorStuck) sample->force = reading_;
  reading_ = sample->force;
  if (failing_ == FaultKind::SensorOffset) sample->force += kOffset;
  if (failing_ == FaultKind::SensorNotFinite) sample->force = std::nan("");
  return sample;
}

SurgeonProcess::Running::Running(SurgeonProcess& owner)
    : link{owner.scenario_.link, make_codec(owner.scenario_)},
      law{surgeon_law(owner.scenario_)},
      node{owner.scenario_.surgeon, {owner.device_, law, link, owner.recorder_}} {}

SurgeonProcess::SurgeonProcess(const Scenario& scenario,
                               surgeon::SimulatedHand& hand,
                               std::unique_ptr<link::Transport> end,
                               record::Recorder& recorder)
    : scenario_{scenario},
      hand_{hand},
      session_setup_{scenario, link::Role::Surgeon, std::move(end)},
      device_{hand, scenario, session_setup_.clock()},
      recorder_{recorder} {}

void SurgeonProcess::start(TimePoint now) {
  parts_.emplace(*this);
  session_setup_.start(parts_->link, now);
}

void SurgeonProcess::kill(TimePoint now) {
  parts_.reset();
  session_setup_.kill(now);
  const double offset = status_.offset;
  const Place place = status_.place;
  status_ = {};
  status_.offset = offset;
  status_.place = place;
}

void SurgeonProcess::tick(TimePoint now) {
  if (!parts_) {
    // A device that nobody writes to any more lets go by itself.
    (void)hand_.read(now);
    device_.let_go();
    hand_.apply(0);
    hand_.hold_in_plane(false);
    hand_.show({});
    session_setup_.lose(now);
    return;
  }
  if (paused_) {
    (void)hand_.read(now);
    return;
  }
  parts_->node.tick(session_setup_.clock().local(now));
  session_setup_.step(now);
  status_ = parts_->node.status().get();
}

LinkHealth SurgeonProcess::health(TimePoint now) const noexcept {
  return parts_ ? parts_->link.health(session_setup_.clock().local(now)) : LinkHealth{};
}

PatientProcess::Running::Running(PatientProcess& owner)
    : link{owner.scenario_.link, patient_codec(owner.scenario_)},
      law{patient_law(owner.scenario_)},
      node{owner.scenario_.patient,
           {owner.device_,
            owner.device_,
            law,
            link,
            owner.around_.recorder,
            owner.around_.contact,
            owner.around_.found,
            owner.around_.cells}} {}

PatientProcess::PatientProcess(const Scenario& scenario,
                               const Surroundings& around,
                               std::unique_ptr<link::Transport> end)
    : scenario_{scenario},
      around_{around},
      session_setup_{scenario, link::Role::Patient, std::move(end)},
      device_{around.phantom, scenario, session_setup_.clock()} {}

void PatientProcess::start(TimePoint now) {
  parts_.emplace(*this);
  session_setup_.start(parts_->link, now);
}

void PatientProcess::kill(TimePoint now) {
  parts_.reset();
  session_setup_.kill(now);
}

void PatientProcess::tick(TimePoint now) {
  if (!parts_) {
    // The drive holds the stage where it stands.
    (void)around_.phantom.read(now);
    around_.phantom.halt();
    session_setup_.lose(now);
    return;
  }
  if (paused_) {
    (void)around_.phantom.read(now);
    return;
  }
  parts_->node.tick(session_setup_.clock().local(now));
  session_setup_.step(now);
}

LinkHealth PatientProcess::health(TimePoint now) const noexcept {
  return parts_ ? parts_->link.health(session_setup_.clock().local(now)) : LinkHealth{};
}

}  // namespace palp::lab
