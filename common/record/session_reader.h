#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/link/telegram.h"
#include "common/record/mcap_reader.h"
#include "common/record/recorder.h"
#include "common/record/sequence_count.h"
#include "common/record/session_decoder.h"
#include "common/record/wall_clock.h"

namespace palp::record {

/// A session that a file names.
struct SessionName {
  std::string id;  ///< 16 hexadecimal digits, the same in both sites' files
  std::string number;
  std::string began_utc;
};

struct SessionEntry {
  link::Role site{};
  Record record;
};

struct TopicCount {
  std::string schema;
  std::uint64_t messages{};
  TimePoint first{};  ///< the sample's own instant, as are the following
  TimePoint last{};
  SequenceCount sequence;
  bool looked_at{};            ///< `sequence` has seen a message
  std::uint64_t dated_back{};  ///< ticks that are older than the one before
};

/// Reads a session file back to Records, also one that was cut off or damaged (see McapReader).
/// Messages that nobody of ours wrote are counted, never fatal. Does not own the bytes.
class SessionReader {
 public:
  explicit SessionReader(const FileBytes& file, const McapLimits& limits = {});

  /// The next record, or nullopt at the end. Views carry no record; they are only counted.
  std::optional<SessionEntry> next();

  /// As McapReader::only_between(), of instants of the site's own time. A first entry was read;
  /// sequences and dates are looked at anew, of messages in that time alone.
  void only_between(TimePoint from, TimePoint to);
  /// It was called: what the file says of itself as a whole need not agree with what was read.
  [[nodiscard]] bool partial() const noexcept { return window_.has_value(); }

  // All that was met so far; complete once next() said nullopt.
  [[nodiscard]] const McapReadReport& report() const noexcept { return mcap_.report(); }
  [[nodiscard]] const std::map<std::string, TopicCount>& topics() const noexcept { return topics_; }
  /// A value of a metadata record ("palp", "program"), or nullopt.
  [[nodiscard]] std::optional<std::string> metadata(std::string_view record,
                                                    std::string_view key) const;
  /// All of it; empty if there is none.
  [[nodiscard]] McapMap metadata(std::string_view record) const;
  /// The content, or nullopt; valid as long as the file's bytes.
  [[nodiscard]] std::optional<std::string_view> attachment(std::string_view name) const;
  [[nodiscard]] std::uint64_t unknown() const noexcept { return unknown_; }
  [[nodiscard]] std::uint64_t malformed() const noexcept { return malformed_; }
  // Of all topics: see SequenceCount and TopicCount.
  [[nodiscard]] std::uint64_t missing() const noexcept;
  [[nodiscard]] std::uint64_t disordered() const noexcept;
  [[nodiscard]] std::uint64_t dated_back() const noexcept;
  /// Topic and sequence of the first malformed message; empty: there is none.
  [[nodiscard]] const std::string& first_malformed() const noexcept { return first_malformed_; }
  /// Sessions in the order in which they began.
  [[nodiscard]] const std::vector<SessionName>& sessions() const noexcept { return sessions_; }
  /// What makes a stamp of the file an instant of the site's own time.
  [[nodiscard]] const WallClock& clock() const noexcept { return clock_; }
  /// Earliest instant of any sample: where a session's own time begins.
  [[nodiscard]] std::optional<TimePoint> began_at() const noexcept { return began_at_; }
  [[nodiscard]] std::optional<TimePoint> ended_at() const noexcept { return ended_at_; }

 private:
  struct Window {
    std::uint64_t from{};  ///< [ns], stamp of the file
    std::uint64_t to{};    ///< [ns]
  };

  std::optional<SessionEntry> decode(const McapMessage& message);
  void look_at_order(TopicCount& topic, const McapMessage& message, TimePoint at) const;
  void count(const McapMessage& message);
  void keep(const McapAttachment& attachment);
  void keep(const McapMetadata& metadata);

  McapReader mcap_;
  std::optional<Window> window_;
  std::map<std::string, TopicCount> topics_;
  std::map<std::string, McapMap, std::less<>> metadata_;
  std::size_t metadata_size_{};  ///< [bytes]
  std::map<std::string, std::string_view, std::less<>> attachments_;
  std::vector<SessionName> sessions_;
  SessionDecoder::Parts parts_;  ///< of the newest message, still to be given
  link::Role parts_of_{};
  WallClock clock_;
  std::uint64_t unknown_{};
  std::uint64_t malformed_{};
  std::string first_malformed_;
  std::optional<TimePoint> began_at_;
  std::optional<TimePoint> ended_at_;
};

}  // namespace palp::record
