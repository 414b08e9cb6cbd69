#include "review/recover.h"

#include <algorithm>
#include <cstring>

#include <gtest/gtest.h>

#include "review/check.h"
#include "tests/review/session_samples.h"

namespace palp::review {
namespace {

TEST(RecoverTest, CutOffFileBecomesASoundOneWithAllItsMessages) {
  auto file = test::sample_session().surgeon;
  file.resize(file.size() * 2 / 3);
  const auto before = file;
  record::MemorySink out;
  const auto recovery = recover(file, out);
  ASSERT_TRUE(recovery);
  EXPECT_EQ(file, before);
  EXPECT_GT(recovery->messages, 3000u);
  EXPECT_EQ(recovery->messages, recovery->report.messages);
  EXPECT_TRUE(recovery->losses.empty());
  EXPECT_EQ(checked(out.bytes()).fault, std::nullopt);
  EXPECT_NE(describe(*recovery).find("the file was not closed"), std::string::npos);

  const auto saved = load_site(out.bytes(), "recovered", link::Role::Surgeon);
  const auto original = load_site(file, "cut off", link::Role::Surgeon);
  ASSERT_TRUE(saved && original);
  EXPECT_EQ(saved->records, original->records);
  EXPECT_EQ(saved->entry("seed"), "42");
}

TEST(RecoverTest, DamagedChunkIsLostAndItsTopicsAreNamed) {
  auto file = test::sample_session().surgeon;
  const std::uint64_t whole = load_site(file, "whole", link::Role::Surgeon)->report.messages;
  file[file.size() / 2] ^= std::byte{4};
  record::MemorySink out;
  const auto recovery = recover(file, out);
  ASSERT_TRUE(recovery);
  ASSERT_TRUE(recovery->losses.contains("surgeon/tick"));
  std::uint64_t lost = 0;
  for (const auto& [topic, loss] : recovery->losses) {
    lost += loss.messages;
  }
  EXPECT_EQ(recovery->messages + lost, whole);
  EXPECT_EQ(recovery->losses.at("surgeon/tick").messages, 500u) << "one chunk of half a second";
  EXPECT_NE(describe(*recovery).find("surgeon/tick: 500"), std::string::npos);
}

TEST(RecoverTest, SoundFileLosesNothing) {
  const auto file = test::sample_session().patient;
  record::MemorySink out;
  const auto recovery = recover(file, out);
  ASSERT_TRUE(recovery);
  EXPECT_EQ(checked(out.bytes()).fault, std::nullopt);
  EXPECT_EQ(load_site(out.bytes(), "saved", link::Role::Patient)->texts.tissue_csv,
            test::kTissueCsv);
}

/// Where each chunk of a file ends.
std::vector<std::size_t> ends_of_chunks(std::span<const std::byte> file) {
  std::vector<std::size_t> ends;
  for (std::size_t at = 8; at + 9 < file.size();) {
    std::uint64_t length = 0;
    std::memcpy(&length, &file[at + 1], sizeof length);
    const bool chunk = file[at] == std::byte{6};
    at += 9 + length;
    if (chunk) ends.push_back(at);
  }
  return ends;
}

TEST(RecoverTest, CutAtAnyByteOfItsLastTwoChunksItKeepsEveryChunkBefore) {
  record::MemorySink sink;
  std::uint64_t messages = 0;
  {
    record::SessionWriter writer{sink, {.site = link::Role::Surgeon}, {.chunk_size_max = 1024}};
    for (std::int64_t ms = 0; ms < 100; ++ms) writer.write(test::hand_tick(ms, 1));
    writer.close();
    messages = writer.messages();
  }
  const std::span<const std::byte> file = sink.bytes();
  const std::vector<std::size_t> ends = ends_of_chunks(file);
  ASSERT_GT(ends.size(), 4U);
  const std::size_t first = ends[ends.size() - 3];
  std::uint64_t whole = 0;  // messages of the chunks that end before the cut
  for (std::size_t cut = first; cut <= ends.back(); ++cut) {
    record::MemorySink out;
    const auto recovery = recover(file.first(cut), out);
    ASSERT_TRUE(recovery) << cut;
    if (std::ranges::find(ends, cut) != ends.end()) {
      ASSERT_GT(recovery->messages, whole) << "one chunk more";
      whole = recovery->messages;
    }
    ASSERT_EQ(recovery->messages, whole) << cut;
    ASSERT_EQ(checked(out.bytes()).fault, std::nullopt) << cut;
  }
  EXPECT_EQ(whole, messages) << "of all chunks";
}

class NoRoom final : public record::ByteSink {
 public:
  bool write(std::span<const std::byte>) noexcept override { return false; }
};

TEST(RecoverTest, FullDiskIsAnError) {
  NoRoom out;
  EXPECT_FALSE(recover(test::sample_session().patient, out));
}

}  // namespace
}  // namespace palp::review
