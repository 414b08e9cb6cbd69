#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "common/message/tick_view.h"
#include "common/record/given_gatherer.h"
#include "common/record/mcap_writer.h"
#include "common/record/recorder.h"
#include "common/record/session_encoder.h"
#include "common/record/wall_clock.h"

namespace palp::record {

struct SessionAttachment {
  std::string name;        ///< "config.textproto", "tissue.csv"
  std::string media_type;  ///< "text/plain", "text/csv"
  std::string content;
};

/// What a file says of itself before its first message.
struct SessionInfo {
  link::Role site{};
  /// Program, version, git commit, protocol version, seed, host kernel, real or virtual time, ...:
  /// becomes the metadata record `palp`.
  McapMap metadata{};
  std::vector<SessionAttachment> attachments{};
  TimePoint opened_at{};
  WallClock clock{};
  /// Of the site's run before this file: files have the numbers 1, 2, ..., as sessions have.
  std::uint32_t files_before{};
  std::uint32_t sessions_before{};
};

/// The metadata record and its entry that hold the report of a site's program, as JSON.
inline constexpr const char* kReportRecord = "palp.report";
inline constexpr const char* kReportKey = "json";

struct SessionCounts {
  SessionCounts& operator+=(const SessionCounts& other) noexcept;
  std::array<std::uint64_t, std::variant_size_v<Record>> by_type{};  ///< in the order of Record
  std::uint64_t views{};                                             ///< of ticks
  std::uint64_t log_lines{};                                         ///< of events
  std::uint64_t foreign{};                                           ///< of others' schemas
  std::uint64_t misplaced{};  ///< records that have no topic at this site
  [[nodiscard]] std::uint64_t records() const noexcept;
  /// Messages of the file: records, and what says the same once more.
  [[nodiscard]] std::uint64_t messages() const noexcept {
    return records() + views + log_lines + foreign;
  }
};

/// Writes one site's session file: each Record on its topic, stamped with its own instant on the
/// wall clock; the ticks once more at 50 Hz as extremes, the events as foxglove.Log. As a session
/// begins the metadata record `palp.session` names it. Never throws after construction; when the
/// disk is full the recording ends and `lost()` grows. Thread: record (or the one thread of virtual
/// time).
class SessionWriter {
 public:
  /// `sink` outlives the writer.
  SessionWriter(ByteSink& sink, const SessionInfo& info, const McapOptions& options = {});
  ~SessionWriter();
  SessionWriter(const SessionWriter&) = delete;
  SessionWriter& operator=(const SessionWriter&) = delete;

  /// @returns false: not written, and counted.
  bool write(const Record& record);
  /// Of another schema than ours; the file has it from now on. @returns its number for write().
  struct ForeignTopic {
    std::string name;    ///< "patient/camera"
    std::string schema;  ///< full name of the message
    Bytes descriptors;   ///< FileDescriptorSet
  };
  std::uint16_t add_topic(const ForeignTopic& topic);
  /// When a sample was taken, and when the site had it: publish_time and log_time of its message.
  struct Instants {
    TimePoint sample{};
    TimePoint logged{};
  };
  /// A message there. @returns false: not written, and counted.
  bool write(std::uint16_t topic, const Instants& at, std::span<const std::byte> message);
  /// Facts that become known while it runs: a metadata record of that name.
  void add_facts(const std::string& name, const McapMap& facts);
  /// Total of records that a full queue dropped; shown in the next link status and the summary.
  void set_dropped(std::uint64_t total) noexcept { dropped_ = total; }
  /// Of the session as a whole; the names `palp...` of summary and sessions are taken.
  void add_metadata(std::string_view name, const McapMap& entries) {
    mcap_.add_metadata(name, entries);
  }
  /// Keeps the promise that a kill loses at most half a second, also when nothing is recorded.
  void flush_if_due(TimePoint now);
  /// Writes summary and index; the destructor does it too. Later writes are refused.
  void close();

  /// What is in the file or its waiting chunk; once writing failed, what is in the file.
  [[nodiscard]] const SessionCounts& counts() const noexcept {
    return failed() ? settled_ : counts_;
  }
  /// Messages in the file (or its waiting chunk), all of them: what an independent reader counts.
  [[nodiscard]] std::uint64_t messages() const noexcept { return mcap_.counts().messages; }
  [[nodiscard]] std::uint64_t lost() const noexcept { return mcap_.counts().lost; }
  [[nodiscard]] std::uint64_t size() const noexcept { return mcap_.counts().bytes; }  ///< [bytes]
  [[nodiscard]] bool failed() const noexcept { return mcap_.failed(); }

 private:
  bool write_alone(const Record& record);
  bool write_tick();
  template <class FileTick>
  bool put_whole(FileTick tick);
  void release_tick();
  bool put(const Prepared& prepared);
  struct Channel {
    std::uint16_t id{};
    std::uint32_t sequence{};
  };
  /// Room for a message; nullptr: the recording has ended.
  std::byte* place_for(Channel& channel, std::uint64_t stamp, std::size_t size) {
    return place_for(channel, stamp, stamp, size);
  }
  std::byte* place_for(Channel& channel,
                       std::uint64_t logged,
                       std::uint64_t published,
                       std::size_t size);
  void view(const SiteTick& tick);
  void write_view();
  void write_log_line(const Record& event, TimePoint at);
  void look_for_session(const LinkHeard& heard);

  McapWriter mcap_;
  SessionEncoder encoder_;
  std::array<Channel, kTopicCount> channels_{};
  Channel log_channel_;
  std::vector<Channel> foreign_;
  GivenGatherer gatherer_;
  TickView view_;
  WallClock clock_;
  std::uint64_t session_id_{};  ///< the newest; 0: none yet
  std::uint32_t sessions_{};
  std::uint64_t dropped_{};
  SessionCounts counts_;
  SessionCounts settled_;  ///< as of the newest chunk that was written
  bool closed_{};
};

}  // namespace palp::record
