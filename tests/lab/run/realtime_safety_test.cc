// Goal: neither node allocates, frees, locks, waits or throws, from its first tick on, and a guard
// that says so would have noticed.
// Method: both sites whole, with the real codec, link, link update, recorder and session file,
// through every state, under loss, duplicates, forged datagrams, floods, a full record queue and
// sessions that begin and end. RealtimeGuard watches what the real-time thread of a site does in a
// tick; what other threads do (session server, record, estimator, user) is done in its pauses.
// Counters prove that all of it happened. A second test plants misdeeds behind the nodes.
#include <algorithm>
#include <bitset>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/core/denormals.h"
#include "common/io/net/link_update_desk.h"
#include "common/link/codec_wire.h"
#include "common/record/queue_recorder.h"
#include "common/record/session_writer.h"
#include "lab/plan/scenario_file.h"
#include "netem/model/pipe.h"
#include "netem/syntax/impairment_text.h"
#include "patient_site/estimator_worker.h"
#include "surgeon_site/script_builder.h"
#include "tests/lab/run/hostile_end.h"
#include "tests/support/realtime_guard.h"

namespace palp::lab {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::RealtimeGuard;

/// Something that a real-time thread must not do.
using Misdeed = void (*)();

/// Does a misdeed, once, before it passes the hundredth record on; null: passes them on only.
/// Not in the unnamed namespace, so that a violation shows its name.
class PlantedRecorder final : public record::Recorder {
 public:
  PlantedRecorder(record::Recorder& next, Misdeed misdeed) : next_{next}, misdeed_{misdeed} {}
  bool record(const Record& record) noexcept override {
    if (++count_ == 100 && misdeed_ != nullptr) misdeed_();
    return next_.record(record);
  }

 private:
  record::Recorder& next_;
  Misdeed misdeed_;
  std::uint64_t count_{};
};

namespace {

constexpr TimePoint kStart{seconds{1}};
constexpr std::size_t kInFlightMax = 4096;
constexpr std::size_t kContactQueue = 4096;
constexpr std::size_t kRecordQueue = 1024;  ///< full after less than a second

/// The timetable, from the first tick on.
constexpr Duration kDiskStalls = milliseconds{5000};
constexpr Duration kDiskWorks = milliseconds{6500};
constexpr Duration kBridgedGap = milliseconds{7000};
constexpr Duration kLongGap = milliseconds{9000};
constexpr Duration kOtherSession = milliseconds{15000};
constexpr Duration kEmergencyStop = milliseconds{20000};
constexpr Duration kReset = milliseconds{20500};
constexpr Duration kSessionEnds = milliseconds{21500};
constexpr Duration kEnd = milliseconds{22000};

/// What a site went through, as its status said.
struct Journey {
  std::bitset<kSiteStateCount> states;
  std::uint32_t engagements{};  ///< the greatest epoch
  std::uint32_t estimates{};    ///< the greatest number of a depth

  template <class Status>
  void look(const Status& status) {
    states.set(static_cast<std::size_t>(status.state));
    engagements = std::max(engagements, status.epoch);
    estimates = std::max(estimates, status.depth.number);
  }
};

/// What surrounds one site's real-time thread: where its sessions come from, where its records go,
/// who reads its status.
class Desk {
 public:
  Desk(link::Role role, Misdeed misdeed)
      : recorder_{queue_, misdeed}, file_{sink_, {.site = role}} {}

  [[nodiscard]] io::LinkUpdateDesk& link_updates() { return link_updates_; }
  [[nodiscard]] record::Recorder& recorder() { return recorder_; }
  [[nodiscard]] const Journey& journey() const { return journey_; }
  [[nodiscard]] std::uint64_t dropped() { return queue_.dropped(); }
  template <class Type>
  [[nodiscard]] std::uint64_t written() const {
    return file_.counts().by_type[Record{Type{}}.index()];
  }

  template <class Status>
  void live(const Status& status, bool disk_works) {
    link_updates_.destroy_retired();
    journey_.look(status);
    if (!disk_works) return;
    queue_.drain([&](const Record& record) { (void)file_.write(record); });
  }

