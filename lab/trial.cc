#include "lab/trial.h"

#include <algorithm>
#include <memory>
#include <optional>

#include "common/core/denormals.h"
#include "common/core/mailbox.h"
#include "common/core/spsc_queue.h"
#include "common/link/codec_protobuf.h"
#include "common/link/packet_protection.h"
#include "common/record/session_writer.h"
#include "lab/adversary.h"
#include "lab/phase_finder.h"
#include "lab/state_digest.h"
#include "lab/valve.h"
#include "lab/world.h"
#include "netem/pipe.h"
#include "patient_site/estimator_worker.h"

namespace palp::lab {
namespace {

/// Longer than any script plus its re-engagements; a run that hangs must end.
constexpr Duration kRunMax = std::chrono::hours{5};
/// What happens after the script: the pedal goes up and the force fades.
constexpr Duration kAfterScript = std::chrono::milliseconds{500};
constexpr double kAfterBlackout = 2;  // [s], still judged with it
constexpr std::size_t kInFlightMax = 4096;
constexpr std::size_t kContactQueue = 4096;
constexpr std::uint64_t kTissueStream = 0x7469737375650000;  ///< keeps the sensor's noise apart

/// Both session files of a run, or none.
class Files final {
 public:
  Files(const Scenario& scenario, const TrialFiles& files, TimePoint now) {
    if (scenario.bare) return;
    const record::McapMap metadata{{"program", "palp-lab"},
                                   {"scenario", scenario.name},
                                   {"seed", std::to_string(scenario.seed)},
                                   {"time", "virtual"}};
    surgeon_.emplace(files.surgeon != nullptr ? *files.surgeon : null_surgeon_,
                     record::SessionInfo{link::Role::Surgeon, metadata, {}, now});
    patient_.emplace(files.patient != nullptr ? *files.patient : null_patient_,
                     record::SessionInfo{link::Role::Patient, metadata, {}, now});
  }
  [[nodiscard]] record::SessionWriter* surgeon() { return surgeon_ ? &*surgeon_ : nullptr; }
  [[nodiscard]] record::SessionWriter* patient() { return patient_ ? &*patient_ : nullptr; }
  [[nodiscard]] std::uint64_t records() const {
    return (surgeon_ ? surgeon_->counts().records() : 0) +
           (patient_ ? patient_->counts().records() : 0);
  }
  void close() {
    if (surgeon_) surgeon_->close();
    if (patient_) patient_->close();
  }

 private:
  record::NullSink null_surgeon_;
  record::NullSink null_patient_;
  std::optional<record::SessionWriter> surgeon_;
  std::optional<record::SessionWriter> patient_;
};

/// Writes at once: in virtual time nobody waits for a disk.
class DirectRecorder final : public record::Recorder {
 public:
  DirectRecorder(const World& world, record::SessionWriter* writer)
      : world_{world}, writer_{writer} {}
  bool record(const record::Record& record) noexcept override {
    if (const auto* estimate = std::get_if<DepthEstimate>(&record)) estimates_.push_back(*estimate);
    return writer_ == nullptr || writer_->write(record, world_.now());
  }
  [[nodiscard]] const std::vector<DepthEstimate>& estimates() const { return estimates_; }

 private:
  const World& world_;
  record::SessionWriter* writer_;
  std::vector<DepthEstimate> estimates_;
};

constexpr Duration kBlackout = std::chrono::seconds{2};

std::unique_ptr<link::Codec> make_codec(bool bare) {
  if (bare) return std::make_unique<link::RawCodec>();
  return std::make_unique<link::ProtobufCodec>();
}

std::unique_ptr<link::Codec> patient_codec(const Scenario& scenario) {
  auto codec = make_codec(scenario.bare);
  if (!scenario.lying) return codec;
  return std::make_unique<LyingCodec>(std::move(codec), scenario.seed, scenario.link.period);
}

/// A session as the handshake would have left it.
link::Handover handover(std::unique_ptr<link::Transport> transport) {
  return {.transport = std::move(transport),
          .protection = std::make_unique<link::PlainProtection>(),
          .send_connection = 1,
          .receive_connection = 1,
          .session_id = 1};
}

/// Follows the plant's true states.
class Witness {
 public:
  Witness(const Scenario& scenario,
          const surgeon::SimulatedHand& hand,
          const patient::SimulatedPhantom& tissue)
      : scenario_{scenario},
        hand_{hand},
        tissue_{tissue},
        phases_{scenario.script},
        relaxing_{scenario.phantom.relaxation} {}

  /// `at`: since the start of the run [s].
  void look(const surgeon::SurgeonStatus& status, double at, Digest& digest) {
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
    const double net = hand.work - tissue.tissue_energy;
    work_min_ = std::min(work_min_, hand.work);
    net_min_ = std::min(net_min_, net);
    // What the hand itself would have felt, had it pressed the tissue.
    const double depth = hand.position - status.offset - tissue.surface;
    const double force_true = relaxing_.step(scenario_.phantom.at(status.lateral).force(depth),
                                             seconds(scenario_.link.period));
    if (!hand.performing) return;

    TrialTick tick;
    tick.at = at;
    tick.phase = phases_.at(hand.script_time);
    tick.counted = status.state == SiteState::Engaged || status.state == SiteState::Hold;
    tick.hand = depth;
    tick.surface = tissue.surface - scenario_.tissue.surface_offset;
    tick.hand_velocity = hand.velocity;
    tick.hand_force = hand.force;
    tick.force_true = force_true;
    tick.contact_force = tissue.contact_force;
    tick.tip = tissue.position - tissue.surface;
    tick.tip_velocity = tissue.velocity;
    tick.energy_operator = hand.work;
    tick.energy_operator_min = work_min_;
    tick.energy_net_min = net_min_;
    ticks_.push_back(tick);
  }
  [[nodiscard]] const std::vector<TrialTick>& ticks() const { return ticks_; }
  [[nodiscard]] std::vector<TrialTick> take_ticks() { return std::move(ticks_); }

