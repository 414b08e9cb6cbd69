#include "lab/run/replay.h"

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/core/number_text.h"
#include "common/core/spsc_queue.h"
#include "common/record/session_encoder.h"
#include "common/record/session_reader.h"

namespace palp::lab {
namespace {

class ListRecorder final : public record::Recorder {
 public:
  bool record(const Record& record) noexcept override {
    records.push_back(record);
    return true;
  }
  std::vector<Record> records;
};

bool of_estimator(const Record& record) {
  return std::holds_alternative<ContactSample>(record) ||
         std::holds_alternative<DepthEstimate>(record);
}

/// The site's records of one tick, with what it was given sorted out.
struct LoggedTick {
  std::vector<Record> records;
  std::vector<Incoming> samples;
  std::optional<HandReading> hand;
  std::optional<StageReading> stage;
  std::optional<ForceReading> force;
  std::optional<LinkHeard> heard;
  std::optional<LinkHealth> status;
  std::optional<UserCommand> user;
  std::optional<DeviceFacts> own_devices;
  std::optional<DeviceFacts> peer_devices;
  std::optional<DepthReport> depth;

  void add(const Record& record) {
    records.push_back(record);
    std::visit([this](const auto& one) { sort(one); }, record);
  }
  [[nodiscard]] LinkHealth link() const {
    LinkHealth health = status.value_or(LinkHealth{});
    health.state = heard->state;
    health.session_id = heard->session_id;
    health.gap = heard->gap;
    health.round_trip = heard->round_trip;
    health.key = heard->key;
    return health;
  }
  [[nodiscard]] link::Arrivals arrived() const {
    link::Arrivals arrived;
    arrived.samples = samples;
    arrived.peer_heard = heard->peer_heard;
    arrived.peer.state = heard->peer_state;
    arrived.peer.epoch = heard->peer_epoch;
    arrived.peer.place = heard->peer_place;
    return arrived;
  }

 private:
  template <class T>
  void sort(const T& /*output*/) {}
  void sort(const Arrived& one) { samples.push_back(one.incoming); }
  void sort(const HandReading& one) { hand = one; }
  void sort(const StageReading& one) { stage = one; }
  void sort(const ForceReading& one) { force = one; }
  void sort(const LinkHeard& one) { heard = one; }
  void sort(const LinkStatus& one) { status = one.health; }
  void sort(const UserAsked& one) { user = one.command; }
  void sort(const DepthArrived& one) { depth = one.report; }
  void sort(const DevicesTold& one) { (one.of_peer ? peer_devices : own_devices) = one.facts; }
};

/// A session file, tick by tick.
class LoggedTicks {
 public:
  explicit LoggedTicks(std::span<const std::byte> file) : reader_{file} {}
  std::optional<LoggedTick> next() {
    LoggedTick tick;
    while (const auto entry = reader_.next()) {
      if (of_estimator(entry->record)) continue;
      tick.add(entry->record);
      if (tick.heard) return tick;
    }
    return std::nullopt;
  }

 private:
  record::SessionReader reader_;
};

/// Compares records by the bytes that a session file would hold of them.
class Comparison {
 public:
  explicit Comparison(link::Role site) : encoder_{site} {}

  /// @returns the sentence of a difference; empty: there is none.
  std::string compare(const std::vector<Record>& logged, const std::vector<Record>& again) {
    for (std::size_t i = 0; i < std::min(logged.size(), again.size()); ++i) {
      if (bytes_of(logged[i]) == bytes_of(again[i])) continue;
      return std::string{"record '"} + kRecordNames[logged[i].index()] + "' " +
             number_text("at ", seconds(at_.time_since_epoch()), 6, " s") + " became '" +
             kRecordNames[again[i].index()] + "'";
    }
    if (logged.size() == again.size()) return {};
    return "tick " + number_text("at ", seconds(at_.time_since_epoch()), 6, " s") + " has " +
           std::to_string(logged.size()) + " records, and " + std::to_string(again.size()) +
           " when done again";
  }

