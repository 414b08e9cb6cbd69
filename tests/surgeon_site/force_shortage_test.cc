#include "surgeon_site/force_shortage.h"

#include <gtest/gtest.h>

namespace palp::surgeon {
namespace {

using record::NoteCode;
using std::chrono_literals::operator""ms;

/// A hand at rest that is given 1 N, as the tip measures.
ForceShortage::Look whole() {
  return {.state = SiteState::Engaged,
          .tip = {.given = 1, .measured = 1, .position = 2e-3, .tip = 2e-3, .round_trip = 0.05}};
}

void run(ForceShortage& shortage, const ForceShortage::Look& look, Duration lasts) {
  for (Duration at{0}; at < lasts; at += 1ms) shortage.look(look, {}, 1ms);
}

TEST(ForceShortageTest, AWholeForceIsNotCalledShort) {
  ForceShortage shortage;
  run(shortage, whole(), 3000ms);
  EXPECT_EQ(shortage.why(), NoteCode::None);
  EXPECT_EQ(shortage.by(), 0);
}

TEST(ForceShortageTest, SaysWhatTheLawLacksAndWhatHelps) {
  ForceShortage::Look look = whole();
  look.missing = 0.3;
  look.too_stiff = 0.1;
  ForceShortage shortage;
  run(shortage, look, 250ms);
  EXPECT_EQ(shortage.why(), NoteCode::None) << "a model comes in";
  run(shortage, look, 100ms);
  EXPECT_EQ(shortage.why(), NoteCode::ForceIncomplete);
  EXPECT_DOUBLE_EQ(shortage.by(), 0.4);
  look.missing = 0.08;
  run(shortage, look, 100ms);
  EXPECT_EQ(shortage.why(), NoteCode::ForceIncomplete) << "nearly the same";
  look.missing = 0;
  run(shortage, look, 100ms);
  EXPECT_EQ(shortage.why(), NoteCode::TissueTooStiff) << "to lift does not help";
  run(shortage, whole(), 150ms);
  EXPECT_EQ(shortage.why(), NoteCode::None);
}

TEST(ForceShortageTest, FivePercentOfALargeForceAreNotFelt) {
  ForceShortage::Look look = whole();
  look.tip.given = look.tip.measured = 2;
  look.too_stiff = 0.08;
  ForceShortage shortage;
  run(shortage, look, 1000ms);
  EXPECT_EQ(shortage.why(), NoteCode::None);
  look.too_stiff = 0.15;
  run(shortage, look, 1000ms);
  EXPECT_EQ(shortage.why(), NoteCode::TissueTooStiff);
}

TEST(ForceShortageTest, TheTipSpeaksWhereTheLawDoesNotKnow) {
  ForceShortage::Look look = whole();
  look.tip.measured = 1.4;
  ForceShortage shortage;
  run(shortage, look, 400ms);
  EXPECT_EQ(shortage.why(), NoteCode::TipFeelsMore);
  EXPECT_NEAR(shortage.by(), 0.4, 5e-3);
  look.missing = 0.4;
  run(shortage, look, 400ms);
  EXPECT_EQ(shortage.why(), NoteCode::ForceIncomplete) << "the law knows why";
}

TEST(ForceShortageTest, ATipThatIsNotThereCannotSay) {
  ForceShortage::Look look = whole();
  look.apart = 5e-3;
  ForceShortage shortage;
  run(shortage, look, 400ms);
  EXPECT_EQ(shortage.why(), NoteCode::TipElsewhere);
  EXPECT_EQ(shortage.by(), 0);
  run(shortage, whole(), 200ms);
  EXPECT_EQ(shortage.why(), NoteCode::None);
  look.tip.given = look.tip.measured = 0;
  run(shortage, look, 400ms);
  EXPECT_EQ(shortage.why(), NoteCode::None) << "nobody touches";
}

TEST(ForceShortageTest, InHoldWhatWasSaidStaysAndWithoutTouchNothingDoes) {
  ForceShortage::Look look = whole();
  look.tip.measured = 1.4;
  ForceShortage shortage;
  run(shortage, look, 400ms);
  look.state = SiteState::Hold;
  run(shortage, look, 700ms);
  EXPECT_EQ(shortage.why(), NoteCode::TipFeelsMore) << "no news came";
  look.state = SiteState::Clutched;
  run(shortage, look, 1ms);
  EXPECT_EQ(shortage.why(), NoteCode::None);
  EXPECT_EQ(shortage.by(), 0);
}

/// The hand goes deeper while nothing is heard: what the tip measures after that is no more than
/// the hand was given then.
TEST(ForceShortageTest, WhatIsMeasuredAfterAHoldIsNotHeldAgainstWhatWasGivenBefore) {
  ForceShortage::Look look = whole();
  look.tip.round_trip = 0.3;
  ForceShortage shortage;
  run(shortage, look, 1000ms);
  look.state = SiteState::Hold;
  run(shortage, look, 300ms);
  look.state = SiteState::Engaged;
  look.tip.given = look.tip.measured = 1.4;
  for (int i = 0; i < 50; ++i) {
    run(shortage, look, 20ms);
    EXPECT_EQ(shortage.why(), NoteCode::None) << 20 * i << " ms";
  }
}

}  // namespace
}  // namespace palp::surgeon
