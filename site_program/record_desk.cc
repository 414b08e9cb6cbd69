#include "site_program/record_desk.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "common/io/realtime/steady_clock.h"
#include "common/io/realtime/wall_clock.h"
#include "common/record/notes.h"

namespace palp::site_program {
namespace {

/// More than any tick has; what is more is written all the same.
constexpr std::size_t kTickRecords = 256;

/// What is shown at once, in clients' messages a second: 50, however often the thread comes round.
constexpr Duration kFeedEvery = std::chrono::milliseconds{18};

std::string zone_text(Duration zone) {
  const auto minutes = std::chrono::duration_cast<std::chrono::minutes>(zone).count();
  std::array<char, 48> text{};
  (void)std::snprintf(text.data(),
                      text.size(),
                      "%c%02lld:%02lld",
                      minutes < 0 ? '-' : '+',
                      static_cast<long long>(std::abs(minutes) / 60),
                      static_cast<long long>(std::abs(minutes) % 60));
  return text.data();
}

record::WallClock wall_clock() {
  const io::WallClockReading reading = io::read_wall_clock();
  record::WallClock clock;
  clock.ahead = reading.ahead;
  clock.source = "realtime";
  clock.zone = zone_text(reading.zone);
  clock.synchronised = reading.synchronised ? "yes" : "no";
  if (reading.uncertainty) {
    clock.uncertainty_us = std::to_string(*reading.uncertainty / std::chrono::microseconds{1});
  }
  return clock;
}

/// What the status line or another sentence says as well.
bool shown_elsewhere(record::NoteCode code) {
  switch (code) {
    case record::NoteCode::ScriptPhase:
    case record::NoteCode::SessionBegan:
    case record::NoteCode::LinkIsDown:
    case record::NoteCode::LinkIsLive:
    case record::NoteCode::LinkHolds:
    case record::NoteCode::LinkIsLost:
    case record::NoteCode::KeysReplaced:
      return true;
    default:
      return false;
  }
}

}  // namespace

RecordDesk::RecordDesk(const settings::RecordSettings& settings,
                       record::SessionInfo info,
                       std::size_t writer_count,
                       std::optional<Duration> live_period,
                       bool with_camera)
    : has_file_{!settings.file.empty() || !settings.files.empty()},
      prefix_{settings.files},
      info_{std::move(info)} {
  if (has_file_) {
    open(prefix_.empty() ? settings.file : next_path());
    if (!sink_) throw std::runtime_error{file_fault_};
  }
  if (live_period) {  // on the file's line of time, where there is one
    feed_.emplace(info_.site, sink_ ? info_.clock : wall_clock(), *live_period);
  }
  if (with_camera) camera_.emplace();
  tick_.reserve(kTickRecords);
  for (std::size_t i = 0; i <= writer_count; ++i) {  // the last is the maker's own
    queues_.push_back(std::make_unique<record::QueueRecorder>(settings.queue_records));
  }
}

std::string RecordDesk::next_path() const {
  const std::string number = std::to_string(info_.files_before + 1);
  return prefix_ + std::string(number.size() < 3 ? 3 - number.size() : 0, '0') + number + ".mcap";
}

/// Without a file at the end, `file_fault_` says why.
void RecordDesk::open(const std::string& path) {
  Result<record::FileSink> sink = record::FileSink::create(path);
  if (!sink) {
    file_fault_ = sink.error().text;
    return;
  }
  sink_.emplace(std::move(*sink));
  info_.opened_at = io::SteadyClock{}.now();
  info_.clock = wall_clock();
  if (info_.files_before == 0) {
    info_.metadata.emplace_back("run_began_utc",
                                record::utc_text(info_.clock.stamp(info_.opened_at)));
  }
  writer_.emplace(*sink_, info_);
  if (camera_) camera_->begin_file();
  if (!writer_->failed()) return;
  file_fault_ = sink_->fault();
  writer_.reset();
  sink_.reset();
  (void)std::remove(path.c_str());  // ours, and of no use
}

void RecordDesk::begin_next_file() {
  close_file();
  ++info_.files_before;
  ++info_.sessions_before;
  open(next_path());
}

/// What became of its records is added to the account.
void RecordDesk::close_file() {
  if (!writer_) return;
  writer_->close();
  sink_->finish();
  if (std::string sentence = fault(); !sentence.empty()) file_fault_ = std::move(sentence);
  lost_ += writer_->lost();
  if (sink_->removed()) {
    lost_ += writer_->messages();
  } else {
    account_.counts += writer_->counts();
    account_.messages += writer_->messages();
  }
  writer_.reset();
  sink_.reset();
}

void RecordDesk::work(TimePoint now) {
  const bool last = closing_;  // what was queued before that is written
  drain(now);
  if (writer_) writer_->flush_if_due(now);
  keep_watch(now);
  if (!last) return;
  for (const Record& one : tick_) write(one);
  tick_.clear();
  // A file of one session of many knows nothing of the run.
  if (writer_ && prefix_.empty() && !figures_.empty()) {
    writer_->add_metadata(record::kReportRecord, {{record::kReportKey, figures_}});
  }
  close_file();
  account_.fault = file_fault_;
  account_.dropped = dropped_ + lost_;
}

void RecordDesk::drain(TimePoint now) {
  for (const auto& queue : queues_) {
    const bool ticks = queue == queues_.front() && !prefix_.empty();
    queue->drain([&](const Record& record) {
      // Whoever reads the file knows of a gap from the first status behind it.
      if (std::holds_alternative<LinkStatus>(record)) count_dropped();
      ticks ? write_tick(record) : write(record);
    });
  }
  count_dropped();
  if (feed_ && (closing_ || now - fed_at_ >= kFeedEvery)) {
    fed_at_ = now;
    feed_->tell(writer_ && !writer_->failed());
  }
  if (camera_) {
    camera_->force().tell();
    camera_->write_to(writer_ ? &*writer_ : nullptr, info_.site, info_.clock);
  }
  write_peer();
}

void RecordDesk::count_dropped() {
  dropped_ = 0;
  for (const auto& queue : queues_) dropped_ += queue->dropped();
  if (writer_) writer_->set_dropped(dropped_);
}

/// The peer may be known before the first tick of its session is here.
void RecordDesk::write_peer() {
  for (io::PeerIdentity next; peers_.try_dequeue(next);) peer_ = next;
  const bool begun = prefix_.empty() || session_id_ == (peer_ ? peer_->session_id : 0);
  if (!peer_ || !writer_ || !begun) return;
  writer_->add_facts("palp.peer",
                     {{"session_id", record::session_id_text(peer_->session_id)},
                      {"identity", peer_->name},
                      {"certificate_sha256", peer_->fingerprint},
                      {"git_commit", peer_->build}});
  peer_.reset();
}

void RecordDesk::keep_watch(TimePoint now) {
  if (sink_ && now - looked_at_ >= DiskForecast::kLookEvery) {
    looked_at_ = now;
    sink_->look();
    if (const auto room = sink_->room()) forecast_.look(now, writer_->size(), *room);
  }
  const std::string wrong = fault();
  if (!wrong.empty() && told_fault_.empty()) {
    (void)news_.try_enqueue({"RECORDING FAILED, the session goes on: " + wrong, true});
    told_fault_ = wrong;
  }
  const Duration left = forecast_.left().value_or(Duration::max());
  const bool nearly_full = left < kNearlyFull;
  if (nearly_full && wrong.empty() && !std::exchange(told_of_nearly_full_, true)) {
    (void)news_.try_enqueue({"the disk of the session file is full in about " +
                                 std::to_string(left / std::chrono::seconds{1}) + " s",
                             true});
    constexpr auto kCode = static_cast<std::uint16_t>(record::NoteCode::DiskNearlyFull);
    if (writer_) (void)writer_->write(Note{.at = now, .code = kCode, .detail = seconds(left)});
  }
  need_.put({.at = now, .failed = !wrong.empty(), .nearly_full = nearly_full, .left = left});
}

/// Why the file lacks something by now.
std::string RecordDesk::fault() const {
  if (!file_fault_.empty() || !writer_) return file_fault_;
  if (std::string sentence = sink_->fault(); !sentence.empty()) return sentence;
  if (writer_->failed()) return "the session file could not be written any further";
  if (dropped_ > 0) return "records were lost: the session file was written too slowly";
  return {};
}

void RecordDesk::write(const Record& record) {
  tell_of(record);
  if (feed_) feed_->take(record);
  if (camera_) camera_->force().take(record);
  if (writer_) {
    (void)writer_->write(record);
  } else if (!file_fault_.empty()) {
    ++lost_;
  }
}

/// A tick's records end with what the link said, and that says whether it is another session's.
void RecordDesk::write_tick(const Record& record) {
  tick_.push_back(record);
  const auto* heard = std::get_if<LinkHeard>(&record);
  if (heard == nullptr && tick_.size() < kTickRecords) return;
  if (heard != nullptr && heard->session_id != 0 && heard->session_id != session_id_) {
    if (session_id_ != 0) begin_next_file();
    session_id_ = heard->session_id;
  }
  for (const Record& one : tick_) write(one);
  tick_.clear();
}

void RecordDesk::tell_of(const Record& record) {
  if (const auto* change = std::get_if<Transition>(&record)) {
    const std::string_view reason = record::note_text(change->reason);
    (void)news_.try_enqueue({std::string{to_string(change->from)} + " -> " +
                                 std::string{to_string(change->to)} + ": " + std::string{reason},
                             false});
  } else if (const auto* note = std::get_if<Note>(&record)) {
    const auto code = static_cast<record::NoteCode>(note->code);
    if (code == record::NoteCode::Marked) {
      const auto number = static_cast<std::uint64_t>(note->detail);
      (void)news_.try_enqueue({"moment " + std::to_string(number) + " is marked", false});
    } else if (!shown_elsewhere(code)) {
      (void)news_.try_enqueue({std::string{record::to_string(code)}, false});
    }
  }
}

}  // namespace palp::site_program
