#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/core/mailbox.h"
#include "common/core/spsc_queue.h"
#include "common/io/realtime/background_loop.h"
#include "common/io/secure/session_news.h"
#include "common/record/queue_recorder.h"
#include "common/record/session_writer.h"
#include "common/settings/site_settings.h"
#include "site_program/disk_forecast.h"
#include "site_program/status_line.h"

namespace palp::site_program {

/// What became of the records.
struct RecordAccount {
  record::SessionCounts counts;  ///< in the file
  std::uint64_t messages{};      ///< in the file, views included
  std::uint64_t dropped{};       ///< a queue was full, or the disk, or the file was removed
  std::string fault;             ///< why the file lacks something, one sentence; empty: it does not
};

/// Carries the records of a site's threads to its session file, on a thread of its own (record),
/// and tells people of what happened; where files of sessions are asked for, each session after the
/// first begins the next file, at the first record of its first tick. Without a file the records go
/// nowhere. Where the file cannot
/// take them the session goes on without, and everybody is told.
/// Thread: its maker's; each recorder() has one writer of its own.
class Recording {
 public:
  /// `info.opened_at` and its clock are filled in here.
  /// @throws std::runtime_error with one sentence where the file cannot be created or begun.
  Recording(const settings::RecordSettings& settings,
            record::SessionInfo info,
            std::size_t writer_count);
  /// Closes the file.
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  [[nodiscard]] record::Recorder& recorder(std::size_t writer) { return *queues_.at(writer); }
  /// Notes a moment for each mark that is new of `count`. Thread: its maker's.
  void mark(std::uint32_t count, TimePoint now);
  /// Into the file of that session: who the peer is (metadata `palp.peer`). Thread: its maker's.
  void tell_of_peer(const io::PeerIdentity& peer) { (void)peers_.try_enqueue(peer); }
  /// Tells people of changes of state and of notes; what repeats itself once.
  void tell_news(StatusLine& line);
  /// What stands at the head of the status line while the recording is in need, with a space behind
  /// it; empty: it is well.
  [[nodiscard]] std::string alarm();
  /// Once all writers have ended: writes what waits and closes the file. Idempotent.
  const RecordAccount& stop();

 private:
  void drain(TimePoint now);
  void write(const Record& record);
  void write_tick(const Record& record);
  [[nodiscard]] std::string next_path() const;
  void open(const std::string& path);
  void begin_next_file();
  void close_file();
  void tell_of(const Record& record);
  void keep_watch(TimePoint now);
  [[nodiscard]] std::string fault() const;

  void write_peer();

  static constexpr std::size_t kNewsMax = 256;
  static constexpr std::size_t kPeersMax = 16;
  /// Less than so much recording left is told.
  static constexpr Duration kNearlyFull = std::chrono::minutes{5};
  struct News {
    std::string sentence;
    bool alarming{};
  };
  struct Need {
    bool failed{};
    bool nearly_full{};
    Duration left{};
  };

  std::string prefix_;  ///< of the files of sessions; empty: one file
  record::SessionInfo info_;
  std::uint64_t session_id_{};  ///< record's, as the next three: of the newest session
  std::vector<Record> tick_;    ///< of the present tick, with files of sessions
  std::string file_fault_;      ///< of a file before this one, or why there is none
  std::optional<record::FileSink> sink_;
  std::optional<record::SessionWriter> writer_;
  std::vector<std::unique_ptr<record::QueueRecorder>> queues_;
  SpscQueue<News> news_{kNewsMax};                ///< writer: record, reader: the maker
  SpscQueue<io::PeerIdentity> peers_{kPeersMax};  ///< writer: the maker, reader: record
  std::optional<io::PeerIdentity> peer_;          ///< record's: in no file yet
  std::uint32_t marks_{};                         ///< the maker's
  std::string told_last_;                         ///< the maker's
  DiskForecast forecast_;                         ///< record's, as are the next three
  TimePoint looked_at_{};
  bool told_of_nearly_full_{};
  std::string told_fault_;
  Mailbox<Need> need_;    ///< writer: record, reader: the maker
  std::uint64_t lost_{};  ///< in no file, and not for a full queue
  RecordAccount account_;
  std::optional<io::BackgroundLoop> loop_;
};

}  // namespace palp::site_program
