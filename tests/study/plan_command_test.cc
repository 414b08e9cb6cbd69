#include "study/plan_command.h"

#include <optional>
#include <utility>

#include <gtest/gtest.h>

#include "study/data_set.h"
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

std::string planned_key(const test::PlannedFolder& folder,
                        const std::string& name,
                        std::optional<std::uint64_t> letters,
                        std::uint64_t entropy) {
  const auto end = run_plan(
      {.file = folder.beside("study.textproto"), .folder = folder.beside(name), .letters = letters},
      "a test",
      [&] { return entropy++; });
  EXPECT_EQ(end.code, config::ExitCode::Done) << end.text;
  return test::content_of(folder.beside(name) + "/code/key.json");
}

// Whoever has all but the key, and plans the study again, has another key.
TEST(PlanCommandTest, LettersAreDrawnByChanceAndOnlyOnDemandByANumber) {
  const test::PlannedFolder folder;
  const std::string one = planned_key(folder, "one", std::nullopt, 1);
  EXPECT_NE(planned_key(folder, "two", std::nullopt, 100), one);
  const std::string by_number = planned_key(folder, "three", 9, 1);
  EXPECT_EQ(planned_key(folder, "four", 9, 100), by_number);
  EXPECT_NE(planned_key(folder, "five", 10, 1), by_number);
}

// Nothing else in the folder depends on the letters but the hash of the key.
TEST(PlanCommandTest, WhatAnybodyMayReadTellsNoLetter) {
  const test::PlannedFolder folder;
  (void)planned_key(folder, "one", 1, 0);
  (void)planned_key(folder, "two", 2, 0);
  const auto key_hash = [&](const std::string& name) {
    return fingerprint(test::content_of(folder.beside(name) + "/code/key.json"));
  };
  std::size_t compared = 0;
  for (const auto& entry : fs::recursive_directory_iterator{folder.beside("one")}) {
    if (!entry.is_regular_file() || entry.path().filename() == "key.json") continue;
    const auto name = entry.path().lexically_relative(folder.beside("one"));
    std::string text = test::content_of(entry.path());
    std::string other = test::content_of(folder.beside("two") + "/" + name.string());
    for (const auto& [of, hash] : {std::pair{&text, key_hash("one")}, {&other, key_hash("two")}}) {
      if (const std::size_t at = of->find(hash); at != std::string::npos) of->replace(at, 64, "");
    }
    EXPECT_EQ(text, other) << name;
    ++compared;
  }
  EXPECT_GE(compared, 8U);
}

TEST(PlanCommandTest, WhatCouldNotBeReadAgainIsRefused) {
  std::string text{test::kStudyText};
  text.replace(text.find("participants: 3 trials: 8"), 25, "participants: 999 trials: 1000");
  const test::PlannedFolder folder{text};
  EXPECT_EQ(folder.planned().code, config::ExitCode::BadInput);
  EXPECT_NE(folder.planned().text.find("the schedule takes"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder.folder()));
}

TEST(PlanCommandTest, ABrokenLineWritesNoneOfTheRegistrations) {
  std::string text{test::kStudyText};
  text.replace(text.find("Which?"), 6, "Which?\\n- Ethics: approved, 1");
  const test::PlannedFolder folder{text};
  const std::string said = test::content_of(folder.folder() + "/code/PREREGISTRATION.md");
  EXPECT_NE(said.find("Which? - Ethics: approved"), std::string::npos);
  EXPECT_EQ(said.find("\n- Ethics: approved"), std::string::npos);
}

TEST(PlanCommandTest, WritesOverNoStudy) {
  const test::PlannedFolder folder;
  const auto again = run_plan({.file = folder.beside("study.textproto"), .folder = folder.folder()},
                              "a test",
                              [] { return std::uint64_t{7}; });
  EXPECT_EQ(again.code, config::ExitCode::CannotOpen);
}

TEST(PlanCommandTest, AStudyThatIsNoneLeavesNothing) {
  const test::PlannedFolder folder{"condition {}"};
  EXPECT_EQ(folder.planned().code, config::ExitCode::BadInput);
  EXPECT_FALSE(fs::exists(folder.folder()));
}

}  // namespace
}  // namespace palp::study
