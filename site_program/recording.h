#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/core/spsc_queue.h"
#include "common/io/realtime/background_loop.h"
#include "common/record/queue_recorder.h"
#include "common/record/session_writer.h"
#include "common/settings/site_settings.h"
#include "site_program/status_line.h"

namespace palp::site_program {

/// What became of the records.
struct RecordAccount {
  record::SessionCounts counts;  ///< in the file
  std::uint64_t messages{};      ///< in the file, views included
  std::uint64_t dropped{};       ///< a queue was full, or the disk
};

/// Carries the records of a site's threads to its session file, on a thread of its own (record),
/// and tells people of what happened. Without a file the records go nowhere.
/// Thread: its maker's; each recorder() has one writer of its own.
class Recording {
 public:
  /// `info.opened_at` is filled in here.
  /// @throws std::runtime_error with one sentence where the file cannot be created.
  Recording(const settings::RecordSettings& settings,
            record::SessionInfo info,
            std::size_t writer_count);
  /// Closes the file.
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  [[nodiscard]] record::Recorder& recorder(std::size_t writer) { return *queues_.at(writer); }
  /// Tells people of changes of state and of notes; what repeats itself once.
  void tell_news(StatusLine& line);
  /// Once all writers have ended: writes what waits and closes the file. Idempotent.
  const RecordAccount& stop();

 private:
  void drain(TimePoint now);
  void write(const Record& record, TimePoint now);
  void tell_of(const Record& record);

  static constexpr std::size_t kNewsMax = 256;

  std::optional<record::FileSink> sink_;
  std::optional<record::SessionWriter> writer_;
  std::vector<std::unique_ptr<record::QueueRecorder>> queues_;
  SpscQueue<std::string> news_{kNewsMax};  ///< writer: record, reader: the maker
  std::string told_last_;                  ///< the maker's
  bool told_of_full_disk_{};
  RecordAccount account_;
  std::optional<io::BackgroundLoop> loop_;
};

}  // namespace palp::site_program
