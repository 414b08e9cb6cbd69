// Copies a session file with one number changed: change_sample IN OUT N given|decided
// In the N-th tick of the site: where its device said to be, or what the site decided. A replay
// must notice either.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string_view>
#include <variant>
#include <vector>

#include "common/message/log_bytes.h"
#include "common/record/byte_sink.h"
#include "common/record/mapped_file.h"
#include "common/record/mcap_reader.h"
#include "common/record/mcap_writer.h"

namespace palp::record {
namespace {

void change(SurgeonFileTick& tick, bool given) {
  (given ? tick.given.hand.position : tick.tick.command) += 1e-6;
}
void change(PatientFileTick& tick, bool given) {
  (given ? tick.given.stage.position : tick.tick.command) += 1e-6;
}

template <class FileTick>
Bytes changed(std::span<const std::byte> payload, bool given) {
  FileTick tick;
  if (!message::read_log(payload, tick) || !tick.gathered) return {};
  change(tick, given);
  std::array<std::byte, message::kLogMessageSizeMax> room{};
  const std::size_t size = message::write_log(tick, room);
  return {room.begin(), room.begin() + static_cast<std::ptrdiff_t>(size)};
}

class Copy {
 public:
  Copy(ByteSink& out, std::uint64_t number, bool given)
      : writer_{out, {}}, number_{number}, given_{given} {}

  void operator()(const McapSchema& schema) {
    schemas_[schema.id] = writer_.add_schema(schema.name, schema.encoding, schema.data);
  }
  void operator()(const McapChannel& channel) {
    channels_[channel.id] =
        writer_.add_channel(schemas_[channel.schema], channel.topic, channel.message_encoding);
  }
  void operator()(const McapMessage& message) {
    Bytes payload{message.payload.begin(), message.payload.end()};
    if (message.channel->topic.ends_with("/tick") && ++ticks_ == number_) {
      const bool surgeon = message.channel->topic.starts_with("surgeon");
      payload = surgeon ? changed<SurgeonFileTick>(payload, given_)
                        : changed<PatientFileTick>(payload, given_);
      done_ = !payload.empty();
    }
    std::byte* place = writer_.add_message({.channel = channels_[message.channel->id],
                                            .sequence = message.sequence,
                                            .log_time = message.log_time,
                                            .publish_time = message.publish_time},
                                           payload.size());
    if (place != nullptr && !payload.empty()) std::memcpy(place, payload.data(), payload.size());
  }
  void operator()(const McapAttachment& one) { writer_.add_attachment(one); }
  void operator()(const McapMetadata& one) { writer_.add_metadata(one.name, one.entries); }
  void operator()(const McapStatistics& /*one*/) {}

  /// @returns whether there was such a tick.
  bool finish() {
    writer_.close();
    return done_ && !writer_.failed();
  }

 private:
  McapWriter writer_;
  std::uint64_t number_;
  bool given_;
  bool done_{};
  std::uint64_t ticks_{};
  std::map<std::uint16_t, std::uint16_t> schemas_;   ///< old id to new
  std::map<std::uint16_t, std::uint16_t> channels_;  ///< old id to new
};

int run(const char* in, const char* out, std::uint64_t number, std::string_view what) {
  const auto file = MappedFile::open(in);
  auto sink = FileSink::create(out);
  if (!file || !sink) return 3;
  Copy copy{*sink, number, what == "given"};
  McapReader reader{file->bytes()};
  while (const auto item = reader.next()) std::visit(copy, *item);
  return copy.finish() ? 0 : 1;
}

}  // namespace
}  // namespace palp::record

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  return palp::record::run(argv[1], argv[2], std::strtoull(argv[3], nullptr, 10), argv[4]);
}
