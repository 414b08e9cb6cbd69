#include "common/record/mcap_writer.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace palp::record {
namespace {

/// Opcode, length, channel, sequence and both times of a message.
constexpr std::size_t kMessagePrefixSize = kMcapPrefixSize + 2 + 4 + 8 + 8;

template <class T>
std::byte* store(std::byte* at, T value) noexcept {
  std::memcpy(at, &value, sizeof value);
  return at + sizeof value;
}

}  // namespace

void McapWriter::TimeSpan::add(std::uint64_t time) noexcept {
  begin = empty ? time : std::min(begin, time);
  end = empty ? time : std::max(end, time);
  empty = false;
}

McapWriter::McapWriter(ByteSink& sink, const McapOptions& options)
    : sink_{sink},
      options_{options},
      compressor_{options.zstd_level},
      chunk_indexes_{sink.on_disk()} {
  waiting_.reserve(options_.chunk_size_max + options_.chunk_size_max / 4);
  if (sink.on_disk() && options_.compression == McapCompression::Zstd) {
    // A chunk of the largest size, once: what memory it takes is taken before the session.
    waiting_.resize(options_.chunk_size_max);
    (void)compressor_.compress(waiting_, output_);
    waiting_.clear();
    output_.clear();
  }
  Bytes head{kMcapMagic.begin(), kMcapMagic.end()};
  {
    const RecordScope header{head, McapOpcode::Header};
    append(head, options_.profile);
    append(head, options_.library);
  }
  put(head);
}

McapWriter::~McapWriter() { close(); }

Bytes& McapWriter::definitions_target() {
  if (options_.definitions_in_chunks) {
    return waiting_;
  }
  flush();
  output_.clear();
  return output_;
}

std::uint16_t McapWriter::add_schema(std::string_view name,
                                     std::string_view encoding,
                                     std::span<const std::byte> data) {
  const auto id = static_cast<std::uint16_t>(++schema_count_);
  const std::size_t at = schema_records_.size();
  {
    const RecordScope schema{schema_records_, McapOpcode::Schema};
    append(schema_records_, id);
    append(schema_records_, name);
    append(schema_records_, encoding);
    append(schema_records_, static_cast<std::uint32_t>(data.size()));
    append(schema_records_, data);
  }
  append(definitions_target(), std::span{schema_records_}.subspan(at));
  if (!options_.definitions_in_chunks) {
    put(output_);
  }
  return id;
}

std::uint16_t McapWriter::add_channel(std::uint16_t schema,
                                      std::string_view topic,
                                      std::string_view message_encoding,
                                      const McapMap& metadata) {
  channels_.emplace_back();
  const auto id = static_cast<std::uint16_t>(channels_.size());
  const std::size_t at = channel_records_.size();
  {
    const RecordScope channel{channel_records_, McapOpcode::Channel};
    append(channel_records_, id);
    append(channel_records_, schema);
    append(channel_records_, topic);
    append(channel_records_, message_encoding);
    append(channel_records_, metadata);
  }
  append(definitions_target(), std::span{channel_records_}.subspan(at));
  if (!options_.definitions_in_chunks) {
    put(output_);
  }
  return id;
}

void McapWriter::add_attachment(const McapAttachment& one) {
  flush();
  const std::uint64_t offset = counts_.bytes;
  output_.clear();
  {
    const RecordScope attachment{output_, McapOpcode::Attachment};
    append(output_, one.log_time);
    append(output_, one.create_time);
    append(output_, one.name);
    append(output_, one.media_type);
    append(output_, std::uint64_t{one.data.size()});
  }
  std::uint32_t crc = crc32(std::span{output_}.subspan(kMcapPrefixSize));
  const std::uint64_t length = output_.size() + one.data.size() + sizeof crc;
  const std::uint64_t content = length - kMcapPrefixSize;
  std::memcpy(output_.data() + kMcapPrefixSize - sizeof content, &content, sizeof content);
  // One write, unless it is longer than a piece.
  one.data.in_pieces([&](std::span<const std::byte> piece) {
    crc = crc32(piece, crc);
    append(output_, piece);
    if (output_.size() < FileBytes::kPieceSize) return;
    put(output_);
    output_.clear();
  });
  append(output_, crc);
  put(output_);
  ++attachment_count_;
  const RecordScope index{attachment_indexes_, McapOpcode::AttachmentIndex};
  append(attachment_indexes_, offset);
  append(attachment_indexes_, length);
  append(attachment_indexes_, one.log_time);
  append(attachment_indexes_, one.create_time);
  append(attachment_indexes_, std::uint64_t{one.data.size()});
  append(attachment_indexes_, one.name);
  append(attachment_indexes_, one.media_type);
}

