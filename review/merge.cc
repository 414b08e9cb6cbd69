#include "review/merge.h"

#include <optional>
#include <string>

#include "common/config/number.h"
#include "common/record/mcap_reader.h"
#include "common/record/mcap_writer.h"
#include "review/copied_channels.h"

namespace palp::review {
namespace {

/// One of the files on its way into the new one; knows its next message.
class MergeSource {
 public:
  MergeSource(const record::FileBytes& file, std::string site, record::McapWriter& writer)
      : reader_{file}, site_{std::move(site)}, writer_{writer} {}
  MergeSource(const MergeSource&) = delete;
  MergeSource& operator=(const MergeSource&) = delete;

  /// `stamp`: of the file's stamp, on the common line.
  void advance(const auto& stamp) {
    message_.reset();
    while (!message_) {
      auto item = reader_.next();
      if (!item) return;
      std::visit([this](const auto& one) { this->take(one); }, *item);
    }
    at_ = stamp(message_->publish_time);
  }
  [[nodiscard]] bool done() const { return !message_; }
  [[nodiscard]] std::uint64_t at() const { return at_; }  ///< [ns], common line
  void write() { channels_.add(*message_, at_, at_); }

 private:
  void take(const record::McapSchema& schema) { channels_.add(schema); }
  void take(const record::McapChannel& channel) { channels_.add(channel); }
  void take(const record::McapMessage& message) { message_ = message; }
  void take(record::McapAttachment attachment) {
    const std::string name = site_ + '/' + std::string{attachment.name};
    attachment.name = name;
    writer_.add_attachment(attachment);
  }
  void take(const record::McapMetadata& metadata) {
    writer_.add_metadata(site_ + '/' + std::string{metadata.name}, metadata.entries);
  }
  void take(const record::McapStatistics& /*statistics*/) {}

  record::McapReader reader_;
  std::string site_;
  record::McapWriter& writer_;
  CopiedChannels channels_{writer_};
  std::optional<record::McapMessage> message_;
  std::uint64_t at_{};
};

record::McapMap description_of(const SessionPair& session) {
  const TimeLine& line = session.time_line;
  return {{"session_id", session.session_id},
          {"time_line", "surgeon"},
          {"offset_source", line.source},
          {"patient_minus_surgeon_ns", std::to_string(line.offset.count())},
          {"skew_s_per_s", config::number_text(line.skew)},
          {"uncertainty_ns", line.known ? std::to_string(line.uncertainty.count()) : "unknown"}};
}

}  // namespace

Result<std::uint64_t> merge_files(const PairBytes& files,
                                  const SessionPair& session,
                                  record::ByteSink& out) {
  record::McapWriter writer{out, {.library = "palp-review merge"}};
  writer.add_metadata("palp.merge", description_of(session));
  const record::WallClock& wall = session.surgeon.clock;
  const auto as_is = [](std::uint64_t stamp) { return stamp; };
  const auto moved = [&](std::uint64_t stamp) {
    return wall.stamp(session.time_line.surgeons(session.patient.clock.own(stamp)));
  };
  MergeSource surgeon{files.surgeon, "surgeon", writer};
  MergeSource patient{files.patient, "patient", writer};
  surgeon.advance(as_is);
  patient.advance(moved);
  while (!surgeon.done() || !patient.done()) {
    if (patient.done() || (!surgeon.done() && surgeon.at() <= patient.at())) {
      surgeon.write();
      surgeon.advance(as_is);
    } else {
      patient.write();
      patient.advance(moved);
    }
  }
  writer.close();
  if (writer.failed()) return fail("the new file could not be written whole: is the disk full?");
  return writer.counts().messages;
}

}  // namespace palp::review