 private:
  std::vector<std::byte> bytes_of(const Record& record) {
    const auto prepared = encoder_.prepare(record, 0);
    if (!prepared) return {};
    at_ = prepared->at;
    const std::int64_t at = prepared->at.time_since_epoch().count();
    std::vector<std::byte> bytes(prepared->size);
    encoder_.store(bytes.data());
    bytes.push_back(static_cast<std::byte>(prepared->topic));
    for (unsigned shift = 0; shift < 64; shift += 8) {
      bytes.push_back(static_cast<std::byte>(static_cast<std::uint64_t>(at) >> shift & 0xFFU));
    }
    return bytes;
  }

  record::SessionEncoder encoder_;
  TimePoint at_{};
};

tl::unexpected<Error> lacks(const char* what, const LoggedTick& tick) {
  return fail(
      number_text("the tick at ", seconds(tick.heard->at.time_since_epoch()), 6, " s has ") + what +
      " in the file");
}

std::map<std::uint32_t, DepthEstimate> estimates_of(std::span<const std::byte> file) {
  std::map<std::uint32_t, DepthEstimate> found;
  record::SessionReader reader{file};
  while (const auto entry = reader.next()) {
    if (const auto* estimate = std::get_if<DepthEstimate>(&entry->record)) {
      found.emplace(estimate->number, *estimate);
    }
  }
  return found;
}

/// A surgeon's site between two ticks.
class SurgeonAgain {
 public:
  SurgeonAgain(const surgeon::SurgeonConfig& config,
               const coupling::CouplingConfig& coupling,
               const HandFacts& hand)
      : law_{coupling::make_surgeon_coupling(coupling).value()},
        control_{config, hand, {law_, recorder_}} {}

  const std::vector<Record>& step(const LoggedTick& tick) {
    const HandReading& hand = *tick.hand;
    surgeon::SurgeonInputs in;
    in.now = tick.heard->at;
    in.hand = {.sampled_at = hand.at - hand.age,
               .position = hand.position,
               .velocity = hand.velocity,
               .place = hand.place,
               .pedal_held = hand.pedal_held,
               .emergency_stop = hand.emergency_stop,
               .faulted = hand.faulted};
    in.script.begun = hand.script_phase != 0;
    in.script.phase = hand.script_phase;
    in.user = user_ = tick.user.value_or(user_);
    in.link = tick.link();
    in.peer_devices = tick.peer_devices.value_or(DeviceFacts{});
    in.arrived = tick.arrived();
    if (tick.depth) depth_ = *tick.depth;
    if (tick.heard->depth_number != 0) in.arrived.peer.depth = depth_;
    recorder_.records.clear();
    (void)control_.step(in);
    return recorder_.records;
  }

 private:
  ListRecorder recorder_;
  coupling::SurgeonCoupling law_;
  surgeon::SurgeonControl control_;
  UserCommand user_;
  DepthReport depth_;
};

/// A patient's site between two ticks, and its estimator.
class PatientAgain {
 public:
  PatientAgain(const patient::PatientConfig& config,
               const coupling::CouplingConfig& coupling,
               const PatientDevices& devices,
               std::map<std::uint32_t, DepthEstimate> estimates)
      : estimates_{std::move(estimates)},
        law_{coupling::make_patient_coupling(coupling, devices).value()},
        control_{config, devices, {law_, recorder_, contact_}} {}

