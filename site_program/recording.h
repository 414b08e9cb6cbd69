#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "common/io/realtime/background_loop.h"
#include "common/record/notes.h"
#include "site_program/record_desk.h"
#include "site_program/status_line.h"

namespace palp::site_program {

/// Carries the records of a site's threads to its session file, on a thread of its own (record),
/// and tells people of what happened. Without a file the records go nowhere. Where the file cannot
/// take them the session goes on without, and everybody is told; a disk that does not answer is
/// told too, and at the end it is waited for a few seconds and no longer.
/// Thread: its maker's; each recorder() has one writer of its own.
class Recording {
 public:
  /// `info.opened_at` and its clock are filled in here. `live_period`: of the site's ticks, where
  /// somebody looks on: then there is a feed(). `with_camera`: then there is a camera().
  /// @throws std::runtime_error with one sentence where the file cannot be created or begun.
  Recording(const settings::RecordSettings& settings,
            record::SessionInfo info,
            std::size_t writer_count,
            std::optional<Duration> live_period = {},
            bool with_camera = false);
  /// As stop().
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  [[nodiscard]] record::Recorder& recorder(std::size_t writer) { return desk_->recorder(writer); }
  /// What the site's monitor shows; null where nobody looks on. Until stop().
  [[nodiscard]] monitor::Feed* feed() noexcept { return desk_->feed(); }
  /// Somebody will look at what is recorded. Until stop().
  [[nodiscard]] bool has_file() const noexcept { return desk_->has_file(); }
  /// For the thread of the video; null where there is none. Until stop().
  [[nodiscard]] CameraRecording* camera() noexcept { return desk_->camera(); }
  /// What a client asked for.
  void note(record::NoteCode code, double detail, TimePoint now) noexcept {
    desk_->note(Note{.at = now, .code = static_cast<std::uint16_t>(code), .detail = detail});
  }
  /// Notes a moment for each mark that is new of `count`.
  void mark(std::uint32_t count, TimePoint now);
  /// Into the file of that session: who the peer is.
  void tell_of_peer(const io::PeerIdentity& peer) { desk_->tell_of_peer(peer); }
  /// Tells people of changes of state and of notes; what repeats itself once.
  void tell_news(StatusLine& line);
  /// What stands at the head of the status line while the recording is in need, with a space behind
  /// it; empty: it is well.
  [[nodiscard]] std::string alarm();
  /// Once all writers have ended: writes what waits, and `figures`, what the program reports of its
  /// run, and closes the file. Idempotent.
  const RecordAccount& stop(std::string figures = {});

 private:
  [[nodiscard]] Duration silent_for();

  std::unique_ptr<RecordDesk> desk_;
  std::uint32_t marks_{};
  std::string told_last_;
  bool told_of_silence_{};
  RecordAccount account_;
  TimePoint began_;
  std::unique_ptr<io::BackgroundLoop> loop_;
};

}  // namespace palp::site_program
