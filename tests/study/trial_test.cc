#include "study/trial.h"

#include <gtest/gtest.h>

namespace palp::study {
namespace {

constexpr Duration kMs = std::chrono::milliseconds{1};

/// A trial and its time.
struct Rig {
  Trial trial{2, 2, false, TrialTimes{}};
  TimePoint now{};

  void pass(Duration span, const TrialInput& in = {}) {
    for (const TimePoint end = now + span; now < end; now += kMs) trial.tick(now, in);
  }
  void taps(int count) {
    for (int i = 0; i < count; ++i) {
      pass(100 * kMs, {.force = -0.7, .contact = true});
      pass(100 * kMs);
    }
  }
  void to_the_question() {
    for (int interval = 0; interval < 2; ++interval) {
      pass(1501 * kMs);
      taps(2);
    }
  }
};

TEST(TrialTest, GoesFromPlaceToPlaceAndAsks) {
  Rig rig;
  rig.pass(1500 * kMs);
  EXPECT_EQ(rig.trial.stage(), TrialStage::Travel);
  rig.pass(kMs);
  EXPECT_EQ(rig.trial.stage(), TrialStage::Explore);
  rig.taps(1);
  EXPECT_EQ(rig.trial.stage(), TrialStage::Explore);
  rig.taps(1);
  EXPECT_EQ(rig.trial.stage(), TrialStage::Travel);
  EXPECT_EQ(rig.trial.interval(), 1U);
  rig.pass(1501 * kMs);
  rig.taps(2);
  EXPECT_EQ(rig.trial.stage(), TrialStage::Answer);
  rig.pass(700 * kMs);
  rig.pass(kMs, {.answer = 1});
  EXPECT_EQ(rig.trial.stage(), TrialStage::Done);
  EXPECT_EQ(rig.trial.answer(), 1U);
  EXPECT_EQ(rig.trial.taps(), 4);
  EXPECT_DOUBLE_EQ(rig.trial.force_max(), 0.7);
  EXPECT_EQ(rig.trial.contact(), 400 * kMs);
  EXPECT_NEAR(seconds(rig.trial.response_time()), 0.8, 0.002);  // the pause after the last tap too
}

TEST(TrialTest, HasAsManyIntervalsAsWanted) {
  Rig rig{.trial = {3, 2, false, TrialTimes{}}};
  rig.to_the_question();
  EXPECT_EQ(rig.trial.stage(), TrialStage::Travel);
  EXPECT_EQ(rig.trial.interval(), 2U);
  rig.pass(1501 * kMs);
  rig.taps(2);
  EXPECT_EQ(rig.trial.stage(), TrialStage::Answer);
  EXPECT_EQ(rig.trial.taps(), 6);
  rig.pass(kMs, {.answer = 3});  // there is none
  EXPECT_EQ(rig.trial.stage(), TrialStage::Answer);
  rig.pass(kMs, {.answer = 2});
  EXPECT_EQ(rig.trial.stage(), TrialStage::Done);
  EXPECT_EQ(rig.trial.answer(), 2U);
}

TEST(TrialTest, TravelsAsLongByWhateverDecoyAndIsThereInTheSecondHalf) {
  Rig rig;
  rig.pass(700 * kMs);
  EXPECT_TRUE(rig.trial.by_decoy(rig.now));
  rig.pass(100 * kMs);
  EXPECT_FALSE(rig.trial.by_decoy(rig.now));
}

TEST(TrialTest, AnAnswerBeforeTheQuestionIsNone) {
  Rig rig;
  rig.pass(1501 * kMs, {.answer = 1});
  rig.taps(2);
  rig.pass(1501 * kMs, {.answer = 1});
  rig.taps(2);
  EXPECT_EQ(rig.trial.stage(), TrialStage::Answer);
  EXPECT_FALSE(rig.trial.answer());
}

TEST(TrialTest, WhoNeverTapsIsAskedAllTheSame) {
  Rig rig;
  rig.pass(2 * (1500 + 8000) * kMs + 2 * kMs);
  EXPECT_EQ(rig.trial.stage(), TrialStage::Answer);
  EXPECT_EQ(rig.trial.taps(), 0);
}

// A hand that rests in the tissue when its time is up has not tapped: its next interval begins
// anew.
TEST(TrialTest, ALastTapIsCountedOnceOutOfTheTissue) {
  Rig rig;
  rig.pass(1501 * kMs);
  rig.taps(1);
  rig.pass(2000 * kMs, {.force = 1, .contact = true});
  EXPECT_EQ(rig.trial.stage(), TrialStage::Explore);
  rig.pass(kMs);
  EXPECT_EQ(rig.trial.stage(), TrialStage::Travel);
}

TEST(TrialTest, WhoLetsGoOfThePedalBeforeTheQuestionEndsIt) {
  for (const int ms : {10, 1600, 3000}) {
    Rig rig;
    rig.pass(ms * kMs);
    rig.pass(kMs, {.pedal = false});
    EXPECT_EQ(rig.trial.stage(), TrialStage::Ended) << ms;
    rig.pass(20000 * kMs, {.answer = 1});
    EXPECT_EQ(rig.trial.stage(), TrialStage::Ended);
    EXPECT_FALSE(rig.trial.answer());
  }
}

TEST(TrialTest, WhoAnswersNeedNotHoldThePedal) {
  Rig rig;
  rig.to_the_question();
  rig.pass(500 * kMs, {.pedal = false});
  EXPECT_EQ(rig.trial.stage(), TrialStage::Answer);
  rig.pass(kMs, {.pedal = false, .answer = 1});
  EXPECT_EQ(rig.trial.stage(), TrialStage::Done);
}

TEST(TrialTest, PracticeShowsWhetherItWasRight) {
  Rig rig{.trial = {2, 2, true, TrialTimes{}}};
  rig.to_the_question();
  rig.pass(kMs, {.answer = 0});
  EXPECT_EQ(rig.trial.stage(), TrialStage::Told);
  rig.pass(1001 * kMs);
  EXPECT_EQ(rig.trial.stage(), TrialStage::Done);
}

TrialTimes search_times() {
  TrialTimes times;
  times.searches = true;
  times.explore_max = std::chrono::seconds{30};
  return times;
}

// However often it taps or lets go: only an answer ends a search, or the time.
TEST(TrialTest, ASearchGoesOnUntilItIsAnswered) {
  Rig rig{.trial = {1, 1, false, search_times(), 1}};
  rig.pass(1501 * kMs);
  rig.taps(5);
  rig.pass(500 * kMs, {.pedal = false});
  rig.taps(3);
  EXPECT_EQ(rig.trial.stage(), TrialStage::Explore);
  rig.pass(kMs, {.answer = 1});
  EXPECT_EQ(rig.trial.stage(), TrialStage::Explore) << "there is one answer";
  rig.pass(kMs, {.answer = 0});
  EXPECT_EQ(rig.trial.stage(), TrialStage::Done);
  EXPECT_EQ(rig.trial.taps(), 8);
  EXPECT_NEAR(seconds(rig.trial.response_time()), 2.1, 0.01);
}

TEST(TrialTest, ASearchThatTakesTooLongIsAskedForItsPlace) {
  Rig rig{.trial = {1, 1, true, search_times(), 1}};
  rig.pass(1501 * kMs, {.pedal = true});
  rig.pass(30'001 * kMs);
  EXPECT_EQ(rig.trial.stage(), TrialStage::Answer);
  rig.pass(500 * kMs, {.pedal = false});
  rig.pass(kMs, {.answer = 0});
  EXPECT_EQ(rig.trial.stage(), TrialStage::Told);
  EXPECT_NEAR(seconds(rig.trial.response_time()), 30.5, 0.01);
}

TEST(TrialTest, ASearchIsGivenAgainWhereTheHandLetsGoOnTheWay) {
  Rig rig{.trial = {1, 1, false, search_times(), 1}};
  rig.pass(700 * kMs);
  rig.pass(kMs, {.pedal = false});
  EXPECT_EQ(rig.trial.stage(), TrialStage::Ended);
}

}  // namespace
}  // namespace palp::study
