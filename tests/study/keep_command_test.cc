#include "study/keep_command.h"

#include <gtest/gtest.h>

#include "study/compare_command.h"
#include "study/report_command.h"
#include "tests/study/study_fixture.h"

namespace palp::study {
namespace {

namespace fs = std::filesystem;
using config::ExitCode;

TEST(CheckCommandTest, HoldsAsRegisteredAndNoticesAChangedAnswer) {
  const test::PlannedFolder folder;
  (void)folder.run();
  EXPECT_EQ(run_check({.folder = folder.folder()}).code, ExitCode::Done);
  const auto planned = *open_study(folder.folder());
  const std::string path = planned.data.trials("sub-03", "stiffness", 3);
  std::string text = test::content_of(path);
  std::ofstream{path} << text.substr(0, text.rfind('\n', text.size() - 2) + 1);
  EXPECT_EQ(run_check({.folder = folder.folder()}).code, ExitCode::Done);  // not yet at its end
  const std::size_t second = text.find('\n', text.find('\n') + 1) + 1;
  std::ofstream{path} << text.substr(0, text.find('\n') + 1) << text.substr(second);
  const auto gone = run_check({.folder = folder.folder()});
  EXPECT_EQ(gone.code, ExitCode::Missed);
  EXPECT_NE(gone.text.find("sub-03, block 3"), std::string::npos) << gone.text;
  std::ofstream{path} << text;
  fs::create_directories(folder.folder() + "/sub-77/ses-01/beh");
  EXPECT_EQ(run_check({.folder = folder.folder()}).code, ExitCode::Missed);
}

TEST(WithdrawCommandTest, LeavesNothingOfAParticipant) {
  const test::PlannedFolder folder;
  (void)folder.run();
  (void)run_fit_study(folder.folder(), "");
  (void)run_report({.folder = folder.folder()});
  EXPECT_EQ(run_withdraw({.folder = folder.folder(), .participant = "sub-02"}).code,
            ExitCode::Done);
  for (const auto& entry : fs::recursive_directory_iterator{folder.folder()}) {
    EXPECT_EQ(entry.path().string().find("sub-02"), std::string::npos) << entry.path();
    if (!entry.is_regular_file() || entry.path().filename() == "withdrawn.txt") continue;
    EXPECT_EQ(test::content_of(entry.path()).find("sub-02"), std::string::npos) << entry.path();
  }
  // Nobody asks again.
  EXPECT_EQ(folder.run(test::PlannedFolder::formula(), 2).code, ExitCode::BadInput);
  EXPECT_EQ(folder.run().text.find("2 participants"), 0U);
  EXPECT_EQ(run_check({.folder = folder.folder()}).code, ExitCode::Done);
}

TEST(WithdrawCommandTest, NeedsNoKey) {
  const test::PlannedFolder folder;
  (void)folder.run();
  fs::remove(folder.folder() + "/code/key.json");
  EXPECT_EQ(run_withdraw({.folder = folder.folder(), .participant = "sub-02"}).code,
            ExitCode::Done);
  EXPECT_FALSE(fs::exists(folder.folder() + "/sub-02"));
}

TEST(WithdrawCommandTest, NamesFilesOfTheFolderThatAreNotItsToDelete) {
  const test::PlannedFolder folder;
  (void)folder.run();
  const std::string own = folder.folder() + "/notes.txt";
  std::ofstream{own} << "sub-02 came late\n";
  const auto end = run_withdraw({.folder = folder.folder(), .participant = "sub-02"});
  EXPECT_NE(end.text.find("notes.txt still names sub-02"), std::string::npos) << end.text;
}

TEST(WithdrawCommandTest, DeletesNobodyElse) {
  const test::PlannedFolder folder;
  for (const char* other : {"sub-04", "..", "code", "", "sub-01/ses-01"}) {
    EXPECT_EQ(run_withdraw({.folder = folder.folder(), .participant = other}).code,
              ExitCode::BadInput)
        << other;
  }
  EXPECT_TRUE(fs::exists(folder.folder() + "/code/plan.json"));
}

TEST(ExportCommandTest, DoesNotWriteOverAnswers) {
  const test::PlannedFolder folder;
  (void)folder.run();
  const std::string before = folder.answers();
  const std::string out = DataSet{folder.folder()}.trials("sub-01", "stiffness", 1);
  EXPECT_EQ(run_export({.folder = folder.folder(), .out = out}).code, ExitCode::BadInput);
  EXPECT_EQ(folder.answers(), before);
}

TEST(ExportCommandTest, WritesTheFile) {
  const test::PlannedFolder folder;
  (void)folder.run();
  const std::string out = folder.beside("lme4.csv");
  EXPECT_EQ(run_export({.folder = folder.folder(), .format = "lme4", .out = out}).code,
            ExitCode::Done);
  EXPECT_EQ(
      test::content_of(out).find("participant,condition,level,correct,trial,excluded\nsub-01,"),
      0U);
}

}  // namespace
}  // namespace palp::study
