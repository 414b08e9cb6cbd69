#include "common/record/notes.h"

#include <set>

#include <gtest/gtest.h>

namespace palp::record {
namespace {

TEST(NotesTest, EveryNumberHasItsOwnTextAndOthersSaySo) {
  std::set<std::string_view> texts;
  int known = 0;
  for (int code = 1; code < 65536; ++code) {
    const auto text = note_text(static_cast<std::uint16_t>(code));
    if (text != "unknown note") {
      ++known;
      EXPECT_TRUE(texts.insert(text).second) << code << ": " << text;
    }
  }
  EXPECT_EQ(known, 52);
}

TEST(NotesTest, WhatASitesControlNotesIsOfATick) {
  for (const NoteCode code : {NoteCode::PedalPressed,
                              NoteCode::ForceComplete,
                              NoteCode::TissueTooStiff,
                              NoteCode::TipElsewhere}) {
    EXPECT_TRUE(is_of_a_tick(code)) << to_string(code);
  }
  for (const NoteCode code : {NoteCode::Marked, NoteCode::StudyAnswer, NoteCode::DiskNearlyFull}) {
    EXPECT_FALSE(is_of_a_tick(code)) << to_string(code);
  }
}

TEST(NotesTest, AStateSaysWhyWhereItIsNotTheUsualOne) {
  constexpr auto kReason = NoteCode::PeerStopped;
  constexpr auto kRefused = NoteCode::EngageRefusedForce;
  EXPECT_EQ(state_text(SiteState::Stopped, kReason, NoteCode::None), "STOPPED (peer stopped)");
  EXPECT_EQ(state_text(SiteState::Engaged, kReason, kRefused), "ENGAGED");
  EXPECT_EQ(state_text(SiteState::Clutched, kReason, NoteCode::None), "CLUTCHED");
  EXPECT_EQ(state_text(SiteState::Clutched, kReason, kRefused),
            "CLUTCHED (engagement refused: contact force too high)");
  EXPECT_EQ(state_text(SiteState::Clutched, NoteCode::TickLate, NoteCode::None),
            "CLUTCHED (this site's program stood still: press the pedal again)");
}

}  // namespace
}  // namespace palp::record
