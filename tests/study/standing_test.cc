#include "study/standing.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "study/keep_command.h"
#include "study/report_command.h"
#include "tests/study/study_fixture.h"

namespace palp::study {
namespace {

namespace fs = std::filesystem;
using config::ExitCode;

std::string approved_text() {
  return std::string{test::kStudyText} +
         "ethics { body: \"A board\" number: \"1\" } analysis { primary: \"wool : silk\" }";
}

/// People, who answer by a formula here, go through it.
void asked(const test::PlannedFolder& folder, std::uint64_t from = 1, std::uint64_t to = 3) {
  for (std::uint64_t i = from; i <= to; ++i) {
    const auto end = folder.run_person(test::PlannedFolder::formula(), i);
    ASSERT_EQ(end.code, ExitCode::Done) << end.text;
  }
}

std::string standing_of(const test::PlannedFolder& folder) {
  const auto planned = open_study(folder.folder());
  if (!planned) return planned.error().text;
  const auto rows = read_rows(*planned);
  if (!rows) return rows.error().text;
  return standing(*planned, *rows).value_or("an error");
}

void replace_in(const std::string& path, const std::string& from, const std::string& to) {
  std::string text = test::content_of(path);
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  std::ofstream{path} << text;
}

TEST(StandingTest, IsConfirmatoryOfPeopleWithAnApprovalAlone) {
  const test::PlannedFolder people{approved_text()};
  asked(people);
  EXPECT_EQ(standing_of(people).find("confirmatory: "), 0U) << standing_of(people);
  const test::PlannedFolder pilot;
  asked(pilot);
  EXPECT_EQ(standing_of(pilot).find("exploratory: a pilot"), 0U) << standing_of(pilot);
  const test::PlannedFolder simulated{approved_text()};
  (void)simulated.run();
  EXPECT_EQ(standing_of(simulated), "simulated: as registered");
}

TEST(StandingTest, WithoutAPrimaryComparisonNothingIsConfirmed) {
  const test::PlannedFolder folder{std::string{test::kStudyText} +
                                   "ethics { body: \"A board\" number: \"1\" }"};
  asked(folder);
  EXPECT_EQ(standing_of(folder).find("exploratory: no primary"), 0U) << standing_of(folder);
}

TEST(StandingTest, WhoBeganHasNotTakenPart) {
  const test::PlannedFolder folder{approved_text()};
  asked(folder, 1, 2);
  std::size_t given = 0;
  const auto end = folder.run_person(
      [&](const Study& study) -> Result<Observer> {
        return [&, all = formula_participants(study, {})](
                   const TrialPlace& place, const TrialAsk& ask) -> Result<TrialOutcome> {
          if (given++ == 1) return fail("the power went off");
          return all(place, ask);
        };
      },
      3);
  EXPECT_EQ(end.code, ExitCode::BadInput);
  EXPECT_EQ(standing_of(folder).find("exploratory: 2 of 3"), 0U) << standing_of(folder);
  asked(folder, 3, 3);
  EXPECT_EQ(standing_of(folder).find("confirmatory: "), 0U);
}

TEST(StandingTest, WhoWithdrewIsNotWaitedFor) {
  const test::PlannedFolder folder{approved_text()};
  asked(folder);
  (void)run_withdraw({.folder = folder.folder(), .participant = "sub-02"});
  EXPECT_EQ(standing_of(folder).find("confirmatory: "), 0U) << standing_of(folder);
}

// Whatever check rejects, no comparison stands on.
TEST(StandingTest, ChangedAnswersConfirmNothing) {
  const test::PlannedFolder folder{approved_text()};
  asked(folder);
  const auto planned = *open_study(folder.folder());
  const std::string path = planned.data.trials("sub-02", "stiffness", 2);
  const std::string text = test::content_of(path);
  const std::size_t second = text.find('\n') + 1;
  const std::string row = text.substr(second, text.find('\n', second) + 1 - second);
  const std::string letter = condition_code(participant_plan(planned.study, 1)[1].condition);
  std::string other = text;
  for (std::size_t at = 0; (at = other.find('\t' + letter + '\t', at)) != std::string::npos;) {
    other[at + 1] = letter == "A" ? 'B' : 'A';
  }
  for (const std::string& changed :
       {text + row, text.substr(0, second) + text.substr(second + row.size()), other}) {
    std::ofstream{path} << changed;
    EXPECT_EQ(run_check({.folder = folder.folder()}).code, ExitCode::Missed);
    EXPECT_EQ(standing_of(folder).find("exploratory: sub-02, block 2"), 0U) << standing_of(folder);
  }
  std::ofstream{path} << text;
  EXPECT_EQ(standing_of(folder).find("confirmatory: "), 0U);
  fs::copy(folder.folder() + "/sub-02", folder.folder() + "/sub-77", fs::copy_options::recursive);
  EXPECT_EQ(standing_of(folder).find("exploratory: sub-77 is none"), 0U) << standing_of(folder);
}

TEST(StandingTest, ABlockBeforeTheEndOfAnotherIsAFault) {
  const test::PlannedFolder folder;
  (void)folder.run();
  const auto planned = *open_study(folder.folder());
  const std::string path = planned.data.trials("sub-01", "stiffness", 1);
  const std::string text = test::content_of(path);
  std::ofstream{path} << text.substr(0, text.rfind('\n', text.size() - 2) + 1);
  const auto end = run_check({.folder = folder.folder()});
  EXPECT_NE(end.text.find("sub-01, block 2 was begun before"), std::string::npos) << end.text;
}

TEST(StandingTest, KindsThatAreMixedOrChangedAreAFault) {
  const test::PlannedFolder folder{approved_text()};
  asked(folder);
  const auto planned = *open_study(folder.folder());
  const std::string path = planned.data.trials("sub-01", "stiffness", 1);
  replace_in(path, "\tperson\n", "\tsimulated\n");
  EXPECT_EQ(run_check({.folder = folder.folder()}).code, ExitCode::Missed);
  EXPECT_EQ(standing_of(folder).find("exploratory: answers of kinds person and simulated"), 0U)
      << standing_of(folder);
  const test::PlannedFolder simulated;
  (void)simulated.run();
  replace_in(simulated.folder() + "/code/observer.json", "\"simulated\"", "\"person\"");
  EXPECT_EQ(run_check({.folder = simulated.folder()}).code, ExitCode::Missed);
}

TEST(StandingTest, ARegistrationCannotBeRewritten) {
  const test::PlannedFolder folder{approved_text()};
  asked(folder);
  const std::string code = folder.folder() + "/code/";
  const std::string text = test::content_of(code + "PREREGISTRATION.md");
  replace_in(code + "PREREGISTRATION.md", "wool : silk", "whatever");
  EXPECT_EQ(standing_of(folder).find("exploratory: PREREGISTRATION.md"), 0U);
  fs::remove(code + "PREREGISTRATION.md");
  EXPECT_EQ(run_check({.folder = folder.folder()}).code, ExitCode::Missed);
  std::ofstream{code + "PREREGISTRATION.md"} << text;
  EXPECT_EQ(standing_of(folder).find("confirmatory: "), 0U);
  // The study file and the hash of it in plan.json.
  const std::string before = fingerprint(test::content_of(code + "study.textproto"));
  replace_in(code + "study.textproto", "wool : silk", "whatever");
  replace_in(code + "plan.json", before, fingerprint(test::content_of(code + "study.textproto")));
  EXPECT_EQ(standing_of(folder).find("exploratory: PREREGISTRATION.md"), 0U) << standing_of(folder);
}

TEST(StandingTest, SaysThatSomebodyLookedBeforeTheEnd) {
  const test::PlannedFolder folder{approved_text()};
  asked(folder, 1, 1);
  (void)run_report({.folder = folder.folder(), .unblind = true});
  asked(folder, 2, 3);
  const std::string said = "; unblinded after ";
  EXPECT_NE(standing_of(folder).find(said), std::string::npos) << standing_of(folder);
  EXPECT_NE(standing_of(folder).find("of 1 participants, before all"), std::string::npos);
  EXPECT_NE(run_check({.folder = folder.folder()}).text.find(said), std::string::npos);
  (void)run_report({.folder = folder.folder()});
  EXPECT_NE(test::content_of(folder.folder() + "/derivatives/palp-study/report.html").find(said),
            std::string::npos);
  const test::PlannedFolder at_the_end{approved_text()};
  asked(at_the_end);
  (void)run_report({.folder = at_the_end.folder(), .unblind = true});
  EXPECT_EQ(standing_of(at_the_end).find(said), std::string::npos);
}

// A name is foreign text: it neither reaches a page as it is nor counts as a participant.
TEST(StandingTest, AForeignFolderIsToldAndNotShown) {
  const test::PlannedFolder folder;
  (void)folder.run();
  fs::copy(folder.folder() + "/sub-02",
           folder.folder() + "/sub-<b>\x1b[2J",
           fs::copy_options::recursive);
  const auto end = run_check({.folder = folder.folder()});
  EXPECT_EQ(end.code, ExitCode::Missed);
  EXPECT_NE(end.text.find("sub-<b>?[2J is none of the study's"), std::string::npos) << end.text;
  (void)run_report({.folder = folder.folder()});
  const std::string page =
      test::content_of(folder.folder() + "/derivatives/palp-study/report.html");
  EXPECT_EQ(page.find("<b>"), std::string::npos);
  EXPECT_NE(page.find("3 of 3 registered"), std::string::npos);
}

}  // namespace
}  // namespace palp::study
