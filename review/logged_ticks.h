#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/link/telegram.h"
#include "common/record/recorder.h"
#include "common/record/session_reader.h"

namespace palp::review {

/// The session files of one run of a site's program, in order; the first begins with the run.
using RunBytes = std::vector<record::FileBytes>;

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
  std::optional<MapReport> map;
  std::optional<MapCell> map_cell;

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
  void sort(const MapArrived& one) { map = one.report; }
  void sort(const MapCell& one) { map_cell = one; }
  void sort(const DevicesTold& one) { (one.of_peer ? peer_devices : own_devices) = one.facts; }
};

/// The files of a run, tick by tick. They outlive it.
class LoggedTicks {
 public:
  explicit LoggedTicks(const RunBytes& files) : files_{files} {}
  /// Without what the estimator's thread and the lab said; nullopt: the end.
  std::optional<LoggedTick> next();
  /// Chunks that could not be read and messages that are missing, twice there or out of order, so
  /// far.
  [[nodiscard]] std::uint64_t damaged() const;
  /// Records that never came into the file, as its statuses tell up to the next one, which is read
  /// for it: next() must not follow. 0: none.
  std::uint64_t dropped_up_to_the_next_status();
  /// Of the first file that lacks something, as lack_of() has it; complete at the end.
  [[nodiscard]] const std::string& lack() const noexcept { return lack_; }
  /// Of the first tick; next() has given one.
  [[nodiscard]] TimePoint began_at() const { return began_at_.value_or(TimePoint{}); }

 private:
  std::optional<record::SessionEntry> next_entry();

  const RunBytes& files_;
  std::size_t present_{};
  std::uint64_t damaged_{};  ///< in files read to their end
  std::uint64_t dropped_{};  ///< as the newest status tells
  std::string lack_;
  std::optional<record::SessionReader> reader_;
  std::optional<TimePoint> began_at_;
};

}  // namespace palp::review
