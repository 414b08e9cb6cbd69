#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/record/file_bytes.h"
#include "common/record/mcap_compression.h"
#include "common/record/mcap_format.h"

namespace palp::record {

struct McapSchema {
  std::uint16_t id{};
  std::string name;
  std::string encoding;
  Bytes data;
  bool operator==(const McapSchema&) const = default;
};

struct McapChannel {
  std::uint16_t id{};
  std::uint16_t schema{};  ///< 0: none
  std::string topic;
  std::string message_encoding;
  McapMap metadata;
  bool operator==(const McapChannel&) const = default;
};

/// Pointers and payload are valid until the next call of next(); the definitions stay.
struct McapMessage {
  const McapChannel* channel{};  ///< never null
  const McapSchema* schema{};    ///< nullptr: the channel has none
  std::uint32_t sequence{};
  std::uint64_t log_time{};      ///< [ns]
  std::uint64_t publish_time{};  ///< [ns]
  std::span<const std::byte> payload;
};

struct McapMetadata {
  std::string_view name;
  McapMap entries;
};

struct McapStatistics {
  std::uint64_t messages{};
  std::uint16_t schemas{};
  std::uint32_t channels{};
  std::uint32_t attachments{};
  std::uint32_t metadata{};
  std::uint32_t chunks{};
  std::uint64_t begin{};  ///< [ns]
  std::uint64_t end{};    ///< [ns]
  std::map<std::uint16_t, std::uint64_t> channel_messages;
};

using McapItem = std::
    variant<McapSchema, McapChannel, McapMessage, McapAttachment, McapMetadata, McapStatistics>;

struct McapFault {
  std::uint64_t offset{};  ///< [bytes], of the record in the file
  std::string text;
};

struct McapLimits {
  std::uint64_t chunk_size_max{64u << 20};  ///< [bytes], uncompressed; of a message without one
  /// What a file may unpack to at any of its places: so many bytes, and so many times the bytes up
  /// to there. Recordings of ours unpack to less than 30 times their size.
  std::uint64_t unpacked_size_free{64u << 20};  ///< [bytes]
  std::uint64_t unpacked_ratio_max{256};
  std::uint64_t definitions_size_max{4u << 20};  ///< [bytes], of all schemas and channels
  std::uint64_t metadata_size_max{2u << 20};     ///< [bytes], of one metadata record, of statistics
  /// [bytes], of the names of all attachments and metadata records, and 64 for each.
  std::uint64_t names_size_max{4u << 20};
  std::size_t chunk_places_max{std::size_t{1} << 20U};  ///< kept to be held against the index
  /// [bytes], of a schema or topic: names are compared with every message.
  std::size_t name_size_max{4096};
  std::size_t faults_max{64};  ///< kept with their text; all are counted
};

/// What the reader has seen so far.
struct McapReadReport {
  bool closed{};  ///< footer and closing magic are there
  std::uint64_t messages{};
  std::uint64_t chunks{};
  std::uint64_t chunks_damaged{};
  std::uint64_t attachments{};
  std::uint64_t metadata{};
  std::uint64_t last_log_time{};  ///< [ns], the largest one
  std::uint64_t bytes_unread{};   ///< behind the last whole record of a file that was cut off
  std::uint64_t fault_count{};
  std::vector<McapFault> faults;  ///< the first ones
};

/// Reads an MCAP file from its first byte to its last, also one that a crash cut off or a disk
/// damaged: all whole records and all whole chunks are used, a damaged chunk is skipped. Never
/// aborts and never takes more memory than the limits, whatever the bytes say. Of a mapped file it
/// gives back the memory that it read.
/// Does not own the bytes. Thread: any one.
class McapReader {
 public:
  explicit McapReader(const FileBytes& file, const McapLimits& limits = {});

  /// The next item, or nullopt at the end. Definitions come once, not again from the summary.
  std::optional<McapItem> next();