void McapWriter::add_metadata(std::string_view name, const McapMap& entries) {
  flush();
  const std::uint64_t offset = counts_.bytes;
  output_.clear();
  {
    const RecordScope metadata{output_, McapOpcode::Metadata};
    append(output_, name);
    append(output_, entries);
  }
  const std::uint64_t length = output_.size();
  put(output_);
  ++metadata_count_;
  const RecordScope index{metadata_indexes_, McapOpcode::MetadataIndex};
  append(metadata_indexes_, offset);
  append(metadata_indexes_, length);
  append(metadata_indexes_, name);
}

std::byte* McapWriter::add_message(const McapStamp& stamp, std::size_t payload_size) {
  if (waiting_.size() + kMessagePrefixSize + payload_size > options_.chunk_size_max) {
    flush();
  } else {
    flush_if_due(stamp.log_time);
  }
  if (failed_ || closed_ || stamp.channel == 0 || stamp.channel > channels_.size()) {
    ++counts_.lost;
    return nullptr;
  }
  const std::size_t at = waiting_.size();
  waiting_.resize(at + kMessagePrefixSize + payload_size);
  std::byte* place = waiting_.data() + at;
  place = store(place, McapOpcode::Message);
  place = store(place, std::uint64_t{kMessagePrefixSize - kMcapPrefixSize + payload_size});
  place = store(place, stamp.channel);
  place = store(place, stamp.sequence);
  place = store(place, stamp.log_time);
  place = store(place, stamp.publish_time);
  Channel& channel = channels_[stamp.channel - 1u];
  channel.waiting.push_back({.log_time = stamp.log_time, .offset = at});
  waiting_span_.add(stamp.log_time);
  ++waiting_messages_;
  ++counts_.messages;
  return place;
}

void McapWriter::flush_if_due(std::uint64_t log_time) {
  const auto span_max = static_cast<std::uint64_t>(options_.chunk_span_max.count());
  if (!waiting_span_.empty && log_time > waiting_span_.begin &&
      log_time - waiting_span_.begin >= span_max) {
    flush();
  }
}

void McapWriter::flush() {
  if (waiting_.empty() || failed_) {
    return;
  }
  if (options_.chunks) {
    flush_chunk();
  } else {
    put(waiting_);
  }
  if (failed_) {
    counts_.messages -= waiting_messages_;
    counts_.lost += waiting_messages_;
  } else {
    for (Channel& channel : channels_) {
      channel.messages += channel.waiting.size();
    }
    if (!waiting_span_.empty) {
      span_.add(waiting_span_.begin);
      span_.add(waiting_span_.end);
    }
  }
  forget_waiting();
}

void McapWriter::flush_chunk() {
  const bool zstd = options_.compression == McapCompression::Zstd;
  output_.clear();
  {
    const RecordScope chunk{output_, McapOpcode::Chunk};
    append(output_, waiting_span_.begin);
    append(output_, waiting_span_.end);
    append(output_, std::uint64_t{waiting_.size()});
    append(output_, crc32(waiting_));
    append(output_, std::string_view{zstd ? "zstd" : ""});
    append(output_, std::uint64_t{0});
    const std::size_t records_at = output_.size();
    if (!zstd) {
      append(output_, waiting_);
    } else if (!compressor_.compress(waiting_, output_)) {
      failed_ = true;
      return;
    }
    const std::uint64_t size = output_.size() - records_at;
    std::memcpy(output_.data() + records_at - sizeof size, &size, sizeof size);
  }
  append_message_indexes(counts_.bytes, output_.size());
  put(output_);
  ++counts_.chunks;
}

