#include "review/copied_channels.h"

#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace palp::review {
namespace {

/// What a reader finds: topic, schema, stamps and content of a message.
struct Found {
  std::string topic;
  std::string schema;
  std::uint64_t log_time{};
  std::uint64_t publish_time{};
  int content{};

  bool operator==(const Found&) const = default;
};

std::vector<Found> messages_of(const record::MemorySink& file) {
  std::vector<Found> found;
  record::McapReader reader{file.bytes()};
  while (const auto item = reader.next()) {
    if (const auto* message = std::get_if<record::McapMessage>(&*item)) {
      found.push_back({message->channel->topic,
                       message->schema == nullptr ? "" : message->schema->name,
                       message->log_time,
                       message->publish_time,
                       std::to_integer<int>(message->payload[0])});
    }
  }
  return found;
}

void add(record::McapWriter& writer, std::uint16_t channel, std::uint64_t at, int content) {
  *writer.add_message({.channel = channel, .sequence = 0, .log_time = at, .publish_time = at}, 1) =
      static_cast<std::byte>(content);
}

TEST(CopiedChannelsTest, KeepWhatBelongsTogetherWhereIdsAreOthers) {
  record::MemorySink old_file;
  {
    record::McapWriter writer{old_file, {.library = "test"}};
    add(writer, writer.add_channel(writer.add_schema("one", "raw", {}), "a", "raw"), 5, 1);
    add(writer, writer.add_channel(writer.add_schema("two", "raw", {}), "b", "raw"), 6, 2);
    add(writer, writer.add_channel(0, "c", "raw"), 7, 3);
  }
  record::MemorySink new_file;
  {
    record::McapWriter writer{new_file, {.library = "test"}};
    add(writer, writer.add_channel(writer.add_schema("first", "raw", {}), "z", "raw"), 1, 9);
    CopiedChannels copied{writer};
    record::McapReader reader{old_file.bytes()};
    while (const auto item = reader.next()) {
      if (const auto* schema = std::get_if<record::McapSchema>(&*item)) copied.add(*schema);
      if (const auto* channel = std::get_if<record::McapChannel>(&*item)) copied.add(*channel);
      if (const auto* message = std::get_if<record::McapMessage>(&*item)) {
        copied.add(*message, message->log_time + 10, message->log_time + 20);
      }
    }
  }
  EXPECT_EQ(messages_of(new_file),
            (std::vector<Found>{{"z", "first", 1, 1, 9},
                                {"a", "one", 15, 25, 1},
                                {"b", "two", 16, 26, 2},
                                {"c", "", 17, 27, 3}}));
}

}  // namespace
}  // namespace palp::review
