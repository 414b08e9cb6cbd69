#include "common/record/log_line.h"

#include <gtest/gtest.h>

#include "common/message/wire_format.h"
#include "common/record/notes.h"
#include "common/record/session_reader.h"
#include "common/record/session_writer.h"

// That other programs read the bytes by the schema in the file: IndependentReaderTest.

namespace palp::record {
namespace {

Note note(NoteCode code, double detail = 0) {
  return {.at = {}, .code = static_cast<std::uint16_t>(code), .detail = detail};
}
Transition change(SiteState to, NoteCode reason) {
  return {
      .at = {}, .from = SiteState::Engaged, .to = to, .reason = static_cast<std::uint16_t>(reason)};
}

TEST(LogLineTest, SaysEventsInWords) {
  EXPECT_EQ(log_line_of(change(SiteState::Hold, NoteCode::GapHold), link::Role::Patient)->text,
            "ENGAGED -> HOLD: nothing arrived: hold");
  EXPECT_EQ(log_line_of(note(NoteCode::Marked, 2), link::Role::Surgeon)->text,
            "a moment marked by the operator (2)");
  EXPECT_EQ(log_line_of(note(NoteCode::SessionBegan), link::Role::Surgeon)->text,
            "new session with the peer");
  EXPECT_FALSE(log_line_of(LinkHeard{}, link::Role::Surgeon));
}

TEST(LogLineTest, WhatNeedsAnEyeIsAWarningOrAnError) {
  const auto level = [](const Record& record) {
    return log_line_of(record, link::Role::Patient)->level;
  };
  EXPECT_EQ(level(change(SiteState::Stopped, NoteCode::EmergencyStop)), LogLevel::Error);
  EXPECT_EQ(level(change(SiteState::Retract, NoteCode::GapLost)), LogLevel::Warning);
  EXPECT_EQ(level(change(SiteState::Clutched, NoteCode::PedalReleased)), LogLevel::Info);
  EXPECT_EQ(level(note(NoteCode::ForceRetreat, 3)), LogLevel::Warning);
  EXPECT_EQ(level(note(NoteCode::Marked, 1)), LogLevel::Info);
  for (const NoteCode code : {NoteCode::ForceIncomplete,
                              NoteCode::TissueTooStiff,
                              NoteCode::TipFeelsMore,
                              NoteCode::TipElsewhere}) {
    EXPECT_EQ(level(note(code)), LogLevel::Warning) << to_string(code);
  }
}

TEST(LogLineTest, StandsBesideItsEventInTheFileAndIsNoRecord) {
  MemorySink sink;
  SessionWriter writer{sink, {.site = link::Role::Patient}};
  writer.write(note(NoteCode::Marked, 1));
  writer.write(change(SiteState::Hold, NoteCode::GapHold));
  writer.close();
  EXPECT_EQ(writer.counts().log_lines, 2U);
  EXPECT_EQ(writer.messages(), writer.counts().messages());
  SessionReader reader{sink.bytes()};
  std::size_t records = 0;
  while (reader.next()) ++records;
  EXPECT_EQ(records, 2U);
  EXPECT_EQ(reader.unknown(), 0U);
  EXPECT_EQ(reader.topics().at("patient/log").messages, 2U);
  EXPECT_EQ(reader.topics().at("patient/log").schema, "foxglove.Log");
}

}  // namespace
}  // namespace palp::record
