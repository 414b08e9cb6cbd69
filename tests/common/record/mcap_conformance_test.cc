// Goal: our writer writes MCAP, and our reader reads it, as the MCAP project itself does.
// Method: make each of its 416 conformance cases from the case's name, compare size and hash with
// the project's file, and read it back to what went in. A writer may not pad records, a reader has
// to skip what they end with: `pad` is added here.
#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/record/mcap_reader.h"
#include "common/record/mcap_writer.h"
#include "tests/common/record/sha256.h"

namespace palp::record {
namespace {

struct Case {
  std::string name;
  std::string input;  ///< "TenMessages"
  std::set<std::string> features;
  std::size_t size{};  ///< [bytes]
  std::string sha256;

  [[nodiscard]] bool has(const char* feature) const { return features.contains(feature); }
};

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  std::ifstream table{PALP_MCAP_CONFORMANCE};
  std::string line;
  std::getline(table, line);  // the names of the columns
  while (std::getline(table, line)) {
    std::istringstream cells{line};
    Case one;
    std::string size;
    std::getline(cells, one.name, ',');
    std::getline(cells, size, ',');
    std::getline(cells, one.sha256);
    one.size = std::stoul(size);
    std::istringstream parts{one.name};
    std::getline(parts, one.input, '-');
    for (std::string part; std::getline(parts, part, '-');) one.features.insert(part);
    cases.push_back(one);
  }
  return cases;
}

constexpr std::array kData{std::byte{1}, std::byte{2}, std::byte{3}};
constexpr std::array kSchema{std::byte{4}, std::byte{5}, std::byte{6}};
constexpr McapAttachment kAttachment{.log_time = 2,
                                     .create_time = 1,
                                     .name = "myFile",
                                     .media_type = "application/octet-stream",
                                     .data = kData};
const McapMap kFooBar{{"foo", "bar"}};

std::vector<McapStamp> messages_of(const std::string& input) {
  if (input == "OneMessage" || input == "OneSchemalessMessage") {
    return {{.channel = 1, .sequence = 10, .log_time = 2, .publish_time = 1}};
  }
  std::vector<McapStamp> stamps;
  if (input != "TenMessages") return stamps;
  for (const std::uint64_t at : {0U, 2U, 1U, 3U, 3U, 5U, 4U, 7U, 8U, 9U}) {
    stamps.push_back({.channel = 1,
                      .sequence = static_cast<std::uint32_t>(stamps.size()),
                      .log_time = at,
                      .publish_time = at});
  }
  return stamps;
}

Bytes written(const Case& one) {
  MemorySink sink;
  McapWriter writer{sink,
                    {.library = "",
                     .compression = McapCompression::None,
                     .chunks = one.has("ch"),
                     .definitions_in_chunks = true,
                     .message_index = one.has("mx"),
                     .chunk_index = one.has("chx"),
                     .attachment_index = one.has("ax"),
                     .metadata_index = one.has("mdx"),
                     .statistics = one.has("st"),
                     .repeated_schemas = one.has("rsh"),
                     .repeated_channels = one.has("rch"),
                     .summary_offsets = one.has("sum")}};
  if (one.input == "OneAttachment") {
    writer.add_attachment(kAttachment);
  } else if (one.input == "OneMetadata") {
    writer.add_metadata("myMetadata", kFooBar);
  } else if (one.input == "OneSchemalessMessage") {
    writer.add_channel(0, "example", "text");
  } else if (one.input != "NoData") {
    writer.add_channel(writer.add_schema("Example", "c", kSchema), "example", "a", kFooBar);
  }
  for (const McapStamp& stamp : messages_of(one.input)) {
    std::memcpy(writer.add_message(stamp, kData.size()), kData.data(), kData.size());
  }
  writer.close();
  return {sink.bytes().begin(), sink.bytes().end()};
}

constexpr std::array kPad{std::byte{0x01}, std::byte{0xff}, std::byte{0xff}};

/// The same file with three bytes more behind each record that may grow; what points at records or
/// covers them is set right.
class Padding {
 public:
  explicit Padding(const Bytes& file) : file_{file} {}

  Bytes padded() {
    append(out_, std::span<const std::byte>{kMcapMagic});
    for (std::size_t at = out_.size(); at + kMcapMagic.size() < file_.size();) {
      ByteCursor cursor{std::span{file_}.subspan(at)};
      const auto opcode = cursor.read<McapOpcode>();
      const auto content = cursor.take(cursor.read<std::uint64_t>());
      moved_[at] = out_.size();
      add(opcode, content);
      at += kMcapPrefixSize + content.size();
    }
    append(out_, std::span<const std::byte>{kMcapMagic});
    return out_;
  }

 private:
  template <class T>
  T get(std::size_t at) {
    T value{};
    std::memcpy(&value, &out_[at], sizeof value);
    return value;
  }
  template <class T>
  void set(std::size_t at, T value) {
    std::memcpy(&out_[at], &value, sizeof value);
  }
  /// An offset in the file; 0: of nothing.
  void move(std::size_t at) {
    if (const auto old = get<std::uint64_t>(at); old != 0) set(at, moved_.at(old));
  }
  void grow(std::size_t at, std::uint64_t records) {
    set(at, get<std::uint64_t>(at) + records * kPad.size());
  }