 private:
  io::LinkUpdateDesk link_updates_;
  record::QueueRecorder queue_{kRecordQueue};
  PlantedRecorder recorder_;
  record::NullSink sink_;
  record::SessionWriter file_;
  Journey journey_;
};

/// Losses and copies all the time, one gap that is bridged and one that is not.
netem::Impairment rough_path(TimePoint start) {
  netem::Impairment path =
      netem::parse_impairment("delay 2ms 1ms distribution normal loss 5% duplicate 5% order free")
          .value();
  // A pipe counts from the beginning of time.
  path.blackouts = {{start.time_since_epoch() + kBridgedGap, milliseconds{200}},
                    {start.time_since_epoch() + kLongGap, milliseconds{600}}};
  return path;
}

/// Free air, then taps until the end.
Scenario rough_scenario(const std::string& coupling, TimePoint start) {
  Scenario scenario = make_scenario("metro", load_scenario("metro").value()).value();
  scenario.coupling.name = coupling;
  scenario.up = rough_path(start);
  scenario.down = rough_path(start);
  scenario.script = surgeon::ScriptBuilder{scenario.hand.plant.grip.stiffness}
                        .air(3e-3, 2.0, milliseconds{500})
                        .move(-3e-3, milliseconds{500})
                        .taps(30, 4e-3, milliseconds{600}, milliseconds{200})
                        .build();
  return scenario;
}

/// What is planted behind the nodes; null: nothing.
struct Misdeeds {
  Misdeed surgeon{};
  Misdeed patient{};
};

/// Both sites on one path. tick() is what their real-time threads do in one period, live() what
/// all other threads do meanwhile, so that the first can be guarded and not the second.
class WarmUp {
 public:
  WarmUp(const std::string& coupling, Misdeeds misdeeds)
      : scenario_{rough_scenario(coupling, kStart)},
        surgeon_desk_{link::Role::Surgeon, misdeeds.surgeon},
        patient_desk_{link::Role::Patient, misdeeds.patient} {
    begin_session<link::PlainProtection>(1);
  }

  /// Whatever guard there is sees the ticks and nothing else.
  void run(Duration span) {
    for (const TimePoint end = now_ + span; now_ < end;) {
      tick();
      const RealtimeGuard::Pause pause;
      live();
    }
  }

  [[nodiscard]] Desk& surgeon_desk() { return surgeon_desk_; }
  [[nodiscard]] Desk& patient_desk() { return patient_desk_; }
  [[nodiscard]] LinkHealth surgeon_link() { return surgeon_.status().get().link; }
  [[nodiscard]] LinkHealth patient_link() { return patient_.status().get().link; }
  [[nodiscard]] double contact_force_max() const { return contact_force_max_; }  ///< [N]

 private:
  void tick() noexcept {
    now_ += scenario_.link.period;
    surgeon_desk_.link_updates().serve(surgeon_link_, now_);
    surgeon_.tick(now_);
    patient_desk_.link_updates().serve(patient_link_, now_);
    patient_.tick(now_);
  }

  void live() {
    const Duration age = now_ - kStart;
    keep_timetable(age);
    estimator_.drain();
    estimates_.drain([](const Record&) {});
    contact_force_max_ = std::max(contact_force_max_, tissue_.truth().contact_force);
    const bool disk_works = age < kDiskStalls || age >= kDiskWorks;
    surgeon_desk_.live(surgeon_.status().get(), disk_works);
    patient_desk_.live(patient_.status().get(), disk_works);
  }

  void keep_timetable(Duration age) {
    if (age == kOtherSession) begin_session<TaggedProtection>(2);
    if (age == kEmergencyStop) surgeon_.commands().put({.emergency_stop = true});
    if (age == kReset) {
      surgeon_.commands().put({.emergency_stop = false, .resets = 1});
      patient_.commands().put({.emergency_stop = false, .resets = 1});
    }
    if (age == kSessionEnds) {
      EXPECT_TRUE(surgeon_desk_.link_updates().offer({}));
      EXPECT_TRUE(patient_desk_.link_updates().offer({}));
    }
  }

  template <class Protection>
  void begin_session(std::uint32_t id) {
    const auto half = [&](std::unique_ptr<link::Transport> end, std::uint32_t to_peer) {
      return link::LinkUpdate{.transport = std::make_unique<HostileEnd>(std::move(end), to_peer),
                              .protection = std::make_unique<Protection>(),
                              .send_connection = to_peer,
                              .receive_connection = to_peer ^ 1U,
                              .session_id = id};
    };
    EXPECT_TRUE(surgeon_desk_.link_updates().offer(half(pipe_.surgeon_end(), 2 * id)));
    EXPECT_TRUE(patient_desk_.link_updates().offer(half(pipe_.patient_end(), 2 * id + 1)));
  }

  TimePoint now_{kStart};
  Scenario scenario_;
  netem::Pipe pipe_{scenario_.up, scenario_.down, scenario_.seed, kInFlightMax};
  Desk surgeon_desk_;
  Desk patient_desk_;

  link::Link surgeon_link_{scenario_.link, std::make_unique<link::WireCodec>()};
  surgeon::SimulatedHand hand_{scenario_.hand, scenario_.script};
  coupling::SurgeonCoupling surgeon_law_{*coupling::make_surgeon_coupling(scenario_.coupling)};
  surgeon::SurgeonNode surgeon_{scenario_.surgeon,
                                {hand_, surgeon_law_, surgeon_link_, surgeon_desk_.recorder()}};

