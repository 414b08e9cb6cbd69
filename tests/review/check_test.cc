#include "review/check.h"

#include <gtest/gtest.h>

#include "tests/review/session_samples.h"

namespace palp::review {
namespace {

TEST(CheckTest, SoundFilesHaveNoFault) {
  const auto files = test::sample_session();
  EXPECT_EQ(checked(files.surgeon).fault, std::nullopt);
  EXPECT_EQ(checked(files.patient).fault, std::nullopt);
}

TEST(CheckTest, CutOffFileIsNamedAsSuch) {
  auto file = test::sample_session().surgeon;
  file.resize(file.size() / 2);
  EXPECT_NE(checked(file).fault.value().find("not closed"), std::string::npos);
}

TEST(CheckTest, DamagedChunkIsNamedWithItsPlace) {
  auto file = test::sample_session().surgeon;
  file[file.size() / 2] ^= std::byte{4};
  EXPECT_NE(checked(file).fault.value().find("at byte"), std::string::npos);
}

/// A closed, sound container whose messages are `payloads` of DepthEstimate.
std::vector<std::byte> depth_file(const std::vector<std::vector<std::byte>>& payloads,
                                  std::uint32_t sequence_step) {
  record::MemorySink sink;
  record::McapWriter writer{sink, {}};
  const auto schema = writer.add_schema("palp.session.DepthEstimate", "protobuf", {});
  const auto channel = writer.add_channel(schema, "patient/depth", "protobuf");
  std::uint32_t sequence = 0;
  for (const auto& payload : payloads) {
    std::byte* place =
        writer.add_message({.channel = channel, .sequence = sequence}, payload.size());
    std::copy(payload.begin(), payload.end(), place);
    sequence += sequence_step;
  }
  writer.close();
  return test::bytes_of(sink);
}

TEST(CheckTest, UndecodableMessageAndMissingMessagesAreFaults) {
  const std::vector<std::byte> empty_message;
  const std::vector<std::byte> broken_message{std::byte{0x09}};  // a double without its bytes
  EXPECT_EQ(checked(depth_file({empty_message, empty_message}, 1)).fault, std::nullopt);
  const auto broken = checked(depth_file({empty_message, broken_message}, 1)).fault;
  EXPECT_NE(broken.value().find("patient/depth number 1"), std::string::npos);
  const auto gap = checked(depth_file({empty_message, empty_message}, 2)).fault;
  EXPECT_NE(gap.value().find("1 messages are missing"), std::string::npos);
}

}  // namespace
}  // namespace palp::review