  /// From now on chunks without a message in [`from`, `to`] [ns] are passed over unopened, and
  /// where the file has an index not even looked at; what it says of itself as a whole is not
  /// checked.
  void only_between(std::uint64_t from, std::uint64_t to);

  [[nodiscard]] const McapReadReport& report() const noexcept { return report_; }

 private:
  struct ChunkPlace {
    std::uint64_t offset{};
    std::uint64_t length{};
    bool operator==(const ChunkPlace&) const = default;
  };
  struct RawRecord {
    McapOpcode opcode{};
    std::uint64_t offset{};  ///< in the file; of its chunk, if it stands in one
    std::span<const std::byte> content;
  };

  std::optional<McapItem> next_in_chunk();
  std::optional<McapItem> next_in_file();
  /// The whole record at `offset`, which then stands behind it; nullopt: there is none.
  static std::optional<RawRecord> cut_record(std::span<const std::byte> bytes, std::size_t& offset);
  std::optional<McapItem> interpret(const RawRecord& record);
  void open_chunk(const RawRecord& record);
  void check_time(std::uint64_t log_time);
  [[nodiscard]] bool passes_over(std::uint64_t begin, std::uint64_t end) const noexcept;
  void find_chunks_to_pass_over();
  bool admit_unpacked(const RawRecord& record, std::uint64_t size);
  std::optional<McapItem> read_schema(const RawRecord& record);
  std::optional<McapItem> read_channel(const RawRecord& record);
  std::optional<McapItem> read_message(const RawRecord& record);
  std::optional<McapItem> read_attachment(const RawRecord& record);
  std::optional<McapItem> read_metadata(const RawRecord& record);
  std::optional<McapItem> read_statistics(const RawRecord& record);
  bool admit_definition(const RawRecord& record, std::uint64_t so_far);
  bool admit_names(const RawRecord& record, std::size_t size);
  void check_message_index(const RawRecord& record);
  void check_chunk_index(const RawRecord& record);
  void leave_behind(std::uint64_t offset);
  void check_data_end(const RawRecord& record);
  void check_footer(const RawRecord& record);
  void fault(std::uint64_t offset, std::string text);

  FileBytes mapping_;
  std::span<const std::byte> file_;  ///< the same
  McapLimits limits_;
  std::size_t offset_{};      ///< in the file
  std::size_t read_up_to_{};  ///< bytes in data_crc_
  std::size_t forgotten_{};   ///< bytes whose memory was given back
  std::uint32_t data_crc_{};
  struct Gap {
    std::uint64_t begin{};  ///< a chunk outside of the window
    std::uint64_t end{};    ///< behind its message indexes
  };
  struct Window {
    std::uint64_t from{};   ///< [ns]
    std::uint64_t to{};     ///< [ns]
    std::vector<Gap> gaps;  ///< in order
    std::size_t next_gap{};
  };
  std::optional<Window> window_;
  bool ended_{};
  ChunkDecompressor decompressor_;
  std::span<const std::byte> chunk_;  ///< records of the open chunk
  std::size_t chunk_offset_{};        ///< within them
  std::uint64_t chunk_at_{};          ///< in the file
  struct StatedTime {
    std::uint64_t begin{};  ///< [ns]
    std::uint64_t end{};    ///< [ns]
    bool wrong{};           ///< and told
  };
  StatedTime chunk_time_;  ///< of the open chunk
  bool data_ended_{};
  std::map<std::uint16_t, std::uint64_t> chunk_messages_;  ///< per channel
  std::vector<ChunkPlace> chunk_places_;                   ///< of the first ones
  std::size_t chunk_indexes_{};                            ///< seen so far
  std::map<std::uint16_t, McapSchema> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
  std::uint64_t definitions_size_{};  ///< [bytes]
  std::uint64_t names_size_{};        ///< [bytes], as in limits_
  std::uint64_t unpacked_{};          ///< [bytes] claimed by the chunks so far
  std::map<std::uint16_t, std::uint64_t> messages_by_channel_;
  McapReadReport report_;
};

}  // namespace palp::record
