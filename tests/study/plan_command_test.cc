#include "study/plan_command.h"

#include <gtest/gtest.h>

#include "tests/study/study_fixture.h"

namespace palp::study {
namespace {

namespace fs = std::filesystem;

TEST(PlanCommandTest, RegistersWhatWillBeDoneBeforeAnybodyIsAsked) {
  const test::PlannedFolder folder;
  ASSERT_EQ(folder.planned().code, config::ExitCode::Done) << folder.planned().text;
  const std::string text = test::content_of(folder.folder() + "/code/PREREGISTRATION.md");
  for (const char* said : {"Which?", "silk; wool; felt", "3;", "Williams", "80 %", "a test"}) {
    EXPECT_NE(text.find(said), std::string::npos) << said;
  }
  const std::string schedule = test::content_of(folder.folder() + "/code/schedule.json");
  EXPECT_NE(text.find(fingerprint(schedule)), std::string::npos);
  EXPECT_NE(text.find(fingerprint(test::kStudyText)), std::string::npos);
  EXPECT_NE(text.find("Ethics: missing"), std::string::npos);
}

TEST(PlanCommandTest, TheKeyIsTheOwnersAlone) {
  const test::PlannedFolder folder;
  EXPECT_EQ(fs::status(folder.folder() + "/code/key.json").permissions(),
            fs::perms::owner_read | fs::perms::owner_write);
}

TEST(PlanCommandTest, WritesOverNoStudy) {
  const test::PlannedFolder folder;
  const auto again =
      run_plan({.file = folder.beside("study.textproto"), .folder = folder.folder()}, "a test");
  EXPECT_EQ(again.code, config::ExitCode::CannotOpen);
}

TEST(PlanCommandTest, AStudyThatIsNoneLeavesNothing) {
  const test::PlannedFolder folder{"condition {}"};
  EXPECT_EQ(folder.planned().code, config::ExitCode::BadInput);
  EXPECT_FALSE(fs::exists(folder.folder()));
}

}  // namespace
}  // namespace palp::study
