#include "study/compare_command.h"

#include <array>

#include <gtest/gtest.h>

#include "common/config/json.h"
#include "tests/study/study_fixture.h"

namespace palp::study {
namespace {

using config::Json;

TEST(CompareCommandTest, WritesWhatFitAndCompareSay) {
  const test::PlannedFolder folder;
  EXPECT_EQ(run_compare(folder.folder()).code, config::ExitCode::BadInput);  // nobody answered
  (void)folder.run();
  const std::string report = folder.beside("fit.json");
  EXPECT_EQ(run_fit_study(folder.folder(), report).code, config::ExitCode::Done);
  const Json fit = Json::parse(test::content_of(report));
  EXPECT_EQ(fit["conditions"].parts().size(), 3U);
  EXPECT_NE(test::content_of(folder.folder() + "/derivatives/palp-study/fit.tsv").find("sub-03"),
            std::string::npos);
  const auto compared = run_compare(folder.folder());
  EXPECT_EQ(compared.code, config::ExitCode::Done) << compared.text;
  const Json json =
      Json::parse(test::content_of(folder.folder() + "/derivatives/palp-study/compare.json"));
  EXPECT_EQ(json["jnd"].parts().size(), 3U);  // pairs of three
  EXPECT_FALSE(json.contains("pse"));
}

TEST(CompareCommandTest, SaysWhetherSimulatedAnswersAreAsRegisteredAndOfEverybody) {
  const test::PlannedFolder folder;
  (void)folder.run(test::PlannedFolder::formula(), 1);
  EXPECT_EQ(run_compare(folder.folder()).text.find("simulated: 1 of 3"), 0U);
  (void)folder.run();
  EXPECT_EQ(run_compare(folder.folder()).text.find("simulated: as registered"), 0U);
  std::ofstream{folder.folder() + "/code/study.textproto", std::ios::app} << "\n";
  EXPECT_EQ(run_compare(folder.folder()).text.find("simulated: the study file"), 0U);
}

TEST(CompareCommandTest, WhereNothingCanBeComparedNoTableIsShown) {
  const test::PlannedFolder folder;
  (void)folder.run(test::PlannedFolder::formula(), 1);
  const auto end = run_compare(folder.folder());
  EXPECT_EQ(end.code, config::ExitCode::Done);
  EXPECT_NE(end.text.find("nothing to compare"), std::string::npos) << end.text;
  EXPECT_EQ(end.text.find("p (Holm)"), std::string::npos);
}

TEST(CompareCommandTest, WhatIsNoNumberIsNotShownAsOneAndALongNameHidesNothing) {
  ConditionPair pair{.first = 0, .second = 1, .participants = 2};
  pair.test = paired_test(std::array{0.1, 0.1}, 0.15);
  pair.p_holm = pair.test.p;
  const std::string text = pairs_text({pair}, {std::string(300, 'a'), "b"}, Measure::Jnd);
  EXPECT_EQ(text.find("nan"), std::string::npos) << text;
  EXPECT_NE(text.find("1.105     n/a to n/a"), std::string::npos) << text;
}

TEST(CompareCommandTest, AReportDoesNotTakeThePlaceOfTheStudysOwnFiles) {
  const test::PlannedFolder folder;
  (void)folder.run();
  const std::string list = folder.folder() + "/participants.tsv";
  const std::string before = test::content_of(list);
  EXPECT_EQ(run_fit_study(folder.folder(), list).code, config::ExitCode::BadInput);
  EXPECT_EQ(test::content_of(list), before);
}

}  // namespace
}  // namespace palp::study
