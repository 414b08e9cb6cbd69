#include "study/real_sites/person_view.h"

#include <gtest/gtest.h>

#include "common/config/json.h"

namespace palp::study {
namespace {

using config::Json;

Study study_of(const std::string& more = "") {
  return *parse_study("name: \"s\" condition { name: \"silk\" taps: 2 } " + more, "s");
}

PersonTrial at_the_start(bool practice = false) {
  return PersonTrial{{.places = {{}, {1e-3, 0}}, .taps = 2, .practice = practice}};
}

TEST(PersonViewTest, SaysWhatToDoAndHowFarItIs) {
  const Study study = study_of();
  const TrialAsk ask{.number = 12, .before = 4, .count = 64};
  const Json view = Json::parse(trial_view(study, ask, at_the_start(), {.number = 5}));
  EXPECT_EQ(view["stage"].text(), "press");
  EXPECT_EQ(view["trial"].number(), 5);
  EXPECT_EQ(view["place"].number(), 5);
  EXPECT_EQ(view["count"].number(), 64);
  EXPECT_EQ(view["interval"].number(), 1);
  EXPECT_EQ(view["taps"].number(), 2);
  EXPECT_EQ(view["choices"].parts().size(), 2U);
  EXPECT_FALSE(view.contains("right"));
  const Json three =
      Json::parse(trial_view(study_of("intervals: 3"), ask, at_the_start(), {.number = 5}));
  EXPECT_EQ(three["choices"].parts().size(), 3U);
}

// What a participant sees of two trials that differ in what lies where is the same.
TEST(PersonViewTest, TellsNothingOfWhatLiesWhere) {
  const Study study = study_of();
  const TrialAsk easy{.level = 1.2, .stronger = 0, .decoy = 1, .before = 4, .count = 64};
  TrialAsk hard{.kind = TrialKind::Catch, .level = 0.02, .stronger = 1, .decoy = 3};
  hard.before = 4;
  hard.count = 64;
  const std::string view = trial_view(study, easy, at_the_start(), {.number = 5, .right = true});
  EXPECT_EQ(view, trial_view(study, hard, at_the_start(), {.number = 5}));
  EXPECT_EQ(view.find("silk"), std::string::npos);
}

TEST(PersonViewTest, PracticeTellsWhetherItWasRight) {
  PersonTrial trial = at_the_start(true);
  TimePoint now{};
  for (int i = 0; i < 40'000 && trial.stage() != PersonStage::Told; ++i) {
    now += std::chrono::milliseconds{1};
    const Place stands = trial.place().value_or(StagePlace{}).place;
    trial.tick(now, {.engaged = true, .stands = stands}, std::size_t{1});
  }
  ASSERT_EQ(trial.stage(), PersonStage::Told);
  const TrialAsk ask{.kind = TrialKind::Practice, .number = 2};
  const Json view = Json::parse(trial_view(study_of(), ask, trial, {.number = 3, .right = true}));
  EXPECT_EQ(view["right"].truth(), true);
  EXPECT_EQ(view["practice"].truth(), true);
  EXPECT_EQ(view["place"].number(), 3);
}

TEST(PersonViewTest, TheForceIsDrawnWhereTheConditionSaysSo) {
  const TrialAsk ask{.level = 0.3};
  const auto draws = [&](bool draws_force) {
    const auto view = trial_view(study_of(), ask, at_the_start(), {.draws_force = draws_force});
    return Json::parse(view).at_or_null("draws_force").truth();
  };
  EXPECT_EQ(draws(true), true);
  EXPECT_EQ(draws(false), false);
}

TEST(PersonViewTest, EachTaskHasItsQuestionAndItsAnswers) {
  const std::string depths =
      "ball { radius_mm: 8 ratio: 100 } depth { top_mm: 5 contrast_ln: 0.42 } depth { top_mm: 10 "
      "contrast_ln: 0.13 } ";
  const auto view_of = [](const std::string& task) {
    return Json::parse(trial_view(study_of(task), {.level = 0.3}, at_the_start(), {.number = 1}));
  };
  const Json rank = view_of("task: \"rank\"");
  ASSERT_EQ(rank["choices"].parts().size(), 6U);
  EXPECT_EQ(rank["choices"].parts()[3].text(), "2 3 1");
  EXPECT_EQ(rank["intervals"].number(), 3);
  EXPECT_EQ(view_of("task: \"delay\"")["question"].text(), "Which place answered late?");
  const Json search = view_of("task: \"locate\" " + depths);
  EXPECT_EQ(search["choices"].parts().size(), 1U);
  EXPECT_EQ(search["side_mm"].number(), 40);
  EXPECT_EQ(search["intervals"].number(), 1);
  EXPECT_FALSE(rank.contains("side_mm"));
}

}  // namespace
}  // namespace palp::study
