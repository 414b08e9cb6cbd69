// Input: a session file. Then the same file as if a crash had cut it off.
#include <algorithm>
#include <variant>

#include "common/core/check.h"
#include "common/record/mcap_reader.h"
#include "common/record/session_reader.h"
#include "tests/fuzz/fuzz.h"

namespace palp::record {
namespace {

using File = std::span<const std::byte>;

/// Small, so that inputs come close to them.
constexpr McapLimits kLimits{
    .chunk_size_max = 1 << 16, .definitions_size_max = 1 << 12, .faults_max = 4};

/// What came out of a file, to be compared with what the reader says of it.
struct Tally {
  std::uint64_t messages{};
  std::uint64_t attachments{};
  std::uint64_t metadata{};
  std::uint64_t largest_log_time{};  ///< [ns]

  void operator()(const McapSchema& schema) const {
    PALP_CHECK(schema.id != 0, "no schema has the id of none");
    PALP_CHECK(schema.data.size() <= kLimits.definitions_size_max, "definitions keep the limit");
  }
  void operator()(const McapChannel&) const {}
  void operator()(const McapMessage& message) {
    ++messages;
    largest_log_time = std::max(largest_log_time, message.log_time);
    PALP_CHECK(message.channel != nullptr, "each message has its channel");
    PALP_CHECK((message.schema == nullptr) == (message.channel->schema == 0),
               "a message has the schema that its channel names");
    PALP_CHECK(message.payload.size() <= std::max(kLimits.chunk_size_max, file_size),
               "a payload is no larger than what it came in");
    touch(message.payload);
  }
  void operator()(const McapAttachment& attachment) {
    ++attachments;
    PALP_CHECK(attachment.data.size() <= file_size, "an attachment lies in the file");
    touch(attachment.data);
  }
  void operator()(const McapMetadata&) { ++metadata; }
  void operator()(const McapStatistics&) const {}

  std::uint64_t file_size{};  ///< [bytes]

 private:
  /// Lets the address sanitizer look at each byte.
  void touch(File bytes) {
    for (const std::byte byte : bytes) sum_ ^= byte;
  }
  std::byte sum_{};
};

McapReadReport file_laws(File file) {
  McapReader reader{file, kLimits};
  Tally tally;
  tally.file_size = file.size();
  while (const auto item = reader.next()) std::visit(tally, *item);
  PALP_CHECK(!reader.next(), "behind the end there is nothing");
  const McapReadReport& report = reader.report();
  PALP_CHECK(report.messages == tally.messages && report.attachments == tally.attachments &&
                 report.metadata == tally.metadata &&
                 report.last_log_time == tally.largest_log_time,
             "the reader counts what it hands out");
  PALP_CHECK(report.chunks_damaged <= report.chunks, "only chunks are damaged chunks");
  PALP_CHECK(
      report.faults.size() == std::min<std::uint64_t>(report.fault_count, kLimits.faults_max),
      "the first faults are kept");
  PALP_CHECK(report.bytes_unread <= file.size(), "only bytes of the file are unread");
  for (const McapFault& fault : report.faults) {
    PALP_CHECK(fault.offset <= file.size() && !fault.text.empty(), "a fault says where and what");
  }
  return report;
}

void cut_laws(File file, const McapReadReport& whole) {
  for (const std::size_t size : {file.size() / 2, file.size() - file.size() / 4, file.size() - 1}) {
    const McapReadReport cut = file_laws(file.first(size));
    PALP_CHECK(cut.messages <= whole.messages && cut.chunks <= whole.chunks &&
                   cut.attachments <= whole.attachments,
               "a cut adds nothing");
    PALP_CHECK(whole.closed || cut.fault_count <= whole.fault_count + 1, "a cut is one fault");
  }
}

void session_laws(File file) {
  SessionReader reader{file, kLimits};
  std::uint64_t records = 0;
  while (reader.next()) ++records;
  PALP_CHECK(!reader.next(), "behind the end there is nothing");
  std::uint64_t messages = 0;
  for (const auto& [topic, count] : reader.topics()) {
    PALP_CHECK(count.messages > 0, "a topic that is counted has messages");
    messages += count.messages;
    PALP_CHECK(reader.began_at() <= count.first && count.last <= reader.ended_at(),
               "no topic reaches beyond the session");
  }
  PALP_CHECK(messages == reader.report().messages, "each message belongs to one topic");
  PALP_CHECK(records + reader.unknown() + reader.malformed() <= messages,
             "each message has one outcome");
  PALP_CHECK((reader.malformed() == 0) == reader.first_malformed().empty(),
             "the first malformed message is named");
}

}  // namespace
}  // namespace palp::record

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = palp::fuzz::as_bytes(data, size);
  const auto report = palp::record::file_laws(file);
  if (size > 0) palp::record::cut_laws(file, report);
  palp::record::session_laws(file);
  return 0;
}
