#include "review/recover.h"

#include <map>

#include "common/core/printable.h"
#include "common/record/mcap_writer.h"
#include "common/record/sequence_count.h"
#include "common/record/wall_clock.h"
#include "review/copied_channels.h"
#include "review/lack.h"

namespace palp::review {
namespace {

/// Copies items one by one, and counts what is missing between them.
class Copy {
 public:
  explicit Copy(record::ByteSink& out) : writer_{out, {.library = "palp-review recover"}} {}

  Copy(const Copy&) = delete;
  Copy& operator=(const Copy&) = delete;

  void operator()(const record::McapSchema& schema) { channels_.add(schema); }
  void operator()(const record::McapChannel& channel) { channels_.add(channel); }
  void operator()(const record::McapMessage& message) {
    channels_.add(message, message.log_time, message.publish_time);
    count_gap(message);
  }
  void operator()(const record::McapAttachment& attachment) { writer_.add_attachment(attachment); }
  void operator()(const record::McapMetadata& metadata) {
    writer_.add_metadata(metadata.name, metadata.entries);
  }
  void operator()(const record::McapStatistics&) {}

  record::McapWriter& writer() { return writer_; }
  [[nodiscard]] const std::map<std::string, TopicLoss>& losses() const { return losses_; }

 private:
  struct Seen {
    record::SequenceCount sequence;
    std::uint64_t log_time{};  ///< [ns], of the newest
  };

  void count_gap(const record::McapMessage& message) {
    Seen& seen = seen_[message.channel->id];
    const std::uint64_t before = seen.sequence.missing();
    seen.sequence.see(message.sequence);
    const std::uint64_t missing = seen.sequence.missing();
    if (missing > 0 || seen.sequence.disordered() > 0) {
      TopicLoss& loss = losses_[message.channel->topic];
      if (before == 0 && missing > 0) loss.after = seen.log_time;
      loss.messages = missing;
      loss.disordered = seen.sequence.disordered();
    }
    seen.log_time = message.log_time;
  }

  record::McapWriter writer_;
  CopiedChannels channels_{writer_};
  std::map<std::uint16_t, Seen> seen_;
  std::map<std::string, TopicLoss> losses_;
};

}  // namespace

bool holds_message(const record::FileBytes& file) {
  record::McapReader reader{file};
  while (const auto item = reader.next()) {
    if (std::holds_alternative<record::McapMessage>(*item)) return true;
  }
  return false;
}

Result<Recovery> recover(const record::FileBytes& file, record::ByteSink& out) {
  record::McapReader reader{file};
  Copy copy{out};
  while (const auto item = reader.next()) {
    std::visit(copy, *item);
  }
  const record::McapReadReport& report = reader.report();
  copy.writer().add_metadata(kRecoveredRecord,
                             {{"was_closed", report.closed ? "yes" : "no"},
                              {"chunks_damaged", std::to_string(report.chunks_damaged)},
                              {"bytes_unread", std::to_string(report.bytes_unread)},
                              {"faults", std::to_string(report.fault_count)}});
  copy.writer().close();
  if (copy.writer().failed()) {
    return fail("the recovered file could not be written whole: is the disk full?");
  }
  return Recovery{
      .report = report, .messages = copy.writer().counts().messages, .losses = copy.losses()};
}

std::string describe(const Recovery& recovery) {
  const record::McapReadReport& report = recovery.report;
  std::string text{std::to_string(recovery.messages) + " messages saved, the last one at " +
                   record::utc_text(report.last_log_time) + "\n"};
  text += report.closed ? "the file was closed in order\n"
                        : "the file was not closed; what came after the last message is lost, " +
                              std::to_string(report.bytes_unread) + " bytes of it are there\n";
  for (const record::McapFault& fault : report.faults) {
    text += "fault at byte " + std::to_string(fault.offset) + ": " + fault.text + '\n';
  }
  for (const auto& [topic, loss] : recovery.losses) {
    if (loss.messages > 0) {
      text += printable(topic) + ": " + std::to_string(loss.messages) +
              " messages lost, first after " + record::utc_text(loss.after) + "\n";
    }
    if (loss.disordered > 0) {
      text += printable(topic) + ": " + std::to_string(loss.disordered) +
              " messages twice or not in their order\n";
    }
  }
  return text;
}

}  // namespace palp::review