void McapWriter::append_message_indexes(std::uint64_t chunk_offset, std::uint64_t chunk_size) {
  const bool zstd = options_.compression == McapCompression::Zstd;
  // Before its records stand 9 + 4 * 8 + 4 + string bytes of the chunk.
  const std::uint64_t compressed_size = chunk_size - kMcapPrefixSize - 40 - (zstd ? 4 : 0);
  Bytes offsets;
  if (options_.message_index) {
    for (std::size_t id = 1; id <= channels_.size(); ++id) {
      const auto& waiting = channels_[id - 1].waiting;
      if (waiting.empty()) {
        continue;
      }
      append(offsets, static_cast<std::uint16_t>(id));
      append(offsets, chunk_offset + output_.size());
      const RecordScope index{output_, McapOpcode::MessageIndex};
      append(output_, static_cast<std::uint16_t>(id));
      append(output_, static_cast<std::uint32_t>(waiting.size() * sizeof(IndexEntry)));
      append(output_, std::as_bytes(std::span{waiting}));
    }
  }
  Bytes& indexes = chunk_indexes_.newest();
  {
    const RecordScope index{indexes, McapOpcode::ChunkIndex};
    append(indexes, waiting_span_.begin);
    append(indexes, waiting_span_.end);
    append(indexes, chunk_offset);
    append(indexes, chunk_size);
    append(indexes, static_cast<std::uint32_t>(offsets.size()));
    append(indexes, offsets);
    append(indexes, std::uint64_t{output_.size() - chunk_size});
    append(indexes, std::string_view{zstd ? "zstd" : ""});
    append(indexes, compressed_size);
    append(indexes, std::uint64_t{waiting_.size()});
  }
  chunk_indexes_.settle();
}

void McapWriter::forget_waiting() {
  for (Channel& channel : channels_) {
    channel.waiting.clear();
  }
  waiting_.clear();
  waiting_messages_ = 0;
  waiting_span_ = {};
}

void McapWriter::put(std::span<const std::byte> bytes) {
  if (failed_ || closed_) {
    return;
  }
  data_crc_ = crc32(bytes, data_crc_);
  counts_.bytes += bytes.size();
  failed_ = !sink_.write(bytes);
}

void McapWriter::append_statistics(Bytes& out) const {
  const RecordScope statistics{out, McapOpcode::Statistics};
  append(out, counts_.messages);
  append(out, schema_count_);
  append(out, static_cast<std::uint32_t>(channels_.size()));
  append(out, attachment_count_);
  append(out, metadata_count_);
  append(out, static_cast<std::uint32_t>(counts_.chunks));
  append(out, span_.begin);
  append(out, span_.end);
  Bytes per_channel;
  for (std::size_t id = 1; id <= channels_.size(); ++id) {
    if (channels_[id - 1].messages > 0) {
      append(per_channel, static_cast<std::uint16_t>(id));
      append(per_channel, channels_[id - 1].messages);
    }
  }
  append(out, static_cast<std::uint32_t>(per_channel.size()));
  append(out, per_channel);
}

void McapWriter::close() {
  flush();
  if (!closed_ && !failed_) {
    write_summary();
  }
  closed_ = true;
}

void McapWriter::write_summary() {
  output_.clear();
  {
    const RecordScope data_end{output_, McapOpcode::DataEnd};
    append(output_, data_crc_);
  }
  put(output_);

  const std::uint64_t summary_at = counts_.bytes;
  Bytes statistics;
  if (options_.statistics) {
    append_statistics(statistics);
  }
  const Bytes chunk_indexes = chunk_indexes_.all();
  struct Group {
    McapOpcode opcode{};
    bool wanted{};
    const Bytes& records;
  };
  const std::array groups{
      Group{McapOpcode::Schema, options_.repeated_schemas, schema_records_},
      Group{McapOpcode::Channel, options_.repeated_channels, channel_records_},
      Group{McapOpcode::Statistics, options_.statistics, statistics},
      Group{McapOpcode::ChunkIndex, options_.chunk_index && options_.chunks, chunk_indexes},
      Group{McapOpcode::AttachmentIndex, options_.attachment_index, attachment_indexes_},
      Group{McapOpcode::MetadataIndex, options_.metadata_index, metadata_indexes_}};
  output_.clear();
  Bytes offsets;
  for (const Group& group : groups) {
    if (!group.wanted || group.records.empty()) {
      continue;
    }
    const RecordScope offset{offsets, McapOpcode::SummaryOffset};
    append(offsets, static_cast<std::uint8_t>(group.opcode));
    append(offsets, summary_at + output_.size());
    append(offsets, std::uint64_t{group.records.size()});
    append(output_, group.records);
  }
  const std::uint64_t offsets_at = summary_at + output_.size();
  const bool summary = !output_.empty();
  const bool summary_offsets = options_.summary_offsets && !offsets.empty();
  if (summary_offsets) {
    append(output_, offsets);
  }
  append(output_, static_cast<std::uint8_t>(McapOpcode::Footer));
  append(output_, std::uint64_t{kMcapFooterSize});
  append(output_, summary ? summary_at : std::uint64_t{0});
  append(output_, summary_offsets ? offsets_at : std::uint64_t{0});
  append(output_, crc32(output_));
  append(output_, std::span<const std::byte>{kMcapMagic});
  put(output_);
}

}  // namespace palp::record
