#include "review/info.h"

#include <gtest/gtest.h>

#include "common/core/printable.h"
#include "common/record/mcap_writer.h"
#include "review/check.h"
#include "review/recover.h"
#include "tests/review/session_samples.h"

namespace palp::review {
namespace {

TEST(InfoTest, TellsDurationTopicsRatesDropsAndEnd) {
  const std::string text = describe(test::sample_session().surgeon);
  EXPECT_NE(text.find("surgeon/tick_view"), std::string::npos);
  EXPECT_NE(text.find("1000.0"), std::string::npos) << text;
  EXPECT_NE(text.find("5.999 s"), std::string::npos) << text;
  EXPECT_NE(text.find("dropped 0"), std::string::npos) << text;
  EXPECT_NE(text.find("closed in order"), std::string::npos) << text;
}

TEST(InfoTest, TellsHowFarACutOffFileGoes) {
  auto file = test::sample_session().surgeon;
  file.resize(file.size() / 2);
  const std::string text = describe(file);
  EXPECT_NE(text.find("the file was not closed"), std::string::npos) << text;
  EXPECT_NE(text.find("last at 2.999"), std::string::npos) << text;
}

TEST(InfoTest, EmptyFileIsNoTrouble) {
  const std::string text = describe(std::span<const std::byte>{});
  EXPECT_NE(text.find("the file was not closed"), std::string::npos);
}

TEST(InfoTest, NothingInAFileActsOnTheTerminal) {
  const std::string evil =
      "\x1b]0;owned\x07\n\xc2\x9b"
      "31mfault at byte 0";
  record::MemorySink sink;
  {
    record::McapWriter writer{sink, {}};
    writer.add_metadata("palp", {{evil, evil}});
    writer.add_metadata("palp.summary", {{"records_dropped", evil}, {"messages", evil}});
    const auto schema = writer.add_schema(evil, "protobuf", {});
    const auto channel = writer.add_channel(schema, "surgeon/" + evil, "protobuf");
    for (const std::uint32_t sequence : {0U, 7U}) {
      (void)writer.add_message({.channel = channel, .sequence = sequence}, 0);
    }
  }
  record::MemorySink copy;
  const auto recovery = recover(sink.bytes(), copy);
  ASSERT_TRUE(recovery);
  for (const std::string& text :
       {describe(sink.bytes()), checked(sink.bytes()).fault.value_or(""), describe(*recovery)}) {
    EXPECT_FALSE(text.empty());
    EXPECT_EQ(text, harmless(text));
    EXPECT_EQ(text.find("\nfault at"), std::string::npos) << "no line of its own: " << text;
  }
}

}  // namespace
}  // namespace palp::review
