#include "lab/run/run.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <optional>

#include "common/core/denormals.h"
#include "common/core/mailbox.h"
#include "common/core/spsc_queue.h"
#include "judge/truth_judge.h"
#include "lab/run/session_files.h"
#include "lab/run/simulator.h"
#include "lab/run/site_process.h"
#include "lab/run/state_digest.h"
#include "lab/run/valve.h"
#include "netem/model/pipe.h"
#include "patient_site/estimator_worker.h"
#include "review/phase_finder.h"

namespace palp::lab {
namespace {

/// Longer than any script plus its re-engagements; a run that hangs must end.
constexpr Duration kRunMax = std::chrono::hours{5};
/// What happens after the script: the pedal goes up and the force fades.
constexpr Duration kAfterScript = std::chrono::milliseconds{500};
constexpr std::size_t kInFlightMax = 4096;
constexpr std::size_t kContactQueue = 4096;
constexpr std::uint64_t kTissueStream = 0x7469737375650000;  ///< keeps the sensor's noise apart

/// Writes at once: in virtual time nobody waits for a disk.
class DirectRecorder final : public record::Recorder {
 public:
  explicit DirectRecorder(record::SessionWriter* writer) : writer_{writer} {}
  bool record(const Record& record) noexcept override {
    if (const auto* estimate = std::get_if<DepthEstimate>(&record)) estimates_.push_back(*estimate);
    if (const auto* map = std::get_if<MapEstimate>(&record)) map_ = map->report;
    return writer_ == nullptr || writer_->write(record);
  }
  [[nodiscard]] const std::vector<DepthEstimate>& estimates() const { return estimates_; }
  [[nodiscard]] const MapReport& map() const { return map_; }

 private:
  record::SessionWriter* writer_;
  std::vector<DepthEstimate> estimates_;
  MapReport map_;
};

judge::EnergyBound bound_of(const Scenario& scenario) {
  const surgeon::HandPlantConfig& hand = scenario.hand.plant;
  return {.grip = hand.grip.stiffness,
          .energy = scenario.coupling.mmt.tank,
          .damping = hand.grip.damping + hand.damping,
          .friction = hand.friction,
          .friction_speed = hand.friction_speed};
}

constexpr Duration kBlackout = std::chrono::seconds{2};

/// Follows the plant's true states: for the judge, and for the surgeon's file where one is kept.
class Probe {
 public:
  Probe(const Scenario& scenario,
        const surgeon::SimulatedHand& hand,
        const patient::SimulatedPhantom& tissue,
        record::SessionWriter* file)
      : scenario_{scenario},
        hand_{hand},
        tissue_{tissue},
        file_{file},
        phases_{scenario.script},
        field_{patient::make_field(scenario.phantom, scenario.tissue.viscous_factor)},
        relaxing_{scenario.phantom.relaxation},
        judge_{{.force_cap = scenario.hand.force_max,
                .period = seconds(scenario.link.period),
                .force_continuous = scenario.hand.force_continuous,
                .own_swing = scenario.finger.swing,
                .stiffest = scenario.coupling.mmt.slope_max,
                .round_trip = seconds(scenario.up.delay.mean + scenario.down.delay.mean),
                .tip_force_limit = scenario.patient.gate.force_limit,
                .bound = bound_of(scenario)}} {}

  /// Of the run's path and time at a look.
  struct Moment {
    TimePoint now{};
    Duration run_time{};
    bool dark{};
  };

  void look(SurgeonProcess& site,
            const PatientProcess& peer,
            const Moment& moment,
            Digest& digest) {
    const surgeon::SurgeonStatus& status = site.status();
    const surgeon::HandTruth hand = hand_.truth();
    const patient::PhantomTruth tissue = tissue_.truth();
    for (const double state : {hand.position,
                               hand.velocity,
                               hand.force,
                               hand.work,
                               tissue.position,
                               tissue.velocity,
                               tissue.contact_force,
                               tissue.noisy_force,
                               tissue.tissue_energy}) {
      digest.add(state);
    }
    // What the hand itself would have felt, had it pressed the tissue.
    const double depth = hand.position - status.offset - tissue.surface;
    const double force_true =
        relaxing_.step(field_->elastic_force(status.place, depth), seconds(scenario_.link.period));
    const review::PhaseFinder::Found phase = phases_.find(hand.script_time, status.place);
    const PlantTruth truth{
        .at = site.clock().local(moment.now),
        .run_time = moment.run_time,
        .script_time = hand.script_time,
        .phase_kind = static_cast<std::uint32_t>(phase.tag.kind),
        .phase_index = static_cast<std::uint32_t>(phase.tag.index),
        .phase_began = phase.began_at,
        .phase_duration = phase.duration,
        .phase_place = phase.tag.place,
        .performing = hand.performing && site.alive(),
        .counted = status.state == SiteState::Engaged || status.state == SiteState::Hold,
        .guarded = site.pressed(),
        .held = site.paused(),
        .resumed = paused_ || scenario_.lying,
        .dark = moment.dark,
        .hand = depth,
        .hand_velocity = hand.velocity,
        .hand_force = hand.force,
        .hand_work = hand.work,
        .force_true = force_true,
        .surface = tissue.surface - scenario_.tissue.surface_offset,
        .tip = tissue.position - tissue.surface,
        .tip_velocity = tissue.velocity,
        .tip_place = tissue.place,
        .contact_force = tissue.contact_force,
        .tissue_energy = tissue.tissue_energy};
    paused_ = site.paused() || peer.paused();
    const bool told_short = status.shortage != record::NoteCode::None;
    if (const auto tick = judge_.look(truth, told_short)) ticks_.push_back(*tick);
    if (file_ != nullptr) file_->write(truth);
  }
  [[nodiscard]] const judge::TruthJudge& judge() const { return judge_; }
  [[nodiscard]] std::vector<judge::RunTick> take_ticks() { return std::move(ticks_); }

