#include "common/record/mcap_reader.h"

#include <algorithm>
#include <map>
#include <span>

#include <gtest/gtest.h>

#include "common/record/mcap_writer.h"
#include "tests/common/record/raw_file.h"
#include "tests/common/record/record_samples.h"

namespace palp::record {
namespace {

using test::RawFile;
using test::small_session;

McapReadReport read_all(std::span<const std::byte> file) {
  McapReader reader{file};
  while (reader.next()) {
  }
  return reader.report();
}

/// Ends of the chunks in a sound file, with the messages read up to there.
std::map<std::size_t, std::uint64_t> messages_at_chunk_ends(std::span<const std::byte> file) {
  std::map<std::size_t, std::uint64_t> ends;
  std::size_t offset = kMcapMagic.size();
  while (offset + kMcapPrefixSize <= file.size()) {
    ByteCursor cursor{file.subspan(offset)};
    const auto opcode = static_cast<McapOpcode>(cursor.read<std::uint8_t>());
    offset += kMcapPrefixSize + static_cast<std::size_t>(cursor.read<std::uint64_t>());
    if (opcode == McapOpcode::Chunk) {
      ends[offset] = read_all(file.first(offset)).messages;
    }
    if (opcode == McapOpcode::Footer) {
      break;
    }
  }
  return ends;
}

TEST(McapReaderTest, SoundFileHasNoFault) {
  const auto report = read_all(small_session(95, 20));
  EXPECT_TRUE(report.closed);
  EXPECT_EQ(report.fault_count, 0u);
  EXPECT_EQ(report.chunks, 5u);
  EXPECT_EQ(report.attachments, 1u);
  EXPECT_EQ(report.metadata, 2u);
}

TEST(McapReaderTest, FileCutAtAnyByteGivesAllWholeChunksAndNeverLess) {
  const auto file = small_session(60, 15);
  const auto ends = messages_at_chunk_ends(file);
  ASSERT_EQ(ends.size(), 5u);
  std::uint64_t before = 0;
  for (std::size_t size = 0; size <= file.size(); ++size) {
    const auto report = read_all(std::span{file}.first(size));
    ASSERT_GE(report.messages, before) << "cut at " << size;
    ASSERT_EQ(report.closed, size == file.size()) << "cut at " << size;
    ASSERT_EQ(report.fault_count, 0u) << "cut at " << size << ": a cut is no damage";
    const auto end = ends.upper_bound(size);
    ASSERT_EQ(report.messages, end == ends.begin() ? 0 : std::prev(end)->second)
        << "cut at " << size;
    before = report.messages;
  }
}

TEST(McapReaderTest, AnyFlippedBitIsSurvivedAndNoticed) {
  const auto file = small_session(40, 15);
  const std::uint64_t total = read_all(file).messages;
  for (std::size_t at = 0; at < file.size(); ++at) {
    auto damaged = file;
    damaged[at] ^= static_cast<std::byte>(1u << (at * 5 % 8));
    const auto report = read_all(damaged);
    ASSERT_LE(report.messages, total + 1) << "byte " << at;  // another record may pass for one
    ASSERT_TRUE(report.fault_count > 0 || !report.closed) << "byte " << at;
  }
}

TEST(McapReaderTest, DamagedChunkIsSkippedAndTheOthersAreKept) {
  auto file = small_session(60, 15);
  const auto ends = messages_at_chunk_ends(file);
  const std::size_t second_end = std::next(ends.begin())->first;
  file[second_end - 5] ^= std::byte{0x10};
  const auto report = read_all(file);
  const std::uint64_t in_second = std::next(ends.begin())->second - ends.begin()->second;
  EXPECT_TRUE(report.closed);
  EXPECT_EQ(report.chunks_damaged, 1u);
  EXPECT_EQ(report.messages, ends.rbegin()->second - in_second);
}

/// One uncompressed chunk with two messages; where the payload of the first stands in it.
struct PlainFile {
  MemorySink sink;
  std::size_t payload_at{};