  link::Link patient_link_{scenario_.link, std::make_unique<link::WireCodec>()};
  patient::SimulatedPhantom tissue_{scenario_.phantom, scenario_.tissue};
  coupling::PatientCoupling patient_law_{*coupling::make_patient_coupling(scenario_.coupling)};
  SpscQueue<ContactSample> contact_{kContactQueue};
  Mailbox<Findings> found_;
  Mailbox<MapCells> cells_;
  patient::PatientNode patient_{scenario_.patient,
                                {tissue_,
                                 tissue_,
                                 patient_law_,
                                 patient_link_,
                                 patient_desk_.recorder(),
                                 contact_,
                                 found_,
                                 cells_}};
  record::QueueRecorder estimates_;
  patient::EstimatorWorker estimator_{scenario_.estimator, {contact_, found_, cells_, estimates_}};
  double contact_force_max_{};  ///< [N]
};

/// Every reason to refuse a datagram was met, and the session went on all the same.
void expect_busy(const LinkHealth& health) {
  EXPECT_GT(health.accepted, 12000U);
  EXPECT_GT(health.late, 100U);
  EXPECT_GT(health.repaired, 100U);
  EXPECT_GT(health.lost, 500U);
  EXPECT_GT(health.reordered, 100U);
  EXPECT_GT(health.old_epoch, 0U);
  EXPECT_GT(health.malformed, 1000U);
  EXPECT_GT(health.foreign, 1000U);
  EXPECT_GT(health.replayed, 1000U);
  EXPECT_GT(health.too_old, 100U);
  EXPECT_GT(health.forged, 100U);
  EXPECT_EQ(health.session_id, 0U) << "the last thing that happened";
}

/// The site was in every state, made depths or heard of them, and wrote of it until the queue was
/// full and afterwards.
void expect_travelled(Desk& desk) {
  EXPECT_TRUE(desk.journey().states.all()) << desk.journey().states;
  EXPECT_GE(desk.journey().engagements, 2U);
  EXPECT_GE(desk.journey().estimates, 2U);
  EXPECT_GT(desk.written<SiteTick>(), 20000U);
  EXPECT_GT(desk.written<Arrived>(), 12000U);
  EXPECT_GT(desk.written<LinkStatus>(), 100U);
  EXPECT_GT(desk.written<Transition>(), 10U);
  EXPECT_GE(desk.written<Note>(), 2U) << "of the sessions at least";
  EXPECT_GT(desk.dropped(), 0U) << "the disk stalled";
}

class RealtimeSafetyTest : public testing::TestWithParam<std::string_view> {};
INSTANTIATE_TEST_SUITE_P(Couplings,
                         RealtimeSafetyTest,
                         testing::ValuesIn(coupling::kCouplingNames),
                         [](const auto& law) { return std::string{law.param}; });

TEST_P(RealtimeSafetyTest, BothNodesAreCleanThroughEveryStateOnAHostilePath) {
  const DenormalFlush flush;
  WarmUp warm_up{std::string{GetParam()}, {}};
  RealtimeGuard guard;
  warm_up.run(kEnd);
  guard.release();
  EXPECT_TRUE(guard.clean()) << guard.first_violation();

  EXPECT_GT(warm_up.contact_force_max(), 0.2);
  expect_busy(warm_up.surgeon_link());
  expect_busy(warm_up.patient_link());
  expect_travelled(warm_up.surgeon_desk());
  expect_travelled(warm_up.patient_desk());
  EXPECT_GT(warm_up.surgeon_desk().written<DepthArrived>(), 0U);
}

/// A misdeed and what the guard calls it.
struct Plant {
  Misdeed misdeed{};
  std::string name;
};

std::vector<Plant> plants() {
  return {{[] { delete new volatile int{1}; }, "malloc"},
          {[] {
             static std::mutex mutex;
             const std::scoped_lock lock{mutex};
           },
           "pthread_mutex_lock"},
          {[] {
             try {
               throw std::runtime_error{"planted"};
             } catch (const std::runtime_error&) {
             }
           },
           "throw"}};
}

TEST(RealtimeSafetyPlantTest, AMisdeedPlantedBehindEitherNodeIsCaughtAndNamed) {
  const DenormalFlush flush;
  for (const Plant& plant : plants()) {
    for (const bool at_surgeon : {true, false}) {
      WarmUp warm_up{"direct",
                     at_surgeon ? Misdeeds{plant.misdeed, {}} : Misdeeds{{}, plant.misdeed}};
      RealtimeGuard guard;
      warm_up.run(milliseconds{200});
      guard.release();
      if (!RealtimeGuard::kArmed) continue;
      const std::string found = guard.first_violation();
      EXPECT_TRUE(found.starts_with(plant.name + ",")) << found;
      EXPECT_NE(found.find("PlantedRecorder::record"), std::string::npos) << found;
      const std::string node = at_surgeon ? "SurgeonNode::tick" : "PatientNode::tick";
      EXPECT_NE(found.find(node), std::string::npos) << found;
    }
  }
}

}  // namespace
}  // namespace palp::lab
