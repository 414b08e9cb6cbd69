#include "review/recover.h"

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
  EXPECT_EQ(first_fault(out.bytes()), std::nullopt);
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
  EXPECT_EQ(first_fault(out.bytes()), std::nullopt);
  EXPECT_EQ(load_site(out.bytes(), "saved", link::Role::Patient)->tissue_csv, test::kTissueCsv);
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