  explicit PlainFile(std::size_t schema_size = 4) {
    McapOptions options;
    options.compression = McapCompression::None;
    McapWriter writer{sink, options};
    const Bytes schema(schema_size, std::byte{'s'});
    const auto channel = writer.add_channel(writer.add_schema("a", "raw", schema), "topic", "raw");
    const Bytes payload(8, std::byte{0x5a});
    for (std::uint32_t i = 0; i < 2; ++i) {
      std::copy(
          payload.begin(), payload.end(), writer.add_message({channel, i, i, i}, payload.size()));
    }
    writer.close();
    const std::span<const std::byte> bytes = sink.bytes();
    const auto found = std::search(bytes.begin(), bytes.end(), payload.begin(), payload.end());
    payload_at = static_cast<std::size_t>(found - bytes.begin());
  }
};

TEST(McapReaderTest, DamageThatNoDecompressorSeesIsSeenByTheChecksumOfTheChunk) {
  const PlainFile file;
  Bytes damaged{file.sink.bytes().begin(), file.sink.bytes().end()};
  EXPECT_EQ(read_all(damaged).messages, 2u);
  damaged[file.payload_at] ^= std::byte{1};
  const auto report = read_all(damaged);
  EXPECT_EQ(report.chunks_damaged, 1u);
  EXPECT_EQ(report.messages, 0u);
}

TEST(McapReaderTest, DefinitionsBeyondTheLimitAreAFaultAndNotKept) {
  const PlainFile file{1000};
  for (const std::uint64_t limit : {2000u, 900u}) {
    McapReader reader{file.sink.bytes(), {.definitions_size_max = limit}};
    bool schema_seen = false;
    while (const auto item = reader.next())
      schema_seen |= std::holds_alternative<McapSchema>(*item);
    EXPECT_EQ(schema_seen, limit == 2000);
    EXPECT_EQ(reader.report().fault_count == 0, limit == 2000);
  }
}

/// Of 10 s, a message every 100 ms.
Bytes ten_seconds() {
  MemorySink sink;
  {
    McapWriter writer{sink, {}};
    const auto channel = writer.add_channel(0, "t", "raw");
    for (std::uint64_t k = 0; k < 100; ++k) {
      const std::uint64_t stamp = (k + 1) * 100'000'000;
      (void)writer.add_message({.channel = channel, .log_time = stamp, .publish_time = stamp}, 0);
    }
  }
  return {sink.bytes().begin(), sink.bytes().end()};
}

TEST(McapReaderTest, OutsideOfTheWindowNoChunkIsLookedAtWhereThereIsAnIndex) {
  const Bytes sound = ten_seconds();
  Bytes file = sound;
  std::size_t at = kMcapMagic.size();
  while (static_cast<McapOpcode>(file[at]) != McapOpcode::Chunk) {
    at += kMcapPrefixSize + ByteCursor{std::span{file}.subspan(at + 1)}.read<std::uint64_t>();
  }
  file[at + 8] = std::byte{0xFF};  // the first chunk's length reaches beyond any file's end
  const auto messages = [](const Bytes& bytes) {
    McapReader reader{bytes};
    reader.only_between(5'000'000'000, 6'000'000'000);
    while (reader.next()) {
    }
    EXPECT_EQ(reader.report().fault_count, 0U);
    return reader.report().messages;
  };
  EXPECT_EQ(messages(file), messages(sound));
  EXPECT_GE(messages(file), 11U);
  file.resize(file.size() - 1);  // nobody closed it
  EXPECT_EQ(messages(file), 0U);
}

TEST(McapReaderTest, OutsideOfTheWindowNoChunkIsOpened) {
  const Bytes file = ten_seconds();
  McapReader reader{file};
  reader.only_between(5'000'000'000, 6'000'000'000);
  std::uint64_t least = ~std::uint64_t{0};
  std::uint64_t most = 0;
  while (const auto item = reader.next()) {
    if (const auto* message = std::get_if<McapMessage>(&*item)) {
      least = std::min(least, message->log_time);
      most = std::max(most, message->log_time);
    }
  }
  EXPECT_LE(least, 5'000'000'000U);
  EXPECT_GE(most, 6'000'000'000U);
  EXPECT_LT(reader.report().messages, 25U) << "of 100";
  EXPECT_EQ(reader.report().fault_count, 0U) << "nobody counts what was not looked at";
}

TEST(McapReaderTest, UnknownOpcodesAreSkipped) {
  RawFile file;
  file.add(static_cast<McapOpcode>(0x77), [](Bytes& out) { append(out, std::uint64_t{1}); });
  file.add_channel(1, 0).add_message(1);
  EXPECT_EQ(read_all(file.bytes()).messages, 1u);
  EXPECT_EQ(read_all(file.bytes()).fault_count, 0u);
}

TEST(McapReaderTest, ChannelThatNamesAMissingSchemaIsAFaultAndSoAreItsMessages) {
  RawFile file;
  file.add_channel(1, 9).add_message(1);
  const auto report = read_all(file.bytes());
  EXPECT_EQ(report.messages, 0u);
  EXPECT_EQ(report.fault_count, 2u);
  EXPECT_NE(report.faults.front().text.find("schema 9"), std::string::npos);
}

TEST(McapReaderTest, ChannelDefinedAgainInAnotherWayIsAFault) {
  RawFile file;
  file.add_channel(1, 0).add_channel(1, 0);
  EXPECT_EQ(read_all(file.bytes()).fault_count, 0u);
  file.add(McapOpcode::Channel, [](Bytes& out) {
    append(out, std::uint16_t{1});
    append(out, std::uint16_t{0});
    append(out, std::string_view{"other topic"});
    append(out, std::string_view{});
    append(out, McapMap{});
  });
  EXPECT_EQ(read_all(file.bytes()).fault_count, 1u);
}

TEST(McapReaderTest, ChunkThatClaimsMoreThanTheLimitIsNotOpened) {
  Bytes zeros(70u << 20);
  Bytes bomb;
  ASSERT_TRUE(ChunkCompressor{1}.compress(zeros, bomb));
  RawFile file;
  file.add_chunk(zeros.size(), "zstd", bomb);
  file.add_chunk(1000, "zstd", bomb);  // lies about its size
  file.add_chunk(~std::uint64_t{0}, "zstd", bomb);
  const auto report = read_all(file.bytes());
  EXPECT_EQ(report.chunks_damaged, 3u);
  EXPECT_EQ(report.fault_count, 3u);
}

TEST(McapReaderTest, CompressionItDoesNotKnowIsNamedAndSkipped) {
  RawFile file;
  file.add_chunk(10, "lz4", Bytes(10)).add_channel(1, 0).add_message(1);
  const auto report = read_all(file.bytes());
  EXPECT_EQ(report.chunks_damaged, 1u);
  EXPECT_EQ(report.messages, 1u);
}

TEST(McapReaderTest, WhatIsLongerThanAnySessionsIsNotTakenApart) {
  const McapMap entries(100, {"key", "value"});
  const auto seen = [&](const McapLimits& limits) {
    RawFile file;
    file.add(McapOpcode::Metadata, [&](Bytes& out) {
      append(out, std::string_view{"palp"});
      append(out, entries);
    });
    file.add(McapOpcode::Channel, [&](Bytes& out) {
      append(out, std::uint16_t{1});
      append(out, std::uint16_t{0});
      append(out, std::string_view{"topic"});
      append(out, std::string_view{});
      append(out, entries);
    });
    file.add_message(1);
    McapReader reader{file.bytes(), limits};
    std::size_t items = 0;
    while (reader.next()) ++items;
    EXPECT_EQ(items + reader.report().fault_count, 3U);
    return items;
  };
  EXPECT_EQ(seen({}), 3U);
  EXPECT_EQ(seen({.chunk_size_max = 21}), 2U) << "a message has 22 bytes";
  EXPECT_EQ(seen({.metadata_size_max = 1000}), 2U);
  EXPECT_EQ(seen({.definitions_size_max = 1000}), 1U) << "the channel, and with it its message";
}

TEST(McapReaderTest, OfMoreChunksThanAreKeptTheIndexIsOnlyCounted) {
  const auto faults = [](std::size_t indexes) {
    RawFile file;
    const std::uint64_t offset = file.bytes().size();
    for (int k = 0; k < 3; ++k) file.add_chunk(0, "", {});
    const std::uint64_t length = (file.bytes().size() - offset) / 3;
    for (std::size_t k = 0; k < indexes; ++k) {
      file.add(McapOpcode::ChunkIndex, [&](Bytes& out) {
        append(out, std::uint64_t{0});
        append(out, std::uint64_t{0});
        append(out, k < 2 ? offset + k * length : 0);
        append(out, length);
      });
    }
    McapReader reader{file.bytes(), {.chunk_places_max = 2}};
    while (reader.next()) {
    }
    return reader.report().fault_count;
  };
  EXPECT_EQ(faults(3), 0U);
  EXPECT_EQ(faults(4), 1U) << "of no chunk";
}

TEST(McapReaderTest, AttachmentInsideAChunkIsAFault) {
  Bytes records;
  { const RecordScope attachment{records, McapOpcode::Attachment}; }
  RawFile file;
  file.add_chunk(records.size(), "", records);
  EXPECT_EQ(read_all(file.bytes()).fault_count, 1u);
}

TEST(McapReaderTest, MessageBehindTheEndOfTheDataIsAFaultAndNotRead) {
  RawFile file;
  file.add_channel(1, 0).add_message(1);
  file.add(McapOpcode::DataEnd, [](Bytes& out) { append(out, std::uint32_t{0}); });
  file.add_message(1);
  EXPECT_EQ(read_all(file.bytes()).messages, 1u);
  EXPECT_EQ(read_all(file.bytes()).fault_count, 1u);
}

TEST(McapReaderTest, MessageIndexMustPointAtEachMessageOfItsChunk) {
  RawFile inner;
  const std::size_t begin = inner.bytes().size();
  inner.add_channel(1, 0);
  const std::uint64_t message = inner.bytes().size() - begin;
  inner.add_message(1);
  const Bytes records{inner.bytes().begin() + static_cast<std::ptrdiff_t>(begin),
                      inner.bytes().end()};
  const auto faults = [&](const std::vector<std::uint64_t>& entries) {
    RawFile file;
    file.add_chunk(records.size(), "", records).add_message_index(entries);
    return read_all(file.bytes()).fault_count;
  };
  EXPECT_EQ(faults({0, message}), 0u);
  EXPECT_EQ(faults({}), 1u) << "an entry is missing";
  EXPECT_EQ(faults({0, message, 0, message}), 1u) << "twice";
  EXPECT_EQ(faults({7, message}), 1u) << "another log time";
  EXPECT_EQ(faults({0, message + 1}), 1u) << "no record begins there";
  EXPECT_EQ(faults({0, records.size()}), 1u) << "behind the chunk";
  EXPECT_EQ(faults({0}), 1u) << "half an entry";
}

TEST(McapReaderTest, ChunkIndexMustPointAtItsChunk) {
  const auto faults = [](std::uint64_t shift) {
    RawFile file;
    const std::uint64_t offset = file.bytes().size();
    file.add_chunk(0, "", {});
    const std::uint64_t length = file.bytes().size() - offset;
    file.add(McapOpcode::ChunkIndex, [&](Bytes& out) {
      append(out, std::uint64_t{0});
      append(out, std::uint64_t{0});
      append(out, offset + shift);
      append(out, length);
    });
    return read_all(file.bytes()).fault_count;
  };
  EXPECT_EQ(faults(0), 0u);
  EXPECT_EQ(faults(1), 1u);
}

TEST(McapReaderTest, RecordThatReachesBeyondTheFileEndsTheReading) {
  RawFile file;
  file.add_channel(1, 0).add_message(1);
  Bytes bytes{file.bytes().begin(), file.bytes().end()};
  append(bytes, std::uint8_t{5});
  append(bytes, ~std::uint64_t{0});
  const auto report = read_all(bytes);
  EXPECT_EQ(report.messages, 1u);
  EXPECT_EQ(report.bytes_unread, 9u);
  EXPECT_FALSE(report.closed);
}

TEST(McapReaderTest, NamesAreShortBecauseEveryMessageIsComparedWithThem) {
  const auto messages = [](std::size_t size) {
    RawFile file;
    file.add_channel(1, 0, std::string(size, 'x')).add_message(1);
    return read_all(file.bytes()).messages;
  };
  EXPECT_EQ(messages(4096), 1u);
  EXPECT_EQ(messages(4097), 0u);
  RawFile file;
  file.add(McapOpcode::Schema, [](Bytes& out) {
    append(out, std::uint16_t{1});
    append(out, std::string_view{std::string(4097, 'x')});
    append(out, std::string_view{});
    append(out, std::uint32_t{0});
  });
  EXPECT_EQ(read_all(file.bytes()).fault_count, 1u);
}

TEST(McapReaderTest, OtherBytesAreNoMcapFile) {
  const std::string text = "site,d_mm,F_N";
  const auto report = read_all(std::as_bytes(std::span{text}));
  EXPECT_EQ(report.fault_count, 1u);
}

TEST(McapReaderTest, StatisticsOfMoreThanAllChannelsAreNotTakenApart) {
  RawFile file;
  file.add(McapOpcode::Statistics, [](Bytes& out) { out.resize(out.size() + (2u << 20) + 1); });
  EXPECT_EQ(read_all(file.bytes()).fault_count, 1u);
}

TEST(McapReaderTest, StatisticsThatCountOtherwiseAreAFault) {
  RawFile file;
  file.add_channel(1, 0).add_message(1);
  file.add(McapOpcode::Statistics, [](Bytes& out) {
    append(out, std::uint64_t{2});
    out.resize(out.size() + 2 + 4 * 4 + 16);
    append(out, std::uint32_t{0});
  });
  EXPECT_EQ(read_all(file.bytes()).fault_count, 1u);
}

TEST(McapReaderTest, AChunkThatStatesAnotherTimeIsNamedOnce) {
  RawFile inner;
  inner.add_channel(1, 0);
  const std::size_t begin = inner.bytes().size();
  for (const std::uint64_t at : {std::uint64_t{0}, std::uint64_t{7}, std::uint64_t{8}}) {
    inner.add(McapOpcode::Message, [&](Bytes& out) {
      append(out, std::uint16_t{1});
      append(out, std::uint32_t{0});
      append(out, at);
      append(out, at);
    });
  }
  const Bytes records{inner.bytes().begin() + static_cast<std::ptrdiff_t>(begin),
                      inner.bytes().end()};
  RawFile file;
  file.add_channel(1, 0).add_chunk(records.size(), "", records);  // states 0 to 0
  McapReader reader{file.bytes()};
  while (reader.next()) {
  }
  EXPECT_EQ(reader.report().messages, 3U) << "they are there";
  ASSERT_EQ(reader.report().fault_count, 1U);
  EXPECT_NE(reader.report().faults.front().text.find("outside of the time"), std::string::npos);
}

}  // namespace
}  // namespace palp::record
