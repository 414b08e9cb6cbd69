#include "study/person_trial.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp::study {
namespace {

constexpr Duration kMs = std::chrono::milliseconds{1};
constexpr Place kFirst{3e-3, 0};
constexpr Place kSecond{0, 5e-3};
constexpr Place kDecoy{-9e-3, -9e-3};

/// A trial, its time, and a stage that is where it is sent.
struct Rig {
  PersonTrial trial{{.places = {kFirst, kSecond}, .decoy = kDecoy, .taps = 1}};
  TimePoint now{std::chrono::seconds{100}};
  SiteNews news{};
  bool stuck{};

  void pass(Duration span, std::optional<std::size_t> answer = std::nullopt) {
    for (const TimePoint end = now + span; now < end; now += kMs) {
      trial.tick(now, news, answer);
      if (trial.place() && !stuck) news.stands = trial.place()->place;
    }
  }
  void tap() {
    news.contact_force = news.force = 0.6;
    pass(200 * kMs);
    news.contact_force = news.force = 0;
    pass(85 * kMs);  // a touch that has ended for so long is one
  }
  void to_the_question() {
    news.engaged = true;
    for (int interval = 0; interval < 2; ++interval) {
      pass(1505 * kMs);
      tap();
    }
  }
};

TEST(PersonTrialTest, WaitsForAHandThatIsEngagedAndClear) {
  Rig rig;
  rig.pass(5000 * kMs);
  EXPECT_EQ(rig.trial.stage(), PersonStage::Press);
  EXPECT_FALSE(rig.trial.place());
  rig.news = {.engaged = true, .contact_force = 0.3};
  rig.pass(5000 * kMs);
  EXPECT_EQ(rig.trial.stage(), PersonStage::Lift);
  EXPECT_FALSE(rig.trial.place()) << "nothing travels while the tip is in the tissue";
  rig.news.contact_force = 0;
  rig.pass(kMs);
  EXPECT_EQ(rig.trial.stage(), PersonStage::Travel);
  EXPECT_EQ(rig.trial.place(), StagePlace{kDecoy});
}

TEST(PersonTrialTest, GoesByTheDecoyToEachPlaceAndAsks) {
  Rig rig;
  rig.news.engaged = true;
  rig.pass(1000 * kMs);
  EXPECT_EQ(rig.trial.place(), StagePlace{kFirst});
  rig.pass(505 * kMs);
  EXPECT_EQ(rig.trial.stage(), PersonStage::Touch);
  rig.tap();
  EXPECT_EQ(rig.trial.stage(), PersonStage::Travel);
  EXPECT_EQ(rig.trial.interval(), 1U);
  EXPECT_EQ(rig.trial.place(), StagePlace{kDecoy});
  rig.pass(1503 * kMs);
  EXPECT_EQ(rig.trial.place(), StagePlace{kSecond});
  rig.tap();
  EXPECT_EQ(rig.trial.stage(), PersonStage::Answer);
  rig.news.engaged = false;  // the same hand presses a button
  rig.pass(300 * kMs);
  rig.pass(kMs, 1);
  ASSERT_EQ(rig.trial.stage(), PersonStage::Done);
  const TrialOutcome out = rig.trial.outcome(rig.now);
  EXPECT_EQ(out.chosen, 1U);
  EXPECT_EQ(out.taps, 2);
  EXPECT_DOUBLE_EQ(out.force_max, 0.6);
  EXPECT_NEAR(out.response_time, 0.301, 0.005);
  EXPECT_NEAR(out.duration, seconds(rig.now - TimePoint{std::chrono::seconds{100}}), 1e-9);
  EXPECT_EQ(rig.trial.attempts(), 1U);
}

TEST(PersonTrialTest, WhoLetsGoBeginsItAnewAndWaitingCounts) {
  Rig rig;
  rig.news.engaged = true;
  rig.pass(1600 * kMs);
  rig.news.engaged = false;
  rig.pass(3000 * kMs);
  EXPECT_EQ(rig.trial.stage(), PersonStage::Press);
  EXPECT_EQ(rig.trial.notice(), PersonNotice::LetGo);
  rig.to_the_question();
  EXPECT_EQ(rig.trial.attempts(), 2U);
  rig.pass(kMs, 0);
  const TrialOutcome out = rig.trial.outcome(rig.now);
  EXPECT_EQ(out.taps, 2) << "of the last attempt";
  EXPECT_GT(out.duration, 4.6);
}

// Else a place that was not reached would be judged for another.
TEST(PersonTrialTest, AStageThatDidNotComeInTimeBeginsItAnew) {
  Rig rig;
  rig.news.engaged = true;
  rig.stuck = true;
  rig.pass(1505 * kMs);
  EXPECT_EQ(rig.trial.notice(), PersonNotice::HeldUp);
  EXPECT_EQ(rig.trial.stage(), PersonStage::Travel);
  EXPECT_EQ(rig.trial.attempts(), 2U);
}

TEST(PersonTrialTest, AnAnswerBeforeTheQuestionIsNone) {
  Rig rig;
  rig.news.engaged = true;
  rig.pass(1505 * kMs, 0);
  rig.to_the_question();
  EXPECT_EQ(rig.trial.stage(), PersonStage::Answer);
}

/// From kFirst on.
PersonTrial search_for(const Place& axis, Duration limit) {
  TrialTimes times;
  times.searches = true;
  times.explore_max = limit;
  return PersonTrial{{.places = {kFirst},
                      .choices = 1,
                      .decoy = kDecoy,
                      .times = times,
                      .hidden = HiddenAxis{axis, 20e-3, 8e-3}}};
}

TEST(PersonTrialTest, ASearchHasTheHandsOwnWayAndIsJudgedByWhereTheTipStands) {
  Rig rig;
  const Place axis{kFirst.x + 12e-3, kFirst.y - 5e-3};
  rig.trial = search_for(axis, std::chrono::seconds{60});
  rig.news.engaged = true;
  rig.pass(1400 * kMs);
  EXPECT_EQ(rig.trial.place(), StagePlace{kFirst});
  EXPECT_FALSE(rig.trial.asks());
  rig.pass(200 * kMs);
  EXPECT_EQ(rig.trial.stage(), PersonStage::Touch);
  EXPECT_EQ(rig.trial.place(), (StagePlace{kFirst, 20e-3}));
  EXPECT_TRUE(rig.trial.asks());
  rig.stuck = true;  // from here on the hand moves the stage
  for (int i = 0; i < 16; ++i) {
    rig.news.stands.x += 1e-3;
    rig.news.contact_force = i % 2 == 0 ? 0.4 : 0.8;
    rig.pass(kMs);
  }
  rig.news.contact_force = 0;
  rig.news.engaged = false;  // who lets go searches on
  rig.pass(100 * kMs);
  EXPECT_EQ(rig.trial.stage(), PersonStage::Touch);
  rig.pass(kMs, 0);
  ASSERT_EQ(rig.trial.stage(), PersonStage::Done);
  const TrialOutcome out = rig.trial.outcome(rig.now);
  EXPECT_NEAR(out.error, std::hypot(4e-3, 5e-3), 1e-9);
  EXPECT_EQ(out.chosen, 0U);
  EXPECT_NEAR(out.path, 16e-3, 1e-9);
  EXPECT_NEAR(out.force_mean, 0.6, 1e-9);
}

// A sensor's steps about the border, and a tip that is drawn out slowly, make no touches of one.
TEST(PersonTrialTest, OneTouchIsOneWhateverTheNoise) {
  Rig rig;
  rig.news.engaged = true;
  rig.pass(1505 * kMs);
  for (int i = 0; i < 60; ++i) {
    rig.news.contact_force = i % 3 == 0 ? 0.15 : i % 3 == 1 ? 0.05 : 0;
    rig.pass(20 * kMs);
  }
  EXPECT_EQ(rig.trial.interval(), 0U) << "it has not ended";
  rig.news.contact_force = 0;
  rig.pass(90 * kMs);
  EXPECT_EQ(rig.trial.stage(), PersonStage::Travel);
  EXPECT_EQ(rig.trial.interval(), 1U);
}

TEST(PersonTrialTest, ASearchThatNobodyMadeBeginsAnew) {
  Rig rig;
  rig.trial = search_for(kFirst, std::chrono::seconds{5});
  rig.news.engaged = true;
  rig.pass(2000 * kMs);
  rig.pass(kMs, 0);
  EXPECT_EQ(rig.trial.stage(), PersonStage::Press);
  EXPECT_EQ(rig.trial.notice(), PersonNotice::Untouched);
  rig.pass(2000 * kMs);
  rig.tap();
  rig.pass(kMs, 0);
  EXPECT_EQ(rig.trial.stage(), PersonStage::Done);
}

}  // namespace
}  // namespace palp::study
