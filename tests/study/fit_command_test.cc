#include "study/fit_command.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/config/json.h"
#include "study/simulated_observer.h"
#include "tests/study/study_fixture.h"

namespace palp::study {
namespace {

std::vector<Answers> answered(const Task& task,
                              const ObserverTraits& traits,
                              const std::vector<double>& levels) {
  const FormulaObserver person{.task = task, .traits = traits, .seed = 3, .stream = 1};
  std::vector<Answers> out;
  for (const double level : levels) {
    Answers at{level, 0, 200};
    for (std::size_t i = 0; i < at.trials; ++i) {
      at.yes += person.answer(level, out.size() * at.trials + i) ? 1U : 0U;
    }
    out.push_back(at);
  }
  return out;
}

TEST(FitCommandTest, FindsTheJndOfEachCondition) {
  const auto levels = even_levels(0.03, 0.9, 8);
  const auto statement =
      fit_statement({.conditions = {{"lan", answered({}, {.jnd = 0.12}, levels)},
                                    {"far", answered({}, {.jnd = 0.3}, levels)}}},
                    {});
  ASSERT_TRUE(statement) << statement.error().text;
  const auto report = config::Json::parse(statement->report);
  const auto conditions = report["conditions"].parts();
  ASSERT_EQ(conditions.size(), 2U);
  for (const auto& [index, truth] : {std::pair{0U, 0.12}, std::pair{1U, 0.3}}) {
    EXPECT_LT(*conditions[index]["jnd_ln_low"].number(), truth);
    EXPECT_GT(*conditions[index]["jnd_ln_high"].number(), truth);
    EXPECT_NEAR(std::log(*conditions[index]["jnd_ln"].number() / truth), 0, 0.15);
  }
}

TEST(FitCommandTest, WhereNothingWasThereNothingIsFitted) {
  const auto statement = fit_statement({.conditions = {{"lan", {{0, 5, 9}}}}}, {});
  ASSERT_FALSE(statement);
  EXPECT_NE(statement.error().text.find("every level is 0"), std::string::npos);
}

TEST(FitCommandTest, ALongNameHidesNoFigure) {
  const auto levels = even_levels(0.03, 0.9, 8);
  const auto answers = answered({}, {.jnd = 0.12}, levels);
  const auto statement = fit_statement({.conditions = {{std::string(300, 'a'), answers}}}, {});
  ASSERT_TRUE(statement);
  EXPECT_NE(statement->text.find(" 1600 "), std::string::npos) << statement->text;
}

TEST(FitCommandTest, FlagsThatDoNothingWithAFolderAreRefused) {
  const test::PlannedFolder folder;
  (void)folder.run();
  EXPECT_EQ(run_fit({.file = folder.folder()}).code, config::ExitCode::Done);
  for (const FitFlags& flags : {FitFlags{.file = folder.folder(), .intervals = 5},
                                FitFlags{.file = folder.folder(), .two_sided = true},
                                FitFlags{.file = folder.folder(), .curve = "normal"}}) {
    EXPECT_EQ(run_fit(flags).code, config::ExitCode::BadInput);
  }
}

TEST(FitCommandTest, FindsABiasWhereAnswersAreTwoSided) {
  const Task task{.two_sided = true};
  const auto answers =
      answered(task, {.jnd = 0.15, .pse = -0.1}, {-0.6, -0.3, -0.15, -0.05, 0.05, 0.15, 0.3, 0.6});
  const auto statement = fit_statement({.conditions = {{"", answers}}}, {.two_sided = true});
  ASSERT_TRUE(statement) << statement.error().text;
  const auto report = config::Json::parse(statement->report);
  EXPECT_NEAR(*report["conditions"].parts()[0]["pse_ln"].number(), -0.1, 0.03);
  EXPECT_FALSE(fit_statement({.conditions = {{"", answers}}}, {}));
}

TEST(FitCommandTest, FindsTheJndOfADelayInMilliseconds) {
  const Task task{.delays = true};
  const auto answers = answered(task, {.jnd = 40}, even_levels(5, 200, 8));
  const auto statement = fit_statement({.conditions = {{"", answers}}, .delays = true}, {});
  ASSERT_TRUE(statement) << statement.error().text;
  const auto report = config::Json::parse(statement->report);
  EXPECT_NEAR(*report["conditions"].parts()[0]["jnd_ms"].number(), 40, 5);
  EXPECT_NE(statement->text.find(" ms "), std::string::npos);
}

TEST(FitCommandTest, ACurveStandsBesideTheObserver) {
  const auto answers = answered({}, {.jnd = 0.15, .lapse = 0.02}, even_levels(0.03, 0.9, 8));
  const auto statement = fit_statement({.conditions = {{"", answers}}}, {.curve = "normal"});
  ASSERT_TRUE(statement) << statement.error().text;
  const auto report = config::Json::parse(statement->report);
  EXPECT_TRUE(report["conditions"].parts()[0].contains("threshold"));
  EXPECT_FALSE(fit_statement({.conditions = {{"", {{0.1, 3, 4}}}}}, {.curve = "normal"}));
}

}  // namespace
}  // namespace palp::study
