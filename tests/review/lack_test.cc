#include "review/lack.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/record/mcap_writer.h"
#include "review/recover.h"
#include "tests/review/session_samples.h"

namespace palp::review {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Bytes = std::vector<std::byte>;

std::string lack(const record::FileBytes& file) {
  record::SessionReader reader{file};
  while (reader.next()) {
  }
  return lack_of(reader);
}

Bytes recovered(const Bytes& file) {
  record::MemorySink out;
  EXPECT_TRUE(recover(file, out));
  return test::bytes_of(out);
}

Bytes whole() { return test::sample_session().surgeon; }
Bytes cut_off() {
  Bytes file = whole();
  file.resize(file.size() * 2 / 3);
  return file;
}
Bytes damaged() {
  Bytes file = whole();
  file[file.size() / 2] ^= std::byte{4};
  return file;
}

TEST(LackTest, AWholeFileLacksNothing) { EXPECT_EQ(lack(whole()), ""); }

TEST(LackTest, WhatIsMissingIsToldBeforeARecoveryAndAfterIt) {
  EXPECT_EQ(lack(cut_off()), "was not closed, and lacks what came after its last message");
  EXPECT_THAT(lack(recovered(cut_off())), HasSubstr("was recovered from one that was not closed"));
  EXPECT_THAT(lack(damaged()),
              AllOf(HasSubstr("has 1 chunks that cannot be read"),
                    HasSubstr("messages"),
                    Not(HasSubstr("closed"))));
  EXPECT_THAT(
      lack(recovered(damaged())),
      AllOf(HasSubstr("was recovered from a damaged one, lacks 1 chunks"), HasSubstr("messages")));
}

/// A closed file of estimates with these sequence numbers, stamps [ns] and payloads.
struct Piece {
  std::uint32_t sequence{};
  std::uint64_t at{};
  Bytes payload{};
};
Bytes file_of(const std::vector<Piece>& pieces, const char* topic = "patient/depth") {
  record::MemorySink sink;
  record::McapWriter writer{sink, {}};
  const auto schema = writer.add_schema("palp.session.DepthEstimate", "protobuf", {});
  const auto channel = writer.add_channel(schema, topic, "protobuf");
  for (const Piece& piece : pieces) {
    std::byte* place = writer.add_message({.channel = channel,
                                           .sequence = piece.sequence,
                                           .log_time = piece.at,
                                           .publish_time = piece.at},
                                          piece.payload.size());
    std::copy(piece.payload.begin(), piece.payload.end(), place);
  }
  writer.close();
  return test::bytes_of(sink);
}

TEST(LackTest, WhatCheckFindsIsTold) {
  const Bytes half_a_double{std::byte{0x09}};
  EXPECT_EQ(lack(file_of({{0}, {1}, {2}})), "");
  EXPECT_EQ(lack(file_of({{0}, {2}})), "lacks 1 messages");
  EXPECT_EQ(lack(file_of({{0}, {1}, {0}, {1}, {2}})), "has 2 messages twice or not in their order");
  EXPECT_EQ(lack(file_of({{0}, {1, 0, half_a_double}})), "has 1 messages that cannot be decoded");
  EXPECT_EQ(lack(file_of({{0, 5}, {1, 4}}, "patient/tick")),
            "has 1 ticks that are older than the one before");
  EXPECT_THAT(lack(file_of({{0}}, "elsewhere")), HasSubstr("on topics of no session"));
  Bytes closing = whole();
  closing[closing.size() - 40] ^= std::byte{1};  // in the summary, behind all messages
  EXPECT_THAT(lack(closing), HasSubstr("has a fault: at byte "));
}

TEST(LackTest, NoFaultIsLeftUntold) {
  const Bytes sound = whole();
  for (std::size_t at = 8; at < sound.size(); at += sound.size() / 97) {
    Bytes file = sound;
    file[at] ^= std::byte{16};
    record::SessionReader reader{file};
    while (reader.next()) {
    }
    if (fault_of(reader)) {
      EXPECT_NE(lack_of(reader), "") << at;
    }
  }
}

}  // namespace
}  // namespace palp::review
