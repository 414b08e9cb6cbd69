#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "common/core/random.h"
#include "study/compare_command.h"
#include "study/exports.h"
#include "study/report_command.h"
#include "study/trial.h"
#include "tests/study/study_fixture.h"

/// The tasks of detection, from plan to export.
namespace palp::study {
namespace {

const std::string kDepths =
    "depth { top_mm: 5 contrast_ln: 0.44 } depth { top_mm: 8 contrast_ln: 0.22 } "
    "depth { top_mm: 10 contrast_ln: 0.14 } depth { top_mm: 15 contrast_ln: 0.06 } "
    "depth { top_mm: 20 contrast_ln: 0.03 } ";

std::string study_text(const std::string& task, const std::string& more = "") {
  return "name: \"found\" seed: 3 participants: 24 trials: 120 task: \"" + task + "\" " + kDepths +
         more + " condition { name: \"silk\" } condition { name: \"wool\" }";
}
const std::string kDetect = study_text("detect", "method: \"constant\"");

TEST(DetectionTest, DepthsAreLevelsAndWhatLiesBetweenThem) {
  const Study study = *parse_study(study_text("detect2"), "s");
  EXPECT_EQ(study.levels, (std::vector<double>{0.03, 0.06, 0.14, 0.22, 0.44}));
  EXPECT_NEAR(depth_of(study, 0.14).value(), 10e-3, 1e-12);
  EXPECT_NEAR(depth_of(study, std::sqrt(0.14 * 0.22)).value(), 9e-3, 1e-12);
  EXPECT_FALSE(depth_of(study, 0.029));
  EXPECT_FALSE(depth_of(study, 0.45));
  EXPECT_NEAR(depth_found(study, 0.14).value(), 10e-3, 1e-12);
  const Study yes_no = *parse_study(kDetect, "s");
  EXPECT_EQ(yes_no.levels.front(), 0);
  EXPECT_NEAR(depth_found(yes_no, 0.14 * 0.674489750196).value(), 10e-3, 1e-9);
}

TEST(DetectionTest, ADepthThatIsNoneIsASentence) {
  const std::string one = "condition { name: \"one\" } ";
  for (const char* wrong :
       {"task: \"detect2\"",
        "task: \"detect2\" depth { top_mm: 5 contrast_ln: 0.3 }",
        "task: \"detect2\" depth { top_mm: 5 contrast_ln: 0.2 } "
        "depth { top_mm: 9 contrast_ln: 0.2 }",
        "depth { top_mm: 5 contrast_ln: 0.3 } depth { top_mm: 9 contrast_ln: 0.2 }"}) {
    EXPECT_FALSE(parse_study(one + wrong, "s")) << wrong;
  }
  EXPECT_FALSE(parse_study(study_text("detect"), "s")) << "quest-plus chooses its blanks";
  EXPECT_FALSE(parse_study(study_text("detect2", "intervals: 3"), "s"));
}

TEST(DetectionTest, HalfOfTheTrialsHoldNothingAndCatchTrialsAlwaysSomething) {
  const Study study = *parse_study(kDetect, "s");
  const AnswerTable table = table_of(study);
  const auto plans = participant_plan(study, 0);
  Block block{study, table, plans.front()};
  std::map<double, int> asked;
  int nothing = 0;
  while (!block.done()) {
    const TrialAsk ask = block.next();
    EXPECT_EQ(ask.level > 0, ask.stronger == 1);
    if (ask.kind == TrialKind::Catch) {
      EXPECT_EQ(ask.level, 0.44);
    }
    if (ask.kind == TrialKind::Trial) {
      nothing += ask.level == 0 ? 1 : 0;
      ++asked[ask.level];
    }
    block.told(ask.stronger == 1);
  }
  EXPECT_NEAR(nothing, 60, 5);
  for (const double level : {0.03, 0.06, 0.14, 0.22, 0.44}) EXPECT_NEAR(asked[level], 12, 2);
}

TEST(DetectionTest, ATrialOfYesOrNoHasOneIntervalAndTwoAnswers) {
  Trial trial{1, 1, false, TrialTimes{}, 2};
  TimePoint now{};
  const auto pass = [&](int ms, const TrialInput& in) {
    for (int i = 0; i < ms; ++i) trial.tick(now += std::chrono::milliseconds{1}, in);
  };
  pass(1502, {});
  pass(100, {.contact = true});
  pass(2, {});
  EXPECT_EQ(trial.stage(), TrialStage::Answer);
  pass(1, {.answer = 2});
  EXPECT_EQ(trial.stage(), TrialStage::Answer);
  pass(1, {.answer = 1});
  EXPECT_EQ(trial.stage(), TrialStage::Done);
}

/// Mean over those who count.
template <class Value>
double mean_of(const StudyFit& fit, Value value) {
  double sum = 0;
  const auto blocks = counted(fit, 0);
  for (const FittedBlock& one : blocks) sum += value(one);
  return sum / static_cast<double>(blocks.size());
}

// Who tells stiffness apart with a Weber fraction of 15 % has a JND of 0.140 in two intervals and
// finds a ball where its contrast is that. 24 people, 240 answers each: the standard error of the
// mean of ln JND is 0.02 of fitting and 0.25/sqrt(24) = 0.05 of people, which are drawn.
TEST(DetectionTest, TheDepthOfTwoIntervalsIsThatOfTheJnd) {
  const test::PlannedFolder folder{study_text("detect2")};
  ASSERT_EQ(folder.planned().code, config::ExitCode::Done) << folder.planned().text;
  ASSERT_EQ(folder.run().code, config::ExitCode::Done);
  const auto planned = *open_study(folder.folder());
  const StudyFit fit = fit_study(planned.study, *read_rows(planned));
  double drawn = 0;
  for (std::size_t i = 0; i < 24; ++i) drawn += drawn_ln_jnd({}, planned.study.seed, i) / 24;
  EXPECT_NEAR(mean_of(fit, [](const FittedBlock& one) { return one.ln_jnd.mean; }), drawn, 0.08);
  const auto end = run_fit_study(folder.folder(), "");
  EXPECT_NE(end.text.find("found down to "), std::string::npos) << end.text;
}

// d' over all depths and criterion of people who are known, by the shares that their functions
// give: 24 people, 120 answers each: standard errors 0.06 and 0.03, here within three of them.
TEST(DetectionTest, SensitivityAndCriterionAreThoseOfThePeople) {
  const test::PlannedFolder folder{kDetect};
  ASSERT_EQ(folder.planned().code, config::ExitCode::Done) << folder.planned().text;
  ASSERT_EQ(folder.run().code, config::ExitCode::Done);
  const auto planned = *open_study(folder.folder());
  const Study& study = planned.study;
  const StudyFit fit = fit_study(study, *read_rows(planned));
  double hits = 0;
  double alarms = 0;
  double truth = 0;
  double criterion = 0;
  for (std::size_t i = 0; i < 24; ++i) {
    const ObserverTraits traits = drawn_traits(study, {}, i);
    const std::vector<double> signals{study.levels.begin() + 1, study.levels.end()};
    hits = 0;
    for (const double level : signals) hits += answer_share(study.task, traits, level) / 5;
    alarms = answer_share(study.task, traits, 0);
    truth += (normal_quantile(hits) - normal_quantile(alarms)) / 24;
    criterion += -(normal_quantile(hits) + normal_quantile(alarms)) / 48;
  }
  EXPECT_NEAR(
      mean_of(fit, [](const FittedBlock& one) { return one.sensitivity->d_prime; }), truth, 0.18);
  EXPECT_NEAR(mean_of(fit, [](const FittedBlock& one) { return one.sensitivity->criterion; }),
              criterion,
              0.09);
  const auto end = run_fit_study(folder.folder(), "");
  EXPECT_NE(end.text.find(", d' "), std::string::npos) << end.text;
  EXPECT_EQ(run_compare(folder.folder()).code, config::ExitCode::Done);
  const auto report = run_report({.folder = folder.folder()});
  EXPECT_EQ(report.code, config::ExitCode::Done) << report.text;
  const auto lme4 = export_text("lme4", *read_rows(planned), {});
  ASSERT_TRUE(lme4);
  EXPECT_NE(lme4->find(",0,"), std::string::npos);
}

}  // namespace
}  // namespace palp::study