  const std::vector<Record>& step(const LoggedTick& tick) {
    const StageReading& stage = *tick.stage;
    patient::PatientInputs in;
    in.now = tick.heard->at;
    in.stage = {.sampled_at = stage.at - stage.age,
                .position = stage.position,
                .velocity = stage.velocity,
                .place = stage.place,
                .at_limit = stage.at_limit,
                .faulted = stage.faulted};
    if (tick.force->fresh) {
      in.force = {.sampled_at = tick.force->at - tick.force->age,
                  .force = tick.force->force,
                  .saturated = tick.force->saturated};
    }
    in.user = user_ = tick.user.value_or(user_);
    in.link = tick.link();
    in.peer_devices = tick.peer_devices.value_or(DeviceFacts{});
    in.arrived = tick.arrived();
    if (const auto found = estimates_.find(tick.heard->depth_number); found != estimates_.end()) {
      in.depth = found->second;
    }
    recorder_.records.clear();
    (void)control_.step(in);
    return recorder_.records;
  }
  /// The newest estimate that the samples of the last tick led to.
  std::optional<DepthEstimate> estimate(depth::DepthEstimator& estimator) {
    std::optional<DepthEstimate> newest;
    for (ContactSample sample; contact_.try_dequeue(sample);) {
      if (auto one = estimator.add(sample)) newest = one;
    }
    return newest;
  }

 private:
  static constexpr std::size_t kContactQueue = 64;

  std::map<std::uint32_t, DepthEstimate> estimates_;
  ListRecorder recorder_;
  SpscQueue<ContactSample> contact_{kContactQueue};  // one thread is both writer and reader here
  coupling::PatientCoupling law_;
  patient::PatientControl control_;
  UserCommand user_;
};

}  // namespace

Result<ReplayReport> replay_surgeon(std::span<const std::byte> file,
                                    const surgeon::SurgeonConfig& config,
                                    const coupling::CouplingConfig& coupling) {
  ReplayReport report;
  LoggedTicks ticks{file};
  Comparison comparison{link::Role::Surgeon};
  std::optional<SurgeonAgain> site;
  while (const auto tick = ticks.next()) {
    if (!tick->hand) return lacks("no reading of the hand", *tick);
    if (!site) {
      if (!tick->own_devices || !tick->own_devices->hand) return lacks("no device", *tick);
      site.emplace(config, coupling, *tick->own_devices->hand);
    }
    const std::vector<Record>& again = site->step(*tick);
    ++report.ticks;
    report.records += again.size();
    report.difference = comparison.compare(tick->records, again);
    if (!report.difference.empty()) break;
  }
  return report;
}

Result<ReplayReport> replay_patient(std::span<const std::byte> file,
                                    const patient::PatientConfig& config,
                                    const coupling::CouplingConfig& coupling,
                                    const std::optional<depth::DepthEstimatorConfig>& estimator) {
  ReplayReport report;
  LoggedTicks ticks{file};
  Comparison comparison{link::Role::Patient};
  const std::map<std::uint32_t, DepthEstimate> estimates = estimates_of(file);
  std::optional<PatientAgain> site;
  std::unique_ptr<depth::DepthEstimator> depths;
  while (const auto tick = ticks.next()) {
    if (!tick->stage || !tick->force) return lacks("no reading of stage or sensor", *tick);
    if (!site) {
      const DeviceFacts own = tick->own_devices.value_or(DeviceFacts{});
      if (!own.stage || !own.sensor) return lacks("no devices", *tick);
      site.emplace(config, coupling, PatientDevices{*own.stage, *own.sensor}, estimates);
      if (estimator) {
        depths =
            std::make_unique<depth::DepthEstimator>(depth::with_sensor(*estimator, *own.sensor));
      }
    }
    const std::vector<Record>& again = site->step(*tick);
    ++report.ticks;
    report.records += again.size();
    report.difference = comparison.compare(tick->records, again);
    if (!report.difference.empty()) break;
    if (!depths) continue;
    if (const auto estimate = site->estimate(*depths)) {
      ++report.estimates;
      const auto logged = estimates.find(estimate->number);
      if (logged == estimates.end()) return fail("an estimate that the file does not hold");
      report.difference = comparison.compare({logged->second}, {*estimate});
      if (!report.difference.empty()) break;
    }
  }
  return report;
}

}  // namespace palp::lab
