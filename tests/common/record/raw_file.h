#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "common/record/mcap_writer.h"

namespace palp::record::test {

/// A file of hand-made records behind the magic and a header.
class RawFile {
 public:
  RawFile() : bytes_{kMcapMagic.begin(), kMcapMagic.end()} {
    const RecordScope header{bytes_, McapOpcode::Header};
    append(bytes_, std::string_view{});
    append(bytes_, std::string_view{});
  }
  template <class Fill>
  RawFile& add(McapOpcode opcode, Fill fill) {
    const RecordScope record{bytes_, opcode};
    fill(bytes_);
    return *this;
  }
  RawFile& add_channel(std::uint16_t id, std::uint16_t schema, std::string_view topic = "topic") {
    return add(McapOpcode::Channel, [&](Bytes& out) {
      append(out, id);
      append(out, schema);
      append(out, topic);
      append(out, std::string_view{});
      append(out, McapMap{});
    });
  }
  RawFile& add_message(std::uint16_t channel) {
    return add(McapOpcode::Message, [&](Bytes& out) {
      append(out, channel);
      append(out, std::uint32_t{0});
      append(out, std::uint64_t{0});
      append(out, std::uint64_t{0});
    });
  }
  RawFile& add_chunk(std::uint64_t size, std::string_view compression, const Bytes& records) {
    return add(McapOpcode::Chunk, [&](Bytes& out) {
      append(out, std::uint64_t{0});
      append(out, std::uint64_t{0});
      append(out, size);
      append(out, std::uint32_t{0});
      append(out, compression);
      append(out, std::uint64_t{records.size()});
      append(out, records);
    });
  }
  /// Of the channel 1, with one entry per pair of log time and offset.
  RawFile& add_message_index(const std::vector<std::uint64_t>& times_and_offsets) {
    return add(McapOpcode::MessageIndex, [&](Bytes& out) {
      append(out, std::uint16_t{1});
      append(out, static_cast<std::uint32_t>(8 * times_and_offsets.size()));
      for (const std::uint64_t value : times_and_offsets) {
        append(out, value);
      }
    });
  }
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  Bytes bytes_;
};

}  // namespace palp::record::test
