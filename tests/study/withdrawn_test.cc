#include "study/withdrawn.h"

#include <gtest/gtest.h>

#include "study/keep_command.h"
#include "tests/study/study_fixture.h"

namespace palp::study {
namespace {

namespace fs = std::filesystem;
using config::ExitCode;

/// Answers, and withdraws somebody once so many trials were asked.
MakeObserver withdrawing(const test::PlannedFolder& folder,
                         const std::string& who,
                         std::size_t after,
                         std::vector<std::size_t>& asked) {
  return [&folder, who, after, &asked](const Study& study) -> Result<Observer> {
    return [&folder, who, after, &asked, all = formula_participants(study, {})](
               const TrialPlace& place, const TrialAsk& ask) {
      asked.push_back(place.participant);
      if (asked.size() == after) {
        EXPECT_EQ(run_withdraw({.folder = folder.folder(), .participant = who}).code,
                  ExitCode::Done);
        // As a session that was begun in spite of it.
        fs::create_directories(DataSet{folder.folder()}.traces_folder(who));
        std::ofstream{DataSet{folder.folder()}.traces_folder(who) + "/trace.mcap"} << "trace";
      }
      return all(place, ask);
    };
  };
}

TEST(WithdrawnTest, WhoWithdrawsBetweenTrialsIsAskedNoMoreAndLeavesNothing) {
  const test::PlannedFolder folder;
  std::vector<std::size_t> asked;
  const auto end = folder.run(withdrawing(folder, "sub-01", 4, asked), 1);
  EXPECT_EQ(end.code, ExitCode::BadInput);
  EXPECT_NE(end.text.find("sub-01 has withdrawn"), std::string::npos) << end.text;
  EXPECT_EQ(asked.size(), 4U);
  EXPECT_FALSE(fs::exists(folder.folder() + "/sub-01"));
  EXPECT_FALSE(fs::exists(folder.folder() + "/sourcedata/sub-01"));
}

TEST(WithdrawnTest, NothingIsLeftWhereTheSessionEndsWithTheWithdrawal) {
  const test::PlannedFolder folder;
  const DataSet data{folder.folder()};
  (void)folder.run(
      [&](const Study&) -> Result<Observer> {
        return [&](const TrialPlace&, const TrialAsk&) -> Result<TrialOutcome> {
          EXPECT_TRUE(add_withdrawn(data, "sub-01"));
          fs::create_directories(data.traces_folder("sub-01"));
          return fail("a site has ended");
        };
      },
      1);
  EXPECT_FALSE(fs::exists(folder.folder() + "/sub-01"));
  EXPECT_FALSE(fs::exists(data.traces_folder("sub-01")));
}

TEST(WithdrawnTest, WhoWithdrawsWhileOthersAreAskedIsNotBegun) {
  const test::PlannedFolder folder;
  std::vector<std::size_t> asked;
  const auto end = folder.run(withdrawing(folder, "sub-03", 4, asked));
  EXPECT_EQ(end.code, ExitCode::Done) << end.text;
  EXPECT_EQ(end.text.find("2 participants through"), 0U) << end.text;
  EXPECT_EQ(std::ranges::count(asked, 2U), 0);
  EXPECT_FALSE(fs::exists(folder.folder() + "/sub-03"));
}

TEST(WithdrawnTest, AListThatCannotBeReadIsNotAnEmptyOne) {
  const test::PlannedFolder folder;
  const std::string list = folder.folder() + "/code/withdrawn.txt";
  fs::create_directories(list);
  EXPECT_EQ(folder.run().code, ExitCode::CannotOpen);
  EXPECT_FALSE(fs::exists(folder.folder() + "/sub-01"));
  EXPECT_EQ(run_withdraw({.folder = folder.folder(), .participant = "sub-02"}).code,
            ExitCode::CannotOpen);
  EXPECT_TRUE(fs::is_directory(list));
}

TEST(WithdrawnTest, TheListOnlyGrows) {
  const test::PlannedFolder folder;
  const DataSet data{folder.folder()};
  std::ofstream{data.code("withdrawn.txt")} << "sub-01\r\nsub-02";  // as an editor leaves it
  EXPECT_TRUE(*has_withdrawn(data, "sub-02"));
  ASSERT_TRUE(add_withdrawn(data, "sub-03"));
  EXPECT_EQ(*withdrawn_participants(data),
            (std::vector<std::string>{"sub-01", "sub-02", "sub-03"}));
  EXPECT_FALSE(*has_withdrawn(data, "sub-0"));
}

TEST(WithdrawnTest, CheckNamesWhoWithdrewAndIsStillThere) {
  const test::PlannedFolder folder;
  (void)folder.run();
  ASSERT_TRUE(add_withdrawn({folder.folder()}, "sub-02"));
  const auto end = run_check({.folder = folder.folder()});
  EXPECT_EQ(end.code, ExitCode::Missed);
  EXPECT_NE(end.text.find("sub-02 has withdrawn and is still there"), std::string::npos)
      << end.text;
  EXPECT_EQ(read_rows(*open_study(folder.folder()))->size(), 2U);  // nothing is made of them
  ASSERT_TRUE(delete_participant({folder.folder()}, "sub-02"));
  EXPECT_TRUE(withdrawn_with_data({folder.folder()})->empty());
}

TEST(WithdrawnTest, FilesThatNameAParticipantAreFound) {
  const test::PlannedFolder folder;
  const DataSet data{folder.folder()};
  std::ofstream{folder.folder() + "/export.csv"} << "participant\nsub-10,1\n";
  std::ofstream{folder.folder() + "/other.csv"} << "participant\nsub-100,1\n";
  ASSERT_TRUE(add_withdrawn(data, "sub-10"));
  EXPECT_EQ(*files_with(data, "sub-10"), std::vector<std::string>{folder.folder() + "/export.csv"});
}

}  // namespace
}  // namespace palp::study
