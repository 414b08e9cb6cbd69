#include "study/who_answers.h"

#include <gtest/gtest.h>

#include "tests/study/study_fixture.h"

namespace palp::study {
namespace {

using config::ExitCode;

TEST(WhoAnswersTest, SimulatedOnesDoNotGoOnForPeople) {
  const test::PlannedFolder folder;
  (void)folder.run_person(test::PlannedFolder::formula(), 1);
  const std::string answers = folder.answers();
  const auto end = folder.run();
  EXPECT_EQ(end.code, ExitCode::BadInput);
  EXPECT_NE(end.text.find("by pilot"), std::string::npos) << end.text;
  EXPECT_EQ(folder.answers(), answers);
}

// In practice nothing is answered yet, but somebody is there.
TEST(WhoAnswersTest, NorWhereAPersonHasJustBegun) {
  const test::PlannedFolder folder;
  const auto end = folder.run_person(
      [&](const Study&) -> Result<Observer> {
        return [&](const TrialPlace&, const TrialAsk&) -> Result<TrialOutcome> {
          const auto other = folder.run();
          EXPECT_EQ(other.code, ExitCode::BadInput);
          EXPECT_NE(other.text.find("plan another folder"), std::string::npos) << other.text;
          return fail("enough");
        };
      },
      1);
  EXPECT_NE(end.text.find("enough"), std::string::npos);
}

// Before the first folder of a participant is there, too.
TEST(WhoAnswersTest, NobodyBindsAFolderAnewWhileSomebodyRuns) {
  const test::PlannedFolder folder;
  const auto end = folder.run([&](const Study& study) -> Result<Observer> {
    EXPECT_EQ(folder.run_person(test::PlannedFolder::formula(), 1).code, ExitCode::BadInput);
    EXPECT_EQ(folder.run(test::PlannedFolder::formula(), 2).code, ExitCode::Done);
    return formula_participants(study, PeopleTraits{});
  });
  EXPECT_EQ(end.code, ExitCode::Done) << end.text;
  EXPECT_EQ(*bound_kind({folder.folder()}), "simulated");
}

TEST(WhoAnswersTest, OneObserverWithOneSetOfTraitsAnswers) {
  const test::PlannedFolder folder;
  (void)folder.run(test::PlannedFolder::formula(), 1);
  const auto run = [&](const RunFlags& flags) {
    return run_run(
        flags, test::PlannedFolder::formula(), test::one_after_the_other, [](const std::string&) {
        });
  };
  RunFlags flags{.folder = folder.folder()};
  flags.observer = "felt";
  EXPECT_EQ(run(flags).code, ExitCode::BadInput);
  flags.observer = "formula";
  flags.people.weber = 0.2;
  EXPECT_EQ(run(flags).code, ExitCode::BadInput);
  flags.people.weber = PeopleTraits{}.weber;
  EXPECT_EQ(run(flags).code, ExitCode::Done);
  std::filesystem::remove(folder.folder() + "/code/observer.json");
  EXPECT_EQ(run(flags).code, ExitCode::BadInput);
}

TEST(WhoAnswersTest, AFolderWithoutAnswersIsAnybodys) {
  const test::PlannedFolder folder;
  const auto planned = *open_study(folder.folder());
  ASSERT_TRUE(bind_folder(planned, {.kind = "pilot"}));
  EXPECT_EQ(*bound_kind(planned.data), "pilot");
  EXPECT_EQ(folder.run().code, ExitCode::Done);
  EXPECT_EQ(*bound_kind(planned.data), "simulated");
}

TEST(WhoAnswersTest, KindsAreNamedOnce) {
  TrialRow row;
  row.kind = "simulated";
  TrialRow other;
  other.kind = "person";
  EXPECT_EQ(kinds_of({{"sub-01", {row, row}}, {"sub-02", {other, row}}}),
            (std::vector<std::string>{"person", "simulated"}));
}

}  // namespace
}  // namespace palp::study
