#include "site_program/recording.h"

#include <cstdio>
#include <stdexcept>
#include <utility>

#include "common/io/realtime/steady_clock.h"
#include "common/record/notes.h"

namespace palp::site_program {
namespace {

constexpr Duration kPause = std::chrono::milliseconds{20};

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

Recording::Recording(const settings::RecordSettings& settings,
                     record::SessionInfo info,
                     std::size_t writer_count) {
  if (!settings.file.empty()) {
    Result<record::FileSink> sink = record::FileSink::create(settings.file);
    if (!sink) throw std::runtime_error{sink.error().text};
    sink_.emplace(std::move(*sink));
    info.opened_at = io::SteadyClock{}.now();
    writer_.emplace(*sink_, info);
    if (writer_->failed()) {
      (void)std::remove(settings.file.c_str());  // ours, and of no use
      throw std::runtime_error{sink_->fault()};
    }
  }
  for (std::size_t i = 0; i < writer_count; ++i) {
    queues_.push_back(std::make_unique<record::QueueRecorder>(settings.queue_records));
  }
  loop_.emplace("palp-record", kPause, [this](TimePoint now) { drain(now); });
}

Recording::~Recording() = default;

void Recording::drain(TimePoint now) {
  std::uint64_t dropped = 0;
  for (const auto& queue : queues_) {
    queue->drain([this, now](const Record& record) { write(record, now); });
    dropped += queue->dropped();
  }
  account_.dropped = dropped;
  if (!writer_) return;
  writer_->set_dropped(dropped);
  writer_->flush_if_due(now);
  keep_watch(now);
}

void Recording::keep_watch(TimePoint now) {
  if (now - looked_at_ >= DiskForecast::kLookEvery) {
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
    (void)writer_->write(Note{.at = now, .code = kCode, .detail = seconds(left)}, now);
  }
  need_.put({.failed = !wrong.empty(), .nearly_full = nearly_full, .left = left});
}

/// Why the file lacks something by now.
std::string Recording::fault() const {
  if (!writer_) return {};
  if (std::string sentence = sink_->fault(); !sentence.empty()) return sentence;
  if (writer_->failed()) return "the session file could not be written any further";
  if (account_.dropped > 0) return "records were lost: the session file was written too slowly";
  return {};
}

std::string Recording::alarm() {
  const Need& need = need_.get();
  if (need.failed) return "RECORDING FAILED ";
  if (!need.nearly_full) return {};
  return "DISK FULL IN " + std::to_string(need.left / std::chrono::seconds{1}) + " S ";
}

void Recording::write(const Record& record, TimePoint now) {
  tell_of(record);
  if (writer_) (void)writer_->write(record, now);
}

void Recording::tell_of(const Record& record) {
  if (const auto* change = std::get_if<Transition>(&record)) {
    const std::string_view reason = record::note_text(change->reason);
    (void)news_.try_enqueue({std::string{to_string(change->from)} + " -> " +
                                 std::string{to_string(change->to)} + ": " + std::string{reason},
                             false});
  } else if (const auto* note = std::get_if<Note>(&record)) {
    const auto code = static_cast<record::NoteCode>(note->code);
    if (!shown_elsewhere(code)) {
      (void)news_.try_enqueue({std::string{record::to_string(code)}, false});
    }
  }
}

void Recording::tell_news(StatusLine& line) {
  for (News news; news_.try_dequeue(news);) {
    if (news.sentence != told_last_) {
      news.alarming ? line.warn(news.sentence) : line.info(news.sentence);
    }
    told_last_ = news.sentence;
  }
}

const RecordAccount& Recording::stop() {
  if (!loop_) return account_;
  loop_->stop();
  loop_.reset();
  if (writer_) close();
  return account_;
}

void Recording::close() {
  writer_->close();
  sink_->finish();
  account_.fault = fault();
  account_.counts = writer_->counts();
  account_.messages = writer_->messages();
  account_.dropped += writer_->lost();
  if (sink_->removed()) {
    account_.dropped += account_.messages;
    account_.counts = {};
    account_.messages = 0;
  }
}

}  // namespace palp::site_program
