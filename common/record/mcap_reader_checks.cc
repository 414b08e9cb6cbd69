// The part of McapReader that compares a file with what the file says of itself. A file without
// any of it is still read; nothing here changes which messages come out.
#include <algorithm>

#include "common/record/mcap_reader.h"

namespace palp::record {

void McapReader::only_between(std::uint64_t from, std::uint64_t to) {
  window_ = Window{from, to, {}, 0};
  find_chunks_to_pass_over();
}

/// By the index at the end of a file that was closed. An index that lies leads to what is no record
/// or is the wrong one, as any damage does.
void McapReader::find_chunks_to_pass_over() {
  std::vector<Gap>& gaps = window_->gaps;
  constexpr std::size_t kTail = kMcapPrefixSize + kMcapFooterSize + kMcapMagic.size();
  if (file_.size() < kTail) return;
  const std::size_t footer_at = file_.size() - kTail;
  std::size_t end = footer_at;
  const auto footer = cut_record(file_, end);
  if (!footer || footer->opcode != McapOpcode::Footer) return;
  std::size_t at = ByteCursor{footer->content}.read<std::uint64_t>();
  if (at == 0) return;
  while (at < footer_at && gaps.size() < limits_.chunk_places_max) {
    const auto record = cut_record(file_, at);
    if (!record || record->opcode == McapOpcode::Footer) return;
    if (record->opcode != McapOpcode::ChunkIndex) continue;
    ByteCursor cursor{record->content};
    const auto first = cursor.read<std::uint64_t>();
    const auto last = cursor.read<std::uint64_t>();
    const auto begin = cursor.read<std::uint64_t>();
    const auto chunk = cursor.read<std::uint64_t>();
    cursor.take(cursor.read<std::uint32_t>());
    const auto indexes = cursor.read<std::uint64_t>();
    const std::uint64_t before = gaps.empty() ? 0 : gaps.back().end;
    if (!cursor.ok() || begin < before || begin > footer_at || chunk > footer_at - begin ||
        indexes > footer_at - begin - chunk) {
      return;
    }
    if (passes_over(first, last)) gaps.push_back({begin, begin + chunk + indexes});
  }
}

void McapReader::check_message_index(const RawRecord& record) {
  ByteCursor cursor{record.content};
  const auto id = cursor.read<std::uint16_t>();
  ByteCursor entries{cursor.take(cursor.read<std::uint32_t>())};
  if (!cursor.ok()) {
    fault(record.offset, "a field of this message index reaches beyond its end");
    return;
  }
  if (chunk_.empty()) {
    return;  // of a damaged chunk
  }
  const auto seen = chunk_messages_.find(id);
  constexpr std::size_t kEntrySize = 16;
  if (entries.rest().size() != kEntrySize * (seen == chunk_messages_.end() ? 0 : seen->second)) {
    fault(record.offset, "this message index has not as many entries as its chunk has messages");
    return;
  }
  while (!entries.empty()) {
    const auto log_time = entries.read<std::uint64_t>();
    auto offset = static_cast<std::size_t>(entries.read<std::uint64_t>());
    std::optional<RawRecord> message;
    if (entries.ok() && offset < chunk_.size()) {
      message = cut_record(chunk_, offset);
    }
    ByteCursor fields{message ? message->content : std::span<const std::byte>{}};
    const bool channel_right = fields.read<std::uint16_t>() == id;
    fields.take(4);
    const bool time_right = fields.read<std::uint64_t>() == log_time;
    if (!message || message->opcode != McapOpcode::Message || !channel_right || !time_right) {
      fault(record.offset, "an entry of this message index points at no such message");
      return;
    }
  }
}

void McapReader::check_chunk_index(const RawRecord& record) {
  ByteCursor cursor{record.content};
  cursor.take(16);
  const auto offset = cursor.read<std::uint64_t>();
  const auto length = cursor.read<std::uint64_t>();
  const std::size_t number = chunk_indexes_++;
  if (window_) return;
  const bool kept = number < chunk_places_.size();
  if (!cursor.ok() || number >= report_.chunks ||
      (kept && !(chunk_places_[number] == ChunkPlace{offset, length}))) {
    fault(record.offset, "chunk index " + std::to_string(number) + " points at no such chunk");
  }
}

void McapReader::check_data_end(const RawRecord& record) {
  ByteCursor cursor{record.content};
  const auto crc = cursor.read<std::uint32_t>();
  if (!cursor.ok() || (crc != 0 && !window_ && crc != data_crc_)) {
    fault(record.offset, "the data section has a wrong CRC");
  }
  data_ended_ = true;
}

std::optional<McapItem> McapReader::read_statistics(const RawRecord& record) {
  if (record.content.size() > limits_.metadata_size_max) {
    fault(record.offset, "the statistics are longer than the limit");
    return std::nullopt;
  }
  ByteCursor cursor{record.content};
  McapStatistics statistics;
  statistics.messages = cursor.read<std::uint64_t>();
  statistics.schemas = cursor.read<std::uint16_t>();
  statistics.channels = cursor.read<std::uint32_t>();
  statistics.attachments = cursor.read<std::uint32_t>();
  statistics.metadata = cursor.read<std::uint32_t>();
  statistics.chunks = cursor.read<std::uint32_t>();
  statistics.begin = cursor.read<std::uint64_t>();
  statistics.end = cursor.read<std::uint64_t>();
  ByteCursor map{cursor.take(cursor.read<std::uint32_t>())};
  while (map.ok() && !map.empty()) {
    const auto channel = map.read<std::uint16_t>();
    statistics.channel_messages[channel] = map.read<std::uint64_t>();
  }
  if (!cursor.ok() || !map.ok()) {
    fault(record.offset, "a field of the statistics reaches beyond their end");
    return std::nullopt;
  }
  const bool partial = report_.chunks_damaged > 0 || window_;
  if (!partial &&
      (statistics.messages != report_.messages ||
       statistics.channel_messages != messages_by_channel_ || statistics.chunks != report_.chunks ||
       statistics.attachments != report_.attachments || statistics.metadata != report_.metadata)) {
    fault(record.offset,
          "the statistics speak of " + std::to_string(statistics.messages) + " messages in " +
              std::to_string(statistics.chunks) + " chunks, the file has " +
              std::to_string(report_.messages) + " in " + std::to_string(report_.chunks) +
              ", or other counts differ");
  }
  return statistics;
}

void McapReader::check_footer(const RawRecord& record) {
  ended_ = true;
  ByteCursor cursor{record.content};
  const auto summary_at = cursor.read<std::uint64_t>();
  const auto offsets_at = cursor.read<std::uint64_t>();
  const auto crc = cursor.read<std::uint32_t>();
  const auto rest = file_.subspan(offset_);
  if (!cursor.ok() || summary_at > record.offset || offsets_at > record.offset) {
    fault(record.offset, "the footer is broken: a field does not fit");
    return;
  }
  report_.closed = rest.size() >= kMcapMagic.size() &&
                   std::equal(kMcapMagic.begin(), kMcapMagic.end(), rest.begin());
  if (!report_.closed) {
    report_.bytes_unread = rest.size();
    return;
  }
  if (rest.size() > kMcapMagic.size()) {
    fault(record.offset, "bytes follow the closing magic");
  }
  if (!data_ended_) {
    fault(record.offset, "the record that ends the data section is missing");
  }
  const std::uint64_t summary_begin = summary_at == 0 ? record.offset : summary_at;
  const std::uint64_t covered =
      record.offset + kMcapPrefixSize + kMcapFooterSize - sizeof crc - summary_begin;
  if (crc != 0 && crc != crc32_in_pieces(mapping_.part(summary_begin, covered))) {
    fault(record.offset, "the summary has a wrong CRC");
  }
  if (!window_ && chunk_indexes_ != 0 && chunk_indexes_ != report_.chunks) {
    fault(record.offset,
          std::to_string(chunk_indexes_) + " chunk indexes stand for " +
              std::to_string(report_.chunks) + " chunks");
  }
}

}  // namespace palp::record
