#include "study/data_fit.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/core/formatted.h"
#include "common/core/random.h"
#include "study/block.h"
#include "tests/study/study_fixture.h"

namespace palp::study {
namespace {

/// Rows of a study whose participants have a JND of their own in each condition.
std::vector<ParticipantRows> answered(const Study& study,
                                      const std::vector<double>& jnd,
                                      double lapse = 0) {
  const AnswerTable table = table_of(study);
  std::vector<ParticipantRows> out;
  for (std::size_t p = 0; p < study.participants; ++p) {
    ParticipantRows of{participant_id(p), {}};
    std::size_t number = 0;
    for (const BlockPlan& plan : participant_plan(study, p)) {
      ++number;
      Block block{study, table, plan};
      while (!block.done()) {
        const TrialAsk ask = block.next();
        const ObserverTraits traits{.jnd = jnd[plan.condition], .pse = 0, .lapse = lapse};
        const bool yes = random_uniform(9, plan.stream, ask.number) <
                         answer_share(study.task, traits, ask.level);
        TrialRow row{.ask = ask,
                     .condition = condition_code(plan.condition),
                     .block = number,
                     .task = study.task};
        const std::size_t asked = study.task.two_sided ? 1 : ask.stronger;
        row.outcome.chosen = yes ? asked : (asked + 1) % choices(study.task);
        block.told(row.yes());
        of.rows.push_back(row);
      }
    }
    out.push_back(of);
  }
  return out;
}

Study two_conditions() {
  return *parse_study("participants: 16 condition { name: \"near\" } condition { name: \"far\" }",
                      "study");
}

TEST(DataFitTest, FindsWhatTheConditionsDiffer) {
  const Study study = two_conditions();
  const StudyFit fit = fit_study(study, answered(study, {0.10, 0.20}));
  EXPECT_TRUE(fit.excluded.empty());
  const auto pairs = compare_study(study, fit, Measure::Jnd);
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0].participants, 16U);
  EXPECT_LT(pairs[0].test.low, std::log(2.0));
  EXPECT_GT(pairs[0].test.high, std::log(2.0));
  EXPECT_LT(pairs[0].p_holm, 1e-3);
  EXPECT_GT(pairs[0].test.equivalent, 0.5);
}

// 16 observers, 60 answers each: the mean of ln JND has a standard deviation of 0.05.
TEST(DataFitTest, FindsTheJndWhereThreeAreFelt) {
  Study study = two_conditions();
  study.task.intervals = 3;
  const StudyFit fit = fit_study(study, answered(study, {0.10, 0.20}));
  for (const auto& [condition, jnd] : {std::pair{0U, 0.10}, std::pair{1U, 0.20}}) {
    double mean = 0;
    for (const auto& one : counted(fit, condition)) mean += one.ln_jnd.mean / 16;
    EXPECT_NEAR(mean, std::log(jnd), 0.15) << condition;
  }
}

TEST(DataFitTest, EqualConditionsAreNotTold) {
  const Study study = two_conditions();
  const auto pairs =
      compare_study(study, fit_study(study, answered(study, {0.15, 0.15})), Measure::Jnd);
  EXPECT_GT(pairs.at(0).test.p, 0.05);
}

TEST(DataFitTest, WhoDoesNotAttendIsLeftOut) {
  Study study = two_conditions();
  study.participants = 4;
  study.practice.right = 0;
  auto rows = answered(study, {0.15, 0.15});
  for (TrialRow& row : rows[2].rows) {
    if (row.ask.kind == TrialKind::Catch) row.outcome.chosen = 1 - row.ask.stronger;
  }
  const StudyFit fit = fit_study(study, rows);
  ASSERT_EQ(fit.excluded.size(), 1U);
  EXPECT_EQ(fit.excluded[0].id, "sub-03");
  EXPECT_EQ(counted(fit, 0).size(), 3U);
  EXPECT_EQ(compare_study(study, fit, Measure::Jnd).at(0).participants, 3U);
}