  void add(McapOpcode opcode, std::span<const std::byte> content) {
    const std::size_t begin = out_.size();
    const std::size_t at = begin + kMcapPrefixSize;
    {
      const RecordScope record{out_, opcode};
      append(out_, content);
      if (opcode != McapOpcode::Footer && opcode != McapOpcode::Chunk &&
          opcode != McapOpcode::Message && opcode != McapOpcode::DataEnd) {
        append(out_, std::span<const std::byte>{kPad});
      }
    }
    const std::span<const std::byte> before{out_.data(), begin};
    if (opcode == McapOpcode::DataEnd) set(at, crc32(before));
    if (opcode == McapOpcode::ChunkIndex) move_chunk_index(at);
    if (opcode == McapOpcode::SummaryOffset) {
      const auto end = get<std::uint64_t>(at + 1) + get<std::uint64_t>(at + 9);
      move(at + 1);
      set(at + 9, moved_.at(end) - get<std::uint64_t>(at + 1));
    }
    if (opcode == McapOpcode::AttachmentIndex || opcode == McapOpcode::MetadataIndex) {
      move(at);
      grow(at + 8, 1);
    }
    if (opcode == McapOpcode::Footer) {
      move(at);
      move(at + 8);
      const auto summary = get<std::uint64_t>(at);
      const std::size_t from = summary == 0 ? begin : summary;
      set(at + 16, crc32(std::span{out_}.subspan(from, at + 16 - from)));
    }
  }
  void move_chunk_index(std::size_t at) {
    move(at + 16);
    const auto size = get<std::uint32_t>(at + 32);  // of the map: channels and offsets
    for (std::size_t pair = at + 36; pair < at + 36 + size; pair += 10) move(pair + 2);
    grow(at + 36 + size, size / 10);
  }

  Bytes file_;
  Bytes out_;
  std::map<std::uint64_t, std::uint64_t> moved_;  ///< where records began and begin
};

Bytes made(const Case& one) {
  return one.has("pad") ? Padding{written(one)}.padded() : written(one);
}

TEST(McapConformanceTest, WriterMakesTheBytesOfEveryCase) {
  const auto cases = all_cases();
  ASSERT_EQ(cases.size(), 416U);
  for (const Case& one : cases) {
    const Bytes bytes = made(one);
    EXPECT_EQ(bytes.size(), one.size) << one.name;
    EXPECT_EQ(test::sha256(bytes), one.sha256) << one.name;
  }
}

/// What a reader says of a case, item by item.
class Seen {
 public:
  void operator()(const McapSchema& schema) {
    EXPECT_EQ(schema, (McapSchema{1, "Example", "c", {kSchema.begin(), kSchema.end()}}));
    ++schemas;
  }
  void operator()(const McapChannel& channel) { channels.push_back(channel); }
  void operator()(const McapMessage& message) {
    messages.push_back({.channel = message.channel->id,
                        .sequence = message.sequence,
                        .log_time = message.log_time,
                        .publish_time = message.publish_time});
    EXPECT_TRUE(std::ranges::equal(message.payload, kData));
    EXPECT_EQ(message.schema != nullptr, message.channel->schema != 0);
  }
  void operator()(const McapAttachment& one) {
    EXPECT_EQ(one.log_time, kAttachment.log_time);
    EXPECT_EQ(one.create_time, kAttachment.create_time);
    EXPECT_EQ(one.name, kAttachment.name);
    EXPECT_EQ(one.media_type, kAttachment.media_type);
    const std::span<const std::byte> data = one.data;
    EXPECT_TRUE(std::ranges::equal(data, kData));
    ++attachments;
  }
  void operator()(const McapMetadata& one) {
    EXPECT_EQ(one.name, "myMetadata");
    EXPECT_EQ(one.entries, kFooBar);
    ++metadata;
  }
  void operator()(const McapStatistics& one) { statistics = one; }

  std::size_t schemas{};
  std::vector<McapChannel> channels;
  std::vector<McapStamp> messages;
  std::size_t attachments{};
  std::size_t metadata{};
  std::optional<McapStatistics> statistics;
};

TEST(McapConformanceTest, ReaderSaysOfEveryCaseWhatIsInIt) {
  for (const Case& one : all_cases()) {
    SCOPED_TRACE(one.name);
    const Bytes bytes = made(one);
    McapReader reader{bytes};
    Seen seen;
    while (const auto item = reader.next()) std::visit(seen, *item);
    EXPECT_TRUE(reader.report().closed);
    EXPECT_EQ(reader.report().fault_count, 0U);
    const auto messages = messages_of(one.input);
    EXPECT_EQ(seen.messages, messages);
    const bool schemaless = one.input == "OneSchemalessMessage";
    EXPECT_EQ(seen.schemas, !messages.empty() && !schemaless ? 1U : 0U);
    ASSERT_EQ(seen.channels.size(), messages.empty() ? 0U : 1U);
    if (!messages.empty()) {
      EXPECT_EQ(seen.channels[0],
                schemaless ? (McapChannel{1, 0, "example", "text", {}})
                           : (McapChannel{1, 1, "example", "a", kFooBar}));
    }
    EXPECT_EQ(seen.attachments, one.input == "OneAttachment" ? 1U : 0U);
    EXPECT_EQ(seen.metadata, one.input == "OneMetadata" ? 1U : 0U);
    ASSERT_EQ(seen.statistics.has_value(), one.has("st"));
    if (seen.statistics) {
      EXPECT_EQ(seen.statistics->messages, messages.size());
      EXPECT_EQ(seen.statistics->chunks, one.has("ch") ? 1U : 0U);
    }
  }
}

}  // namespace
}  // namespace palp::record
