#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/core/mailbox.h"
#include "common/core/spsc_queue.h"
#include "common/io/secure/session_news.h"
#include "common/record/queue_recorder.h"
#include "common/record/session_writer.h"
#include "common/settings/site_settings.h"
#include "monitor/feed.h"
#include "site_program/camera_recording.h"
#include "site_program/disk_forecast.h"

namespace palp::site_program {

/// What became of the records.
struct RecordAccount {
  record::SessionCounts counts;  ///< in the file
  std::uint64_t messages{};      ///< in the file, views included
  std::uint64_t dropped{};       ///< a queue was full, or the disk, or the file was removed
  std::string fault;             ///< why the file lacks something, one sentence; empty: it does not
};

/// What the record thread does: it takes records from their queues to the session file and watches
/// the disk. Where files of sessions are asked for, each session after the first begins the next
/// file, at the first record of its first tick. A disk that does not answer may hold its thread
/// longer than anybody waits: the thread has it to itself then.
/// Thread: record, but for what says otherwise.
class RecordDesk {
 public:
  struct News {
    std::string sentence;
    bool alarming{};
  };
  struct Need {
    TimePoint at{};  ///< of this look
    bool failed{};
    bool nearly_full{};
    Duration left{};
  };

  /// As Recording. Thread: its maker's.
  RecordDesk(const settings::RecordSettings& settings,
             record::SessionInfo info,
             std::size_t writer_count,
             std::optional<Duration> live_period,
             bool with_camera);

  /// Writes what waits; once close() was said, the last of it, and closes the file.
  void work(TimePoint now);
  /// All writers have ended. `figures`: as Recording::stop(). Thread: the maker's.
  void close(std::string figures) {
    figures_ = std::move(figures);
    closing_ = true;
  }
  /// Once work() has come back from that. Thread: the maker's.
  [[nodiscard]] const RecordAccount& account() const noexcept { return account_; }

  /// Null where nobody looks on.
  [[nodiscard]] monitor::Feed* feed() noexcept { return feed_ ? &*feed_ : nullptr; }
  /// One was asked for. Thread: the maker's.
  [[nodiscard]] bool has_file() const noexcept { return has_file_; }
  /// Null where no picture is sent or looked at.
  [[nodiscard]] CameraRecording* camera() noexcept { return camera_ ? &*camera_ : nullptr; }
  [[nodiscard]] record::Recorder& recorder(std::size_t writer) { return *queues_.at(writer); }
  /// Into the queue behind those of the writers. Thread: the maker's.
  void note(const Note& note) noexcept { (void)queues_.back()->record(note); }
  /// Into the file of that session, as metadata `palp.peer`. Thread: the maker's.
  void tell_of_peer(const io::PeerIdentity& peer) { (void)peers_.try_enqueue(peer); }
  /// What people are told of; false: no more. Thread: the maker's.
  [[nodiscard]] bool take(News& news) noexcept { return news_.try_dequeue(news); }
  [[nodiscard]] const Need& need() noexcept { return need_.get(); }  ///< Thread: the maker's.

 private:
  void drain(TimePoint now);
  void count_dropped();
  void write(const Record& record);
  void write_tick(const Record& record);
  [[nodiscard]] std::string next_path() const;
  void open(const std::string& path);
  void begin_next_file();
  void close_file();
  void tell_of(const Record& record);
  void write_peer();
  void keep_watch(TimePoint now);
  [[nodiscard]] std::string fault() const;

  static constexpr std::size_t kNewsMax = 256;
  static constexpr std::size_t kPeersMax = 16;
  /// Less than so much recording left is told.
  static constexpr Duration kNearlyFull = std::chrono::minutes{5};

  bool has_file_;
  std::string prefix_;  ///< of the files of sessions; empty: one file
  record::SessionInfo info_;
  std::uint64_t session_id_{};  ///< of the newest session
  std::vector<Record> tick_;    ///< of the present tick, with files of sessions
  std::string file_fault_;      ///< of a file before this one, or why there is none
  std::optional<record::FileSink> sink_;
  std::optional<record::SessionWriter> writer_;
  std::vector<std::unique_ptr<record::QueueRecorder>> queues_;
  std::optional<monitor::Feed> feed_;
  TimePoint fed_at_{};
  std::optional<CameraRecording> camera_;
  SpscQueue<News> news_{kNewsMax};                ///< reader: the maker
  SpscQueue<io::PeerIdentity> peers_{kPeersMax};  ///< writer: the maker
  std::optional<io::PeerIdentity> peer_;          ///< in no file yet
  DiskForecast forecast_;
  TimePoint looked_at_{};
  bool told_of_nearly_full_{};
  std::string told_fault_;
  Mailbox<Need> need_;       ///< reader: the maker
  std::uint64_t dropped_{};  ///< by full queues
  std::uint64_t lost_{};     ///< in no file, and not for a full queue
  RecordAccount account_;
  std::string figures_;  ///< written before closing_, read behind it
  std::atomic<bool> closing_{};
};

}  // namespace palp::site_program
