#include "review/logged_ticks.h"

#include <gtest/gtest.h>

#include "common/record/session_writer.h"
#include "review/copied_channels.h"
#include "tests/review/lab_files.h"

namespace palp::review {
namespace {

TEST(LoggedTicksTest, GivesEachTickWithWhatTheSiteWasTold) {
  const test::LabFiles files = test::lab_files(test::lab_scenario(std::chrono::milliseconds{200}));
  const RunBytes bytes{files.patient.bytes()};
  LoggedTicks ticks{bytes};
  std::size_t count = 0;
  while (const auto tick = ticks.next()) {
    EXPECT_TRUE(tick->stage && tick->force && tick->heard);
    EXPECT_EQ(tick->own_devices.has_value(), count == 0) << "told once, at the start";
    EXPECT_EQ(tick->link().session_id, tick->heard->session_id);
    ++count;
  }
  EXPECT_EQ(count, 200U);
}

TEST(LoggedTicksTest, FilesOfARunFollowEachOther) {
  const test::LabFiles files = test::lab_files(test::lab_scenario(std::chrono::milliseconds{100}));
  const RunBytes bytes{files.surgeon.bytes(), files.surgeon.bytes()};
  LoggedTicks ticks{bytes};
  std::size_t count = 0;
  while (ticks.next()) ++count;
  EXPECT_EQ(count, 200U);
}

TEST(LoggedTicksTest, ATickOfMoreRecordsThanAnySiteMakesIsDamage) {
  const auto torn = [](int notes) {
    record::MemorySink sink;
    {
      record::SessionWriter writer{sink, {.site = link::Role::Surgeon}};
      for (int k = 0; k < notes; ++k) writer.write(Note{.code = 36});
      writer.write(LinkHeard{});
    }
    const RunBytes bytes{sink.bytes()};
    LoggedTicks ticks{bytes};
    const auto tick = ticks.next();
    EXPECT_LE(tick->records.size(), 4096U);
    return ticks.damaged() > 0;
  };
  EXPECT_FALSE(torn(4000));
  EXPECT_TRUE(torn(5000));
}

TEST(LoggedTicksTest, AMessageThatIsThereTwiceIsDamage) {
  record::MemorySink once;
  {
    record::SessionWriter writer{once, {.site = link::Role::Surgeon}};
    writer.write(LinkHeard{});
  }
  const auto damaged = [&](int times) {
    record::MemorySink copy;
    record::McapWriter writer{copy, {}};
    CopiedChannels channels{writer};
    record::McapReader reader{once.bytes()};
    while (const auto item = reader.next()) {
      if (const auto* schema = std::get_if<record::McapSchema>(&*item)) channels.add(*schema);
      if (const auto* channel = std::get_if<record::McapChannel>(&*item)) channels.add(*channel);
      const auto* message = std::get_if<record::McapMessage>(&*item);
      for (int k = 0; message != nullptr && k < times; ++k) {
        channels.add(*message, message->log_time, message->publish_time);
      }
    }
    writer.close();
    const RunBytes bytes{copy.bytes()};
    LoggedTicks ticks{bytes};
    while (ticks.next()) {
    }
    return ticks.damaged();
  };
  EXPECT_EQ(damaged(1), 0U);
  EXPECT_GT(damaged(2), 0U);
}

}  // namespace
}  // namespace palp::review