 private:
  const Scenario& scenario_;
  const surgeon::SimulatedHand& hand_;
  const patient::SimulatedPhantom& tissue_;
  PhaseFinder phases_;
  patient::RelaxingForce relaxing_;
  double work_min_{};  ///< [J]
  double net_min_{};   ///< [J]
  std::vector<TrialTick> ticks_;
};

void drop_all(SpscQueue<ContactSample>& queue) {
  ContactSample sample;
  while (queue.try_dequeue(sample)) continue;
}

patient::SimulatedPhantomConfig seeded(patient::SimulatedPhantomConfig config, std::uint64_t seed) {
  config.seed = seed ^ kTissueStream;
  return config;
}

}  // namespace

TrialResult run_trial(const Scenario& scenario, const TrialFiles& files) {
  const DenormalFlush flush;
  World world;
  const TimePoint start = world.now();
  Digest digest;
  Files session_files{scenario, files, start};

  // The path.
  netem::Pipe pipe{scenario.up, scenario.down, scenario.seed, kInFlightMax, start};
  link::Link surgeon_link{scenario.link, make_codec(scenario.bare)};
  link::Link patient_link{scenario.link, patient_codec(scenario)};
  bool shut = false;
  (void)surgeon_link.adopt(handover(std::make_unique<Valve>(pipe.surgeon_end(), shut)), start);
  (void)patient_link.adopt(handover(std::make_unique<Valve>(pipe.patient_end(), shut)), start);

  // The surgeon's site.
  surgeon::SimulatedHand hand{scenario.hand, scenario.script};
  auto surgeon_law = coupling::make_surgeon_coupling(scenario.coupling).value();
  DirectRecorder surgeon_file{world, session_files.surgeon()};
  DigestRecorder surgeon_recorder{digest, &surgeon_file};
  surgeon::SurgeonNode surgeon{scenario.surgeon,
                               {hand, surgeon_law, surgeon_link, surgeon_recorder}};

  // The patient's site.
  patient::SimulatedPhantom tissue{scenario.phantom, seeded(scenario.tissue, scenario.seed)};
  auto patient_law = coupling::make_patient_coupling(scenario.coupling).value();
  DirectRecorder patient_file{world, session_files.patient()};
  DigestRecorder patient_recorder{digest, &patient_file};
  SpscQueue<ContactSample> contact{kContactQueue};  // one thread is both writer and reader here
  Mailbox<DepthEstimate> depth;
  patient::PatientNode patient{
      scenario.patient,
      {tissue, tissue, patient_law, patient_link, patient_recorder, contact, depth}};
  patient::EstimatorWorker estimator{scenario.estimator, {contact, depth, patient_recorder}};

  Witness witness{scenario, hand, tissue};
  std::optional<TimePoint> finished_at;
  std::optional<TimePoint> dark_from;
  const Duration period = scenario.link.period;
  world.every({.period = period}, [&](TimePoint now) { surgeon.tick(now); });
  world.every({.period = period}, [&](TimePoint now) { patient.tick(now); });
  world.every({.period = period}, [&](TimePoint now) {
    if (scenario.depths) {
      estimator.drain();
    } else {
      drop_all(contact);
    }
    if (scenario.blackout_at_script_time > Duration{0}) {
      if (!dark_from && hand.truth().script_time >= scenario.blackout_at_script_time) {
        dark_from = now;
      }
      shut = dark_from && now - *dark_from < kBlackout;
    }
    witness.look(surgeon.status().get(), seconds(now - start), digest);
    if (hand.finished() && !finished_at) finished_at = now;
  });

  const Duration limit = scenario.duration > Duration{0} ? scenario.duration : kRunMax;
  while (world.now() - start < limit &&
         !(finished_at && world.now() - *finished_at > kAfterScript)) {
    world.run_for(std::min<Duration>(std::chrono::milliseconds{100}, limit));
  }
  session_files.close();

  TrialResult result;
  result.digest = digest.value();
  result.virtual_span = world.now() - start;
  result.outcome = hand.progress().outcome;
  MetricsConfig judging{.force_cap = scenario.hand.force_max, .period = seconds(period)};
  if (dark_from) {
    judging.blackout_from = seconds(*dark_from - start);
    judging.blackout_to = judging.blackout_from + seconds(kBlackout) + kAfterBlackout;
  }
  result.metrics = judge(witness.ticks(), judging);
  result.ticks = witness.take_ticks();
  result.depths = patient_file.estimates();
  result.surgeon_link = surgeon_link.health(world.now());
  result.patient_link = patient_link.health(world.now());
  result.records = session_files.records();
  return result;
}

}  // namespace palp::lab