 private:
  const Scenario& scenario_;
  const surgeon::SimulatedHand& hand_;
  const patient::SimulatedPhantom& tissue_;
  record::SessionWriter* file_;
  review::PhaseFinder phases_;
  std::unique_ptr<patient::TissueField> field_;
  patient::RelaxingForce relaxing_;
  bool paused_{};  ///< either site, at the last look
  judge::TruthJudge judge_;
  std::vector<judge::RunTick> ticks_;
};

/// Makes the one fault of a run happen, and ends it.
class FaultInjector {
 public:
  FaultInjector(const Fault& fault, SurgeonProcess& surgeon, PatientProcess& patient)
      : fault_{fault}, surgeon_{surgeon}, patient_{patient} {}

  void step(TimePoint now, const surgeon::HandTruth& hand) {
    if (fault_.kind == FaultKind::None) return;
    if (!began_at_ && hand.performing && hand.script_time >= fault_.at_script_time) {
      began_at_ = now;
      begin(now);
    } else if (began_at_ && pauses()) {
      pause(now - *began_at_);
    } else if (began_at_ && !over_ && now - *began_at_ >= fault_.amount) {
      over_ = true;
      end(now);
    }
  }

 private:
  [[nodiscard]] bool pauses() const {
    return fault_.kind == FaultKind::PauseSurgeon || fault_.kind == FaultKind::PausePatient;
  }
  /// `since`: the first began.
  void pause(Duration since) {
    const Duration cycle = fault_.amount + fault_.apart;
    const bool paused =
        cycle > Duration{0} && since / cycle < fault_.count && since % cycle < fault_.amount;
    if (fault_.kind == FaultKind::PauseSurgeon) surgeon_.pause(paused);
    if (fault_.kind == FaultKind::PausePatient) patient_.pause(paused);
  }
  void begin(TimePoint now) {
    if (pauses()) pause({});
    if (fault_.kind == FaultKind::KillSurgeon) surgeon_.kill(now);
    if (fault_.kind == FaultKind::KillPatient) patient_.kill(now);
    if (fault_.kind == FaultKind::StepSurgeonClock) surgeon_.clock().ahead += fault_.amount;
    if (fault_.kind == FaultKind::StepPatientClock) patient_.clock().ahead += fault_.amount;
    if (fault_.kind == FaultKind::LiftPedal) surgeon_.hand().lift_pedal(true);
    surgeon_.hand().fail(fault_.kind);
    patient_.devices().fail(fault_.kind);
  }
  void end(TimePoint now) {
    if (fault_.kind == FaultKind::KillSurgeon) surgeon_.start(now);
    if (fault_.kind == FaultKind::KillPatient) patient_.start(now);
    if (fault_.kind == FaultKind::LiftPedal) surgeon_.hand().lift_pedal(false);
    surgeon_.hand().fail(FaultKind::None);
    patient_.devices().fail(FaultKind::None);
  }

  Fault fault_;
  SurgeonProcess& surgeon_;
  PatientProcess& patient_;
  std::optional<TimePoint> began_at_;
  bool over_{};
};

void drop_all(SpscQueue<ContactSample>& queue) {
  ContactSample sample;
  while (queue.try_dequeue(sample)) continue;
}

patient::SimulatedPhantomConfig seeded(patient::SimulatedPhantomConfig config, std::uint64_t seed) {
  config.seed = seed ^ kTissueStream;
  return config;
}

/// The path goes dark once, if the scenario says so.
class DarkPath {
 public:
  explicit DarkPath(const Scenario& scenario) : at_script_time_{scenario.blackout_at_script_time} {}

  void step(TimePoint now, Duration script_time) {
    if (at_script_time_ <= Duration{0}) return;
    if (!from_ && script_time >= at_script_time_) from_ = now;
    shut_ = from_ && now - *from_ < kBlackout;
  }
  /// As long as it is.
  [[nodiscard]] const bool& shut() const { return shut_; }

 private:
  Duration at_script_time_;
  std::optional<TimePoint> from_;
  bool shut_{};
};

/// The surgeon's site with its hand and its file.
struct SurgeonEnd {
  SurgeonEnd(const Scenario& scenario,
             std::unique_ptr<link::Transport> path,
             record::SessionWriter* writer,
             Digest& digest)
      : hand{scenario.hand, scenario.script},
        file{writer},
        recorder{digest, &file},
        process{scenario, hand, std::move(path), recorder} {}

