#pragma once

#include <cstdint>
#include <cstring>
#include <map>

#include "common/record/mcap_reader.h"
#include "common/record/mcap_writer.h"

namespace palp::review {

/// A file's schemas, channels and messages on their way into another file, where their ids may be
/// others.
class CopiedChannels {
 public:
  /// `writer` outlives it.
  explicit CopiedChannels(record::McapWriter& writer) : writer_{writer} {}

  void add(const record::McapSchema& schema) {
    schemas_[schema.id] = writer_.add_schema(schema.name, schema.encoding, schema.data);
  }
  /// Its schema was added before.
  void add(const record::McapChannel& channel) {
    const std::uint16_t schema = channel.schema == 0 ? std::uint16_t{0} : schemas_[channel.schema];
    channels_[channel.id] =
        writer_.add_channel(schema, channel.topic, channel.message_encoding, channel.metadata);
  }
  /// Its channel was added before. The stamps are the new file's. [ns]
  void add(const record::McapMessage& message, std::uint64_t log_time, std::uint64_t publish_time) {
    std::byte* place = writer_.add_message({.channel = channels_[message.channel->id],
                                            .sequence = message.sequence,
                                            .log_time = log_time,
                                            .publish_time = publish_time},
                                           message.payload.size());
    if (place != nullptr && !message.payload.empty()) {
      std::memcpy(place, message.payload.data(), message.payload.size());
    }
  }

 private:
  record::McapWriter& writer_;
  std::map<std::uint16_t, std::uint16_t> schemas_;   ///< old id to new
  std::map<std::uint16_t, std::uint16_t> channels_;  ///< old id to new
};

}  // namespace palp::review
