#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/time.h"
#include "common/record/byte_sink.h"
#include "common/record/index_store.h"
#include "common/record/mcap_compression.h"
#include "common/record/mcap_format.h"

namespace palp::record {

enum class McapCompression : std::uint8_t { None, Zstd };

/// What a file contains besides its messages. The defaults are those of a session file; switching
/// parts off is for the public conformance cases.
struct McapOptions {
  std::string profile{};
  std::string library{"palp"};
  McapCompression compression{McapCompression::Zstd};
  int zstd_level{9};  ///< 4 % smaller than 3 for 2.5 ms of work in a second
  std::size_t chunk_size_max{std::size_t{512} * 1024};      ///< [bytes], uncompressed
  Duration chunk_span_max{std::chrono::milliseconds{500}};  ///< a kill loses at most this much
  bool chunks{true};
  /// Schemas and channels inside chunks; else before them, where no damaged chunk takes them along.
  bool definitions_in_chunks{false};
  bool message_index{true};
  bool chunk_index{true};
  bool attachment_index{true};
  bool metadata_index{true};
  bool statistics{true};
  bool repeated_schemas{true};
  bool repeated_channels{true};
  bool summary_offsets{true};
};

struct McapStamp {
  std::uint16_t channel{};
  std::uint32_t sequence{};
  std::uint64_t log_time{};      ///< [ns]
  std::uint64_t publish_time{};  ///< [ns]
  bool operator==(const McapStamp&) const = default;
};

struct McapWriterCounts {
  std::uint64_t messages{};  ///< in the file, or in the chunk that is being filled
  std::uint64_t lost{};      ///< refused, or in a chunk that could not be written
  std::uint64_t chunks{};
  std::uint64_t bytes{};
};

/// Writes one MCAP file, append-only: whole chunks with their indexes, the summary on close().
/// When the sink refuses bytes the recording ends: everything later is counted as lost, nothing
/// throws. Thread: one, never rt. The sink outlives the writer.
class McapWriter {
 public:
  McapWriter(ByteSink& sink, const McapOptions& options);
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// @returns the new id, 1, 2, ...
  std::uint16_t add_schema(std::string_view name,
                           std::string_view encoding,
                           std::span<const std::byte> data);
  /// @returns the new id, 1, 2, ...
  std::uint16_t add_channel(std::uint16_t schema,
                            std::string_view topic,
                            std::string_view message_encoding,
                            const McapMap& metadata = {});
  void add_attachment(const McapAttachment& one);
  void add_metadata(std::string_view name, const McapMap& entries);

  /// Room for the payload of a new message, in the chunk itself: fill all of it at once, it is
  /// gone with the next call. nullptr: the recording has ended; counted as lost.
  std::byte* add_message(const McapStamp& stamp, std::size_t payload_size);

  /// Writes what is waiting: one write to the sink.
  void flush();
  /// The same, if the oldest waiting message was logged `chunk_span_max` before `log_time` [ns].
  void flush_if_due(std::uint64_t log_time);
  /// Flushes, writes summary and footer. Later calls do nothing; the destructor calls it.
  void close();

  [[nodiscard]] bool failed() const noexcept { return failed_; }
  [[nodiscard]] const McapWriterCounts& counts() const noexcept { return counts_; }
  /// Messages of the chunk being filled: lost if it cannot be written.
  [[nodiscard]] std::uint64_t waiting() const noexcept { return waiting_messages_; }

 private:
  struct IndexEntry {
    std::uint64_t log_time{};  ///< [ns]
    std::uint64_t offset{};    ///< within the uncompressed records
  };
  struct Channel {
    std::uint64_t messages{};
    std::vector<IndexEntry> waiting;  ///< messages of the chunk being filled
  };
  struct TimeSpan {
    std::uint64_t begin{};  ///< [ns]
    std::uint64_t end{};    ///< [ns]
    bool empty{true};
    void add(std::uint64_t time) noexcept;
  };

  [[nodiscard]] Bytes& definitions_target();
  void put(std::span<const std::byte> bytes);
  void flush_chunk();
  void append_message_indexes(std::uint64_t chunk_offset, std::uint64_t chunk_size);
  void forget_waiting();
  void append_statistics(Bytes& out) const;
  void write_summary();

  ByteSink& sink_;
  McapOptions options_;
  ChunkCompressor compressor_;
  Bytes waiting_;  ///< records of the chunk being filled
  std::uint64_t waiting_messages_{};
  TimeSpan waiting_span_;
  Bytes output_;                   ///< of one flush
  std::vector<Channel> channels_;  ///< id 1 first
  Bytes schema_records_;           ///< kept for the summary, as are the following
  Bytes channel_records_;
  IndexStore chunk_indexes_;
  Bytes attachment_indexes_;
  Bytes metadata_indexes_;
  std::uint16_t schema_count_{};
  std::uint32_t attachment_count_{};
  std::uint32_t metadata_count_{};
  TimeSpan span_;
  std::uint32_t data_crc_{};
  McapWriterCounts counts_;
  bool failed_{};
  bool closed_{};
};

}  // namespace palp::record