  surgeon::SimulatedHand hand;
  DirectRecorder file;
  DigestRecorder recorder;
  SurgeonProcess process;
};

/// The patient's site with its tissue, its estimator and its file.
struct PatientEnd {
  PatientEnd(const Scenario& scenario,
             std::unique_ptr<link::Transport> path,
             record::SessionWriter* writer,
             Digest& digest)
      : tissue{scenario.phantom, seeded(scenario.tissue, scenario.seed)},
        file{writer},
        recorder{digest, &file},
        process{scenario, {tissue, recorder, contact, found, cells}, std::move(path)},
        estimator{depth::with_devices(scenario.estimator, patient_devices_of(scenario)),
                  {contact, found, cells, recorder}} {}

  /// `depths`: somebody wants to know them.
  void listen(bool depths) {
    if (!depths) return drop_all(contact);
    estimator.drain();
    estimator.judge_map();
  }

  patient::SimulatedPhantom tissue;
  DirectRecorder file;
  DigestRecorder recorder;
  SpscQueue<ContactSample> contact{kContactQueue};  // one thread is both writer and reader here
  Mailbox<Findings> found;
  Mailbox<MapCells> cells;
  PatientProcess process;
  patient::EstimatorWorker estimator;
};

/// Theirs, on the line of time that begins with `start`. The estimates are of a site's clock.
std::vector<judge::Stay> strokes_of(const std::vector<DepthEstimate>& estimates,
                                    const LocalClock& clock,
                                    TimePoint start) {
  const auto since_start = [&](TimePoint local) {
    return TimePoint{elapsed(start, clock.world(local))};
  };
  std::vector<judge::Stay> strokes;
  strokes.reserve(estimates.size());
  for (const DepthEstimate& estimate : estimates) {
    strokes.push_back({since_start(estimate.stroke_began_at),
                       since_start(estimate.stroke_ended_at),
                       estimate.place});
  }
  return strokes;
}

netem::PathPlan way_down(const Scenario& scenario) {
  return {.impairment = scenario.down, .changes = scenario.down_changes};
}

}  // namespace

RunResult simulate(const Scenario& scenario, const RunFiles& files) {
  const DenormalFlush flush;
  Simulator simulator;
  const TimePoint start = simulator.now();
  Digest digest;
  SessionFiles session_files{scenario, files, start};
  netem::Pipe pipe{{scenario.up}, way_down(scenario), scenario.seed, kInFlightMax, start};
  DarkPath dark{scenario};
  const auto valve = [&](auto end) { return std::make_unique<Valve>(std::move(end), dark.shut()); };
  SurgeonEnd surgeon{scenario, valve(pipe.surgeon_end()), session_files.surgeon(), digest};
  PatientEnd patient{scenario, valve(pipe.patient_end()), session_files.patient(), digest};
  surgeon.process.start(start);
  patient.process.start(start);

  Probe probe{scenario,
              surgeon.hand,
              patient.tissue,
              files.surgeon != nullptr ? session_files.surgeon() : nullptr};
  FaultInjector fault_injector{scenario.fault, surgeon.process, patient.process};
  std::optional<TimePoint> finished_at;
  const Duration period = scenario.link.period;
  simulator.every({.period = period}, [&](TimePoint now) { surgeon.process.tick(now); });
  simulator.every({.period = period}, [&](TimePoint now) { patient.process.tick(now); });
  simulator.every({.period = period}, [&](TimePoint now) {
    patient.listen(scenario.depths);
    const surgeon::HandTruth hand = surgeon.hand.truth();
    dark.step(now, hand.script_time);
    const Probe::Moment moment{.now = now, .run_time = now - start, .dark = dark.shut()};
    probe.look(surgeon.process, patient.process, moment, digest);
    fault_injector.step(now, hand);
    if (surgeon.hand.finished() && !finished_at) finished_at = now;
  });

  const Duration limit = scenario.duration > Duration{0} ? scenario.duration : kRunMax;
  while (simulator.now() - start < limit &&
         !(finished_at && simulator.now() - *finished_at > kAfterScript)) {
    simulator.run_for(std::min<Duration>(std::chrono::milliseconds{100}, limit));
  }
  session_files.close();

  RunResult result;
  result.digest = digest.value();
  result.began_at = start;
  result.virtual_span = simulator.now() - start;
  result.outcome = surgeon.hand.progress().outcome;
  result.metrics = probe.judge().metrics();
  result.metrics.contact.force_direct = scenario.finger.force;
  result.metrics.contact.drag_direct = scenario.finger.bump;
  result.ticks = probe.take_ticks();
  result.depths = patient.file.estimates();
  result.map = patient.file.map();
  result.strokes =
      strokes_of(result.depths, patient.process.clock(), start + scenario.up.delay.mean);
  result.surgeon_link = surgeon.process.health(simulator.now());
  result.patient_link = patient.process.health(simulator.now());
  result.records = session_files.records();
  return result;
}

}  // namespace palp::lab
