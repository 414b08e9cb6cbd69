#include "review/replay.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "common/core/denormals.h"
#include "common/core/number_text.h"
#include "common/core/spsc_queue.h"
#include "common/record/session_reader.h"
#include "review/logged_ticks.h"
#include "review/record_comparison.h"
#include "review/site_data.h"

namespace palp::review {
namespace {

class ListRecorder final : public record::Recorder {
 public:
  bool record(const Record& record) noexcept override {
    records.push_back(record);
    return true;
  }
  std::vector<Record> records;
};

tl::unexpected<Error> lacks(const char* what, const LoggedTick& tick) {
  return fail(
      number_text("the tick at ", seconds(tick.heard->at.time_since_epoch()), 6, " s has ") + what +
      " in the file");
}

tl::unexpected<Error> torn(const LoggedTick& tick) {
  return fail(number_text("the file is damaged before its tick at ",
                          seconds(tick.heard->at.time_since_epoch()),
                          6,
                          " s, and a site is done again only from all of its ticks"));
}

tl::unexpected<Error> lost(std::uint64_t records, const LoggedTick& tick) {
  return fail(std::to_string(records) +
              number_text(" records were lost as the file was written, and its tick at ",
                          seconds(tick.heard->at.time_since_epoch()),
                          6,
                          " s lies behind them: a site is done again only from all of its ticks"));
}

tl::unexpected<Error> nothing() {
  return fail("the file holds no tick with all that it was given");
}

using Estimates = std::map<std::uint32_t, DepthEstimate>;

/// What the estimator's thread said, by the number of the stroke.
struct LoggedFindings {
  Estimates estimates;
  std::map<std::uint32_t, MapEstimate> maps;
};

LoggedFindings findings_of(const RunBytes& files) {
  LoggedFindings found;
  for (const record::FileBytes& file : files) {
    record::SessionReader reader{file};
    while (const auto entry = reader.next()) {
      if (const auto* estimate = std::get_if<DepthEstimate>(&entry->record)) {
        if (found.estimates.size() < kListMax) found.estimates.emplace(estimate->number, *estimate);
      } else if (const auto* map = std::get_if<MapEstimate>(&entry->record)) {
        if (found.maps.size() < kListMax) found.maps.emplace(map->report.number, *map);
      }
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
      : law_{coupling::make_surgeon_coupling(coupling, hand).value()},
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
    if (tick.map) in.arrived.peer.map = *tick.map;
    if (tick.map_cell) in.arrived.peer.map_cell = *tick.map_cell;
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
               Estimates estimates)
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
      in.found.depth = found->second;
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

  Estimates estimates_;
  ListRecorder recorder_;
  SpscQueue<ContactSample> contact_{kContactQueue};  // one thread is both writer and reader here
  coupling::PatientCoupling law_;
  patient::PatientControl control_;
  UserCommand user_;
};

/// What a patient's site does again, tick by tick.
class PatientRun {
 public:
  PatientRun(const RunBytes& files, const PatientParts& parts)
      : parts_{parts}, ticks_{files}, findings_{findings_of(files)} {}

  /// The next tick, done again; nothing at the end, a sentence where the file lacks what it needs.
  Result<std::optional<LoggedTick>> next() {
    auto tick = ticks_.next();
    if (!tick) return std::optional<LoggedTick>{};
    if (ticks_.damaged() > 0) return torn(*tick);
    if (!tick->stage || !tick->force) return lacks("no reading of stage or sensor", *tick);
    if (!site_ || tick->own_devices) {
      const DeviceFacts own = tick->own_devices.value_or(DeviceFacts{});
      if (!own.stage || !own.sensor) return lacks("no devices", *tick);
      site_.emplace(parts_.config,
                    parts_.coupling,
                    PatientDevices{*own.stage, *own.sensor},
                    findings_.estimates);
      if (parts_.estimator) {
        depths_ = std::make_unique<depth::DepthEstimator>(
            depth::with_devices(*parts_.estimator, {*own.stage, *own.sensor}));
      }
    }
    again_ = &site_->step(*tick);
    estimate_ = depths_ ? site_->estimate(*depths_) : std::nullopt;
    map_.reset();
    // Only where the site had the time for one.
    if (estimate_ && findings_.maps.contains(estimate_->number)) {
      if (const auto made = depths_->map()) map_ = MapEstimate{estimate_->stroke_ended_at, *made};
    }
    return tick;
  }
  /// Of the tick that next() gave.
  [[nodiscard]] const std::vector<Record>& again() const { return *again_; }
  [[nodiscard]] const std::optional<DepthEstimate>& estimate() const { return estimate_; }
  /// Where the file has one of this stroke.
  [[nodiscard]] const std::optional<MapEstimate>& map() const { return map_; }
  [[nodiscard]] const LoggedFindings& logged() const { return findings_; }
  [[nodiscard]] TimePoint began_at() const { return ticks_.began_at(); }
  [[nodiscard]] const std::string& lack() const { return ticks_.lack(); }
  /// As LoggedTicks::dropped_up_to_the_next_status().
  std::uint64_t dropped() { return ticks_.dropped_up_to_the_next_status(); }

 private:
  const PatientParts& parts_;
  LoggedTicks ticks_;
  LoggedFindings findings_;
  std::optional<PatientAgain> site_;
  std::unique_ptr<depth::DepthEstimator> depths_;
  const std::vector<Record>* again_{};
  std::optional<DepthEstimate> estimate_;
  std::optional<MapEstimate> map_;
};

const SiteTick* tick_of(const std::vector<Record>& records) {
  for (const Record& record : records) {
    if (const auto* tick = std::get_if<SiteTick>(&record)) return tick;
  }
  return nullptr;
}

}  // namespace

Result<ReplayReport> replay_surgeon(const RunBytes& files,
                                    const surgeon::SurgeonConfig& config,
                                    const coupling::CouplingConfig& coupling) {
  const DenormalFlush flush;  // as the loop that is done again
  ReplayReport report;
  LoggedTicks ticks{files};
  RecordComparison comparison{link::Role::Surgeon};
  std::optional<SurgeonAgain> site;
  while (const auto tick = ticks.next()) {
    if (ticks.damaged() > 0) return torn(*tick);
    if (!tick->hand) return lacks("no reading of the hand", *tick);
    if (!site || tick->own_devices) {
      if (!tick->own_devices || !tick->own_devices->hand) return lacks("no device", *tick);
      site.emplace(config, coupling, *tick->own_devices->hand);
    }
    const std::vector<Record>& again = site->step(*tick);
    ++report.ticks;
    report.records += again.size();
    report.difference = comparison.compare(tick->records, again, ticks.began_at());
    if (report.difference.empty()) continue;
    if (const auto records = ticks.dropped_up_to_the_next_status()) return lost(records, *tick);
    break;
  }
  if (report.ticks == 0) return nothing();
  report.lack = ticks.lack();
  return report;
}

Result<ReplayReport> replay_patient(const RunBytes& files, const PatientParts& parts) {
  const DenormalFlush flush;  // as the loop that is done again
  ReplayReport report;
  RecordComparison comparison{link::Role::Patient};
  PatientRun run{files, parts};
  std::size_t missing = 0;  // estimates
  while (true) {
    const auto tick = run.next();
    if (!tick) return tl::unexpected(tick.error());
    if (!*tick) break;
    ++report.ticks;
    report.records += run.again().size();
    report.difference = comparison.compare((*tick)->records, run.again(), run.began_at());
    if (!report.difference.empty()) {
      if (const auto records = run.dropped()) return lost(records, **tick);
      break;
    }
    if (!run.estimate()) continue;
    const Estimates& estimates = run.logged().estimates;
    const auto logged = estimates.find(run.estimate()->number);
    if (logged == estimates.end()) {
      ++missing;
      continue;
    }
    ++report.estimates;
    report.difference = comparison.compare({logged->second}, {*run.estimate()}, run.began_at());
    if (!report.difference.empty()) break;
    if (!run.map()) continue;
    ++report.maps;
    const MapEstimate& told = run.logged().maps.at(run.estimate()->number);
    report.difference = comparison.compare({told}, {*run.map()}, run.began_at());
    if (!report.difference.empty()) break;
  }
  if (report.ticks == 0) return nothing();
  report.lack = run.lack();
  // A program that is killed has no time for its last one.
  const bool whole = report.difference.empty() && report.lack.empty();
  if (whole && missing > 0) return fail("an estimate that the file does not hold");
  return report;
}

Result<WhatIf> what_if_patient(const RunBytes& files, const PatientParts& parts) {
  const DenormalFlush flush;  // as the loop that is done again
  WhatIf report;
  PatientRun run{files, parts};
  double square = 0;
  std::uint64_t both = 0;
  std::map<std::uint32_t, OtherEstimate> estimates;
  for (const auto& [number, estimate] : run.logged().estimates) estimates[number].logged = estimate;
  while (true) {
    const auto tick = run.next();
    if (!tick) return tl::unexpected(tick.error());
    if (!*tick) break;
    ++report.ticks;
    if (run.estimate()) estimates[run.estimate()->number].other = run.estimate();
    if (run.map()) report.map_other = run.map()->report;
    const SiteTick* there = tick_of((*tick)->records);
    const SiteTick* here = tick_of(run.again());
    if (there == nullptr || here == nullptr) continue;
    const bool engaged = there->state == SiteState::Engaged;
    if (engaged) ++report.engaged;
    if (there->state != here->state) ++report.other_state;
    if (there->gate_acted) ++report.gate_acted;
    if (here->gate_acted) ++report.gate_would;
    const double apart = here->command - there->command;
    if (!engaged || here->state != SiteState::Engaged || !std::isfinite(apart)) continue;
    square += apart * apart;
    report.target_max = std::max(report.target_max, std::abs(apart));
    ++both;
  }
  if (report.ticks == 0) return nothing();
  if (both > 0) report.target_rms = std::sqrt(square / static_cast<double>(both));
  report.estimates.reserve(estimates.size());
  for (const auto& [number, one] : estimates) report.estimates.push_back(one);
  if (const auto& maps = run.logged().maps; !maps.empty()) {
    report.map_logged = maps.rbegin()->second.report;
  }
  report.lack = run.lack();
  return report;
}

}  // namespace palp::review