TEST(DataFitTest, WhoCannotPractiseIsLeftOutAndAnUnfinishedBlockDoesNotCount) {
  Study study = two_conditions();
  study.participants = 3;
  auto rows = answered(study, {0.15, 0.15});
  rows[1].rows.resize(rows[1].rows.size() - 1);
  const AnswerTable table = table_of(study);
  const auto plans = participant_plan(study, 2);
  rows[2].rows.clear();
  for (Block block{study, table, plans[0]}; !block.done();) {
    TrialRow row{.ask = block.next(), .condition = condition_code(plans[0].condition)};
    row.block = 1;
    row.outcome.chosen = 1 - row.ask.stronger;
    block.told(row.yes());
    rows[2].rows.push_back(row);
  }
  const StudyFit fit = fit_study(study, rows);
  ASSERT_EQ(fit.excluded.size(), 1U);
  EXPECT_EQ(fit.excluded[0].id, "sub-03");
  EXPECT_EQ(counted(fit, 0).size() + counted(fit, 1).size(), 3U);
  EXPECT_TRUE(compare_study(study, fit, Measure::Jnd).empty());  // one is no group
}

TEST(DataFitTest, TheTableHasALineForEachParticipantAndCondition) {
  Study study = two_conditions();
  study.participants = 2;
  study.trials = 4;
  const StudyFit fit = fit_study(study, answered(study, {0.1, 0.1}));
  const std::string text = fit_table(study, fit, condition_codes(study), true);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 5);
  EXPECT_EQ(text.find("near"), std::string::npos);
  EXPECT_NE(text.find("sub-02\tA\t"), std::string::npos);
}

// Touches and forces tell conditions that differ in them; of nobody's answers nothing is known.
TEST(DataFitTest, TheTableOfASearchIsBlindAndSaysNothingWithoutAnswers) {
  const Study study = *parse_study(
      "task: \"locate\" participants: 1 trials: 4 practice { right: 0 } condition { name: \"one\" "
      "} "
      "condition { name: \"two\" } ball { radius_mm: 8 ratio: 100 } depth { top_mm: 5 contrast_ln: "
      "0.4 } depth { top_mm: 9 contrast_ln: 0.2 }",
      "s");
  auto rows = answered(study, {0.1, 0.1});
  std::erase_if(rows[0].rows, [](const TrialRow& row) { return row.condition == "B"; });
  for (std::size_t i = 0; i < rows[0].rows.size(); ++i) {
    rows[0].rows[i].outcome.error = i % 2 == 0 ? 2e-3 : 8e-3;
    rows[0].rows[i].outcome.response_time = 10;
  }
  std::erase_if(rows[0].rows, [](const TrialRow& row) { return row.ask.kind != TrialKind::Trial; });
  const StudyFit fit = fit_study(study, rows);
  const std::string blind = fit_table(study, fit, condition_codes(study), true);
  EXPECT_EQ(blind.find("contacts"), std::string::npos);
  EXPECT_EQ(blind.find("force"), std::string::npos);
  EXPECT_NE(fit_table(study, fit, condition_codes(study), false).find("contacts"),
            std::string::npos);
  EXPECT_NE(blind.find("sub-01\tB\t0\t0\tn/a\tn/a"), std::string::npos) << blind;
  EXPECT_NE(condition_text(study, fit, 0, "A").find("error 4.0 mm in 10.0 s"), std::string::npos);
}

// Who is at chance in both conditions is not shown to be equal in them.
TEST(DataFitTest, NothingIsCalledEqualOfWhatIsHardlyKnown) {
  Study study = two_conditions();
  study.participants = 6;
  const auto all = answered(study, {0.15, 0.15});
  EXPECT_LE(compare_study(study, fit_study(study, all), Measure::Jnd).at(0).test.equivalent, 1);
  study.levels = even_levels(0.005, 0.01, 5);
  study.catch_share = 0;
  study.practice.right = 0;
  const auto none = answered(study, {0.1, 0.4});
  const auto pairs = compare_study(study, fit_study(study, none), Measure::Jnd);
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_TRUE(std::isnan(pairs[0].test.equivalent));
}

TEST(DataFitTest, ARankingOfBallsSaysWhereTheThreeLie) {
  const Study study = *parse_study(
      "task: \"rank\" participants: 2 condition { name: \"one\" } ball { radius_mm: 8 ratio: 100 } "
      "levels { to_ln: 0.18 } depth { top_mm: 5 contrast_ln: 0.42 } depth { top_mm: 10 "
      "contrast_ln: "
      "0.13 } depth { top_mm: 20 contrast_ln: 0.02 }",
      "s");
  const StudyFit fit = fit_study(study, answered(study, {0.08}));
  const std::string text = condition_text(study, fit, 0, "A");
  EXPECT_NE(text.find("in order at "), std::string::npos) << text;
  EXPECT_NE(text.find(formatted("%.1f", 1e3 * *depth_of(study, middle_contrast(study)))),
            std::string::npos);
}

}  // namespace
}  // namespace palp::study
