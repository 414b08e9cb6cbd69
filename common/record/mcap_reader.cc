#include "common/record/mcap_reader.h"

#include <algorithm>
#include <utility>

namespace palp::record {
namespace {

/// Kinds of record that stand before DataEnd only.
bool is_data(McapOpcode opcode) noexcept {
  switch (opcode) {
    case McapOpcode::Message:
    case McapOpcode::Chunk:
    case McapOpcode::MessageIndex:
    case McapOpcode::Attachment:
    case McapOpcode::Metadata:
    case McapOpcode::DataEnd:
      return true;
    default:
      return false;
  }
}

}  // namespace

McapReader::McapReader(const FileBytes& file, const McapLimits& limits)
    : mapping_{file}, file_{file}, limits_{limits}, decompressor_{limits.chunk_size_max} {
  const std::size_t shared = std::min(file_.size(), kMcapMagic.size());
  if (!std::equal(kMcapMagic.begin(), kMcapMagic.begin() + shared, file_.begin())) {
    fault(0, "this is not an MCAP file: its first bytes are others");
    ended_ = true;
  }
  offset_ = shared;
  ended_ = ended_ || shared < kMcapMagic.size();
}

std::optional<McapItem> McapReader::next() {
  while (true) {
    if (chunk_offset_ < chunk_.size()) {
      if (auto item = next_in_chunk()) {
        return item;
      }
      continue;
    }
    if (ended_) {
      return std::nullopt;
    }
    if (auto item = next_in_file()) {
      return item;
    }
  }
}

std::optional<McapReader::RawRecord> McapReader::cut_record(std::span<const std::byte> bytes,
                                                            std::size_t& offset) {
  ByteCursor cursor{bytes.subspan(offset)};
  RawRecord record;
  record.offset = offset;
  record.opcode = static_cast<McapOpcode>(cursor.read<std::uint8_t>());
  record.content = cursor.take(cursor.read<std::uint64_t>());
  if (!cursor.ok()) {
    return std::nullopt;
  }
  offset += kMcapPrefixSize + record.content.size();
  return record;
}

std::optional<McapItem> McapReader::next_in_chunk() {
  auto record = cut_record(chunk_, chunk_offset_);
  if (!record) {
    fault(chunk_at_, "a record of this chunk reaches beyond its end");
    ++report_.chunks_damaged;
    chunk_offset_ = chunk_.size();
    return std::nullopt;
  }
  record->offset = chunk_at_;
  switch (record->opcode) {
    case McapOpcode::Schema:
      return read_schema(*record);
    case McapOpcode::Channel:
      return read_channel(*record);
    case McapOpcode::Message: {
      auto item = read_message(*record);
      if (item) {
        const auto& message = std::get<McapMessage>(*item);
        ++chunk_messages_[message.channel->id];
        check_time(message.log_time);
      }
      return item;
    }
    default:
      if (record->opcode <= McapOpcode::DataEnd) {
        fault(chunk_at_, "a record inside this chunk is of a kind that may not stand there");
      }
      return std::nullopt;  // unknown opcodes are skipped: later versions may have more
  }
}

/// Who looks for a span of time would pass over such a chunk.
void McapReader::check_time(std::uint64_t log_time) {
  if (chunk_time_.wrong || (log_time >= chunk_time_.begin && log_time <= chunk_time_.end)) return;
  chunk_time_.wrong = true;
  fault(chunk_at_, "a message of this chunk lies outside of the time that the chunk states");
}

std::optional<McapItem> McapReader::next_in_file() {
  while (window_ && window_->next_gap < window_->gaps.size() &&
         window_->gaps[window_->next_gap].begin <= offset_) {
    const Gap& gap = window_->gaps[window_->next_gap++];
    if (gap.begin == offset_) offset_ = gap.end;
  }
  const auto record = cut_record(file_, offset_);
  if (!record) {
    report_.bytes_unread = file_.size() - offset_;
    ended_ = true;
    return std::nullopt;
  }
  leave_behind(record->offset);
  return interpret(*record);
}

void McapReader::leave_behind(std::uint64_t offset) {
  const auto read = static_cast<std::size_t>(offset) - read_up_to_;
  if (!window_) data_crc_ = crc32_in_pieces(mapping_.part(read_up_to_, read), data_crc_);
  read_up_to_ += read;
  if (read_up_to_ - forgotten_ < FileBytes::kPieceSize) return;
  mapping_.forget(forgotten_, read_up_to_);
  forgotten_ = read_up_to_;
}

std::optional<McapItem> McapReader::interpret(const RawRecord& record) {
  if (data_ended_ && is_data(record.opcode)) {
    fault(record.offset, "a record that holds data stands behind the end of the data");
    return std::nullopt;
  }
  switch (record.opcode) {
    case McapOpcode::Schema:
      return read_schema(record);
    case McapOpcode::Channel:
      return read_channel(record);
    case McapOpcode::Message:
      return read_message(record);
    case McapOpcode::Attachment:
      return read_attachment(record);
    case McapOpcode::Metadata:
      return read_metadata(record);
    case McapOpcode::Statistics:
      return read_statistics(record);
    case McapOpcode::Chunk:
      open_chunk(record);
      break;
    case McapOpcode::MessageIndex:
      check_message_index(record);
      break;
    case McapOpcode::ChunkIndex:
      check_chunk_index(record);
      break;
    case McapOpcode::DataEnd:
      check_data_end(record);
      break;
    case McapOpcode::Footer:
      check_footer(record);
      break;
    default:  // the header says nothing we need; indexes of attachments repeat what was read
      break;
  }
  return std::nullopt;
}

void McapReader::open_chunk(const RawRecord& record) {
  chunk_ = {};
  chunk_offset_ = 0;
  chunk_at_ = record.offset;
  chunk_time_.wrong = false;
  chunk_messages_.clear();
  if (chunk_places_.size() < limits_.chunk_places_max) {
    chunk_places_.push_back({record.offset, kMcapPrefixSize + record.content.size()});
  }
  ++report_.chunks;
  ByteCursor cursor{record.content};
  chunk_time_.begin = cursor.read<std::uint64_t>();
  chunk_time_.end = cursor.read<std::uint64_t>();
  const auto size = cursor.read<std::uint64_t>();
  const auto crc = cursor.read<std::uint32_t>();
  const auto compression = cursor.text();
  const auto bytes = cursor.take(cursor.read<std::uint64_t>());
  if (!cursor.ok()) {
    ++report_.chunks_damaged;
    fault(record.offset, "a field of this chunk reaches beyond its end");
    return;
  }
  if (passes_over(chunk_time_.begin, chunk_time_.end) || !admit_unpacked(record, size)) return;
  const auto answer = decompressor_.decompress(compression, bytes, size);
  const bool crc_wrong = answer.error.empty() && crc != 0 && crc32(answer.records) != crc;
  if (!answer.error.empty() || crc_wrong) {
    ++report_.chunks_damaged;
    fault(record.offset, "this chunk " + std::string{crc_wrong ? "has a wrong CRC" : answer.error});
    return;
  }
  chunk_ = answer.records;
}

bool McapReader::passes_over(std::uint64_t begin, std::uint64_t end) const noexcept {
  return window_ && (end < window_->from || begin > window_->to);
}

/// A file of a megabyte must not cost the work of one of thirty thousand.
bool McapReader::admit_unpacked(const RawRecord& record, std::uint64_t size) {
  if (size > limits_.chunk_size_max) return true;  // refused by itself
  unpacked_ += size;
  if (unpacked_ <= limits_.unpacked_size_free ||
      (unpacked_ - limits_.unpacked_size_free) / limits_.unpacked_ratio_max <= offset_) {
    return true;
  }
  ++report_.chunks_damaged;
  fault(record.offset,
        "here the file unpacks to more than " + std::to_string(limits_.unpacked_size_free >> 20U) +
            " MiB and " + std::to_string(limits_.unpacked_ratio_max) +
            " times its size; it is read no further");
  report_.bytes_unread = file_.size() - record.offset;
  ended_ = true;
  return false;
}

/// `so_far`: what is kept already; 0 asks before the record is taken apart.
bool McapReader::admit_definition(const RawRecord& record, std::uint64_t so_far) {
  if (so_far + record.content.size() <= limits_.definitions_size_max) return true;
  fault(record.offset, "schemas and channels take more bytes than the limit");
  return false;
}

std::optional<McapItem> McapReader::read_schema(const RawRecord& record) {
  if (!admit_definition(record, 0)) return std::nullopt;
  ByteCursor cursor{record.content};
  McapSchema schema;
  schema.id = cursor.read<std::uint16_t>();
  schema.name = cursor.text();
  schema.encoding = cursor.text();
  const auto data = cursor.take(cursor.read<std::uint32_t>());
  schema.data.assign(data.begin(), data.end());
  if (!cursor.ok() || schema.id == 0) {
    fault(record.offset, "this schema is broken: its id is 0 or a field does not fit");
    return std::nullopt;
  }
  if (schema.name.size() > limits_.name_size_max) {
    fault(record.offset, "the name of this schema is longer than the limit");
    return std::nullopt;
  }
  if (const auto known = schemas_.find(schema.id); known != schemas_.end()) {
    if (!(known->second == schema)) {
      fault(record.offset, "schema " + std::to_string(schema.id) + " is defined twice, unlike");
    }
    return std::nullopt;
  }
  if (!admit_definition(record, definitions_size_)) return std::nullopt;
  definitions_size_ += record.content.size();
  return schemas_.emplace(schema.id, std::move(schema)).first->second;
}

std::optional<McapItem> McapReader::read_channel(const RawRecord& record) {
  if (!admit_definition(record, 0)) return std::nullopt;
  ByteCursor cursor{record.content};
  McapChannel channel;
  channel.id = cursor.read<std::uint16_t>();
  channel.schema = cursor.read<std::uint16_t>();
  channel.topic = cursor.text();
  channel.message_encoding = cursor.text();
  channel.metadata = cursor.map();
  if (!cursor.ok()) {
    fault(record.offset, "a field of this channel reaches beyond its end");
    return std::nullopt;
  }
  if (channel.topic.size() > limits_.name_size_max) {
    fault(record.offset, "the topic of this channel is longer than the limit");
    return std::nullopt;
  }
  if (const auto known = channels_.find(channel.id); known != channels_.end()) {
    if (!(known->second == channel)) {
      fault(record.offset, "channel " + std::to_string(channel.id) + " is defined twice, unlike");
    }
    return std::nullopt;
  }
  if (channel.schema != 0 && !schemas_.contains(channel.schema)) {
    fault(record.offset,
          "channel " + channel.topic + " names schema " + std::to_string(channel.schema) +
              ", which is not there");
    return std::nullopt;
  }
  if (!admit_definition(record, definitions_size_)) return std::nullopt;
  definitions_size_ += record.content.size();
  return channels_.emplace(channel.id, std::move(channel)).first->second;
}

std::optional<McapItem> McapReader::read_message(const RawRecord& record) {
  if (record.content.size() > limits_.chunk_size_max) {
    fault(record.offset, "this message is longer than the limit");
    return std::nullopt;
  }
  ByteCursor cursor{record.content};
  McapMessage message;
  const auto id = cursor.read<std::uint16_t>();
  message.sequence = cursor.read<std::uint32_t>();
  message.log_time = cursor.read<std::uint64_t>();
  message.publish_time = cursor.read<std::uint64_t>();
  message.payload = cursor.rest();
  const auto channel = channels_.find(id);
  if (!cursor.ok() || channel == channels_.end()) {
    fault(record.offset,
          cursor.ok() ? "a message names channel " + std::to_string(id) + ", which is not there"
                      : "a message is too short");
    return std::nullopt;
  }
  message.channel = &channel->second;
  if (const auto schema = schemas_.find(message.channel->schema); schema != schemas_.end()) {
    message.schema = &schema->second;
  }
  ++report_.messages;
  ++messages_by_channel_[id];
  report_.last_log_time = std::max(report_.last_log_time, message.log_time);
  return message;
}

/// Who copies a file keeps these until its end.
bool McapReader::admit_names(const RawRecord& record, std::size_t size) {
  constexpr std::uint64_t kRecordSize = 64;
  if (names_size_ + kRecordSize + size <= limits_.names_size_max) {
    names_size_ += kRecordSize + size;
    return true;
  }
  fault(record.offset, "attachments and metadata records have more or longer names than the limit");
  return false;
}

std::optional<McapItem> McapReader::read_attachment(const RawRecord& record) {
  ByteCursor cursor{record.content};
  McapAttachment attachment;
  attachment.log_time = cursor.read<std::uint64_t>();
  attachment.create_time = cursor.read<std::uint64_t>();
  attachment.name = cursor.text();
  attachment.media_type = cursor.text();
  const auto size = cursor.read<std::uint64_t>();
  const std::size_t content = record.offset + kMcapPrefixSize;
  const std::size_t data = content + record.content.size() - cursor.rest().size();
  cursor.take(size);
  const auto crc = cursor.read<std::uint32_t>();
  if (!cursor.ok()) {
    fault(record.offset, "a field of this attachment reaches beyond its end");
    return std::nullopt;
  }
  if (!admit_names(record, attachment.name.size() + attachment.media_type.size())) {
    return std::nullopt;
  }
  attachment.data = mapping_.part(data, size);
  if (crc != 0 && crc != crc32_in_pieces(mapping_.part(content, data + size - content))) {
    fault(record.offset, "this attachment has a wrong CRC");
    return std::nullopt;
  }
  ++report_.attachments;
  return attachment;
}

std::optional<McapItem> McapReader::read_metadata(const RawRecord& record) {
  if (record.content.size() > limits_.metadata_size_max) {
    fault(record.offset, "this metadata record is longer than the limit");
    return std::nullopt;
  }
  ByteCursor cursor{record.content};
  McapMetadata metadata;
  metadata.name = cursor.text();
  metadata.entries = cursor.map();
  if (!cursor.ok()) {
    fault(record.offset, "a field of this metadata record reaches beyond its end");
    return std::nullopt;
  }
  if (!admit_names(record, metadata.name.size())) return std::nullopt;
  ++report_.metadata;
  return metadata;
}

void McapReader::fault(std::uint64_t offset, std::string text) {
  ++report_.fault_count;
  if (report_.faults.size() < limits_.faults_max) {
    report_.faults.push_back({offset, std::move(text)});
  }
}

}  // namespace palp::record
