#include "review/merge.h"

#include <map>

#include <gtest/gtest.h>

#include "common/record/session_reader.h"
#include "tests/review/session_samples.h"

namespace palp::review {
namespace {

TEST(MergeTest, BothSitesStandOnTheSurgeonsLine) {
  const auto files = test::sample_session();
  auto loaded = test::load(files);
  SessionPair session = pair_of(std::move(loaded.surgeon), std::move(loaded.patient)).value();
  session.time_line.offset = test::kClockOffset;
  session.time_line.known = true;
  record::MemorySink out;
  const auto merged = merge_files({files.surgeon, files.patient}, session, out);
  ASSERT_TRUE(merged) << merged.error().text;
  record::McapReader reader{out.bytes()};
  std::map<std::string, std::uint64_t> first;
  std::map<std::string, std::size_t> counts;
  std::uint64_t messages = 0;
  record::McapMap description;
  while (const auto item = reader.next()) {
    if (const auto* message = std::get_if<record::McapMessage>(&*item)) {
      first.try_emplace(message->channel->topic, message->publish_time);
      ++counts[message->channel->topic];
      ++messages;
    } else if (const auto* metadata = std::get_if<record::McapMetadata>(&*item)) {
      if (metadata->name == "palp.merge") description = metadata->entries;
    }
  }
  EXPECT_EQ(messages, *merged);
  EXPECT_TRUE(reader.report().closed);
  EXPECT_EQ(reader.report().fault_count, 0U);
  EXPECT_EQ(counts["surgeon/tick"], 6000U);
  EXPECT_EQ(counts["patient/depth"], 6U);
  EXPECT_EQ(first["patient/depth"], 410'000'000U) << "of the patient's clock minus its offset";
  EXPECT_FALSE(description.empty());
}

}  // namespace
}  // namespace palp::review
