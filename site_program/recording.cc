#include "site_program/recording.h"

#include <algorithm>
#include <utility>

#include "common/io/realtime/steady_clock.h"
#include "common/record/notes.h"

namespace palp::site_program {
namespace {

constexpr Duration kPause = std::chrono::milliseconds{20};
/// A drawn picture is as old as the newest record.
constexpr Duration kCameraPause = std::chrono::milliseconds{4};
/// A record thread that has not come back for so long stands before a disk that does not answer.
constexpr Duration kSilence = std::chrono::seconds{2};
/// What a good disk may need for the last of a session.
constexpr Duration kPatience = std::chrono::seconds{10};

}  // namespace

Recording::Recording(const settings::RecordSettings& settings,
                     record::SessionInfo info,
                     std::size_t writer_count,
                     std::optional<Duration> live_period,
                     bool with_camera)
    : desk_{std::make_unique<RecordDesk>(
          settings, std::move(info), writer_count, live_period, with_camera)},
      began_{io::SteadyClock{}.now()},
      loop_{std::make_unique<io::BackgroundLoop>(
          "palp-record", with_camera ? kCameraPause : kPause, [desk = desk_.get()](TimePoint now) {
            desk->work(now);
          })} {}

Recording::~Recording() {
  try {
    stop();
  } catch (...) {  // who wants to know calls stop()
  }
}

Duration Recording::silent_for() {
  return io::SteadyClock{}.now() - std::max(began_, desk_->need().at);
}

void Recording::mark(std::uint32_t count, TimePoint now) {
  while (marks_ < count) {
    ++marks_;
    note(record::NoteCode::Marked, static_cast<double>(marks_), now);
  }
}

std::string Recording::alarm() {
  if (!desk_) return "RECORDING FAILED ";
  const RecordDesk::Need& need = desk_->need();
  if (need.failed) return "RECORDING FAILED ";
  if (loop_ && silent_for() > kSilence) return "THE DISK DOES NOT ANSWER ";
  if (!need.nearly_full) return {};
  return "DISK FULL IN " + std::to_string(need.left / std::chrono::seconds{1}) + " S ";
}

void Recording::tell_news(StatusLine& line) {
  if (!desk_) return;
  for (RecordDesk::News news; desk_->take(news);) {
    if (news.sentence != told_last_) {
      news.alarming ? line.warn(news.sentence) : line.info(news.sentence);
    }
    told_last_ = news.sentence;
  }
  if (loop_ && silent_for() > kSilence && !std::exchange(told_of_silence_, true)) {
    line.warn("the disk of the session file does not answer; the session goes on");
  }
}

const RecordAccount& Recording::stop(std::string figures) {
  if (!loop_) return account_;
  desk_->close(std::move(figures));
  if (loop_->stop_within(kPatience)) {
    account_ = desk_->account();
  } else {
    (void)desk_.release();  // the thread's own now, whenever the disk lets it go
    account_.fault = "the disk of the session file does not answer";
  }
  loop_.reset();
  return account_;
}

}  // namespace palp::site_program
