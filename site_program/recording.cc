#include "site_program/recording.h"

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
  if (writer_->failed() && !std::exchange(told_of_full_disk_, true)) {
    (void)news_.try_enqueue("the session file ends here: it could not be written any further");
  }
}

void Recording::write(const Record& record, TimePoint now) {
  tell_of(record);
  if (writer_) (void)writer_->write(record, now);
}

void Recording::tell_of(const Record& record) {
  if (const auto* change = std::get_if<Transition>(&record)) {
    const std::string_view reason = record::note_text(change->reason);
    (void)news_.try_enqueue(std::string{to_string(change->from)} + " -> " +
                            std::string{to_string(change->to)} + ": " + std::string{reason});
  } else if (const auto* note = std::get_if<Note>(&record)) {
    const auto code = static_cast<record::NoteCode>(note->code);
    if (!shown_elsewhere(code)) (void)news_.try_enqueue(std::string{record::to_string(code)});
  }
}

void Recording::tell_news(StatusLine& line) {
  for (std::string sentence; news_.try_dequeue(sentence);) {
    if (sentence != told_last_) line.info(sentence);
    told_last_ = sentence;
  }
}

const RecordAccount& Recording::stop() {
  if (!loop_) return account_;
  loop_->stop();
  loop_.reset();
  if (writer_) {
    writer_->close();
    account_.counts = writer_->counts();
    account_.messages = writer_->messages();
    account_.dropped += writer_->lost();
  }
  return account_;
}

}  // namespace palp::site_program
