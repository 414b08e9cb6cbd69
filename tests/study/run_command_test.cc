#include "study/run_command.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sys/stat.h>

#include "tests/study/study_fixture.h"

namespace palp::study {
namespace {

namespace fs = std::filesystem;

TEST(RunCommandTest, EverybodyGoesThroughAndASecondRunAddsNothing) {
  const test::PlannedFolder folder;
  const auto first = folder.run();
  EXPECT_EQ(first.code, config::ExitCode::Done) << first.text;
  const std::string answers = folder.answers();
  EXPECT_FALSE(answers.empty());
  const auto again = folder.run();
  EXPECT_NE(again.text.find(" 0 trials answered now"), std::string::npos) << again.text;
  EXPECT_EQ(folder.answers(), answers);
}

// Killed anywhere: files end after any byte, later ones are not there. What was answered stays, and
// the rest is what it would have been.
RC_GTEST_PROP(RunCommandTest, GoesOnWhereItStoodWhereverItWasCutOff, ()) {
  static const test::PlannedFolder folder;
  static const std::string whole = [] {
    (void)folder.run();
    return folder.answers();
  }();
  const auto planned = *open_study(folder.folder());
  const auto participant = *rc::gen::inRange<std::size_t>(0, 3);
  const auto block = *rc::gen::inRange<std::size_t>(1, 4);
  const std::string id = participant_id(participant);
  const std::string path = planned.data.trials(id, "stiffness", block);
  const std::string before = test::content_of(path);
  const auto kept = *rc::gen::inRange<std::size_t>(0, before.size());
  fs::resize_file(path, kept);
  for (std::size_t later = block + 1; later <= 3; ++later) {
    fs::remove(planned.data.trials(id, "stiffness", later));
  }
  RC_ASSERT(folder.run().code == config::ExitCode::Done);
  RC_ASSERT(folder.answers() == whole);
}

// Everything that was said to be answered is on the disk by then.
TEST(RunCommandTest, SaysSoOnceAnAnswerIsWritten) {
  const test::PlannedFolder folder;
  const auto planned = *open_study(folder.folder());
  std::size_t said = 0;
  const auto end = run_run({.folder = folder.folder(), .participant = 1, .each = true},
                           test::PlannedFolder::formula(),
                           test::one_after_the_other,
                           [&](const std::string& line) {
                             ++said;
                             const std::string text = folder.answers();
                             const auto lines = std::count(text.begin(), text.end(), '\n');
                             const auto headers = line.find("block 1") != std::string::npos   ? 1
                                                  : line.find("block 2") != std::string::npos ? 2
                                                                                              : 3;
                             EXPECT_EQ(static_cast<std::size_t>(lines - headers), said);
                             for (const char* name : {"silk", "wool", "felt", "mmt", "0."}) {
                               EXPECT_EQ(line.find(name), std::string::npos) << line;
                             }
                           });
  EXPECT_EQ(end.code, config::ExitCode::Done);
  EXPECT_GE(said, 3U * 8U);
}

TEST(RunCommandTest, AChangedAnswerStopsIt) {
  const test::PlannedFolder folder;
  (void)folder.run();
  const auto planned = *open_study(folder.folder());
  const std::string path = planned.data.trials("sub-02", "stiffness", 1);
  std::string text = test::content_of(path);
  const std::size_t at = text.find("\ttrial\t", text.find('\n'));
  ASSERT_NE(at, std::string::npos);
  text.replace(at, 7, "\tcatch\t");
  std::ofstream{path} << text;
  const auto end = folder.run();
  EXPECT_EQ(end.code, config::ExitCode::BadInput);
  EXPECT_NE(end.text.find("is not the one that the schedule"), std::string::npos) << end.text;
}

TEST(RunCommandTest, AStudyThatIsNotAsRegisteredAsksNobody) {
  const test::PlannedFolder folder;
  std::ofstream{folder.folder() + "/code/study.textproto", std::ios::app} << "# later\n";
  const auto end = folder.run([](const Study&) -> Result<Observer> {
    ADD_FAILURE() << "somebody is asked";
    return fail("nobody");
  });
  EXPECT_EQ(end.code, config::ExitCode::BadInput);
  EXPECT_NE(end.text.find("nobody is asked: the study file"), std::string::npos) << end.text;
}

// What cannot be read is not taken for nothing.
TEST(RunCommandTest, WritesOverNoAnswersThatItCannotRead) {
  const test::PlannedFolder folder;
  (void)folder.run();
  const auto planned = *open_study(folder.folder());
  const std::string path = planned.data.trials("sub-01", "stiffness", 1);
  std::string old_lines = test::content_of(path);
  std::ranges::replace(old_lines, '\n', '\r');
  for (const std::string& text : {old_lines, std::string{"answers"}, std::string{"a\tb\n1\t2\n"}}) {
    std::ofstream{path} << text;
    EXPECT_EQ(folder.run().code, config::ExitCode::BadInput) << text.substr(0, 20);
    EXPECT_EQ(test::content_of(path), text);
  }
  fs::remove(path);
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  EXPECT_EQ(folder.run().code, config::ExitCode::CannotOpen);
}

TEST(RunCommandTest, KeepsWhatItCutsOff) {
  const test::PlannedFolder folder;
  (void)folder.run();
  const auto planned = *open_study(folder.folder());
  const std::string path = planned.data.trials("sub-01", "stiffness", 3);
  const std::string text = test::content_of(path);
  fs::resize_file(path, text.size() - 1);  // as an editor without a last line end
  EXPECT_EQ(folder.run().code, config::ExitCode::Done);
  EXPECT_EQ(test::content_of(path), text);
  EXPECT_EQ(test::content_of(path + ".cut"), text.substr(text.rfind('\n', text.size() - 2) + 1));
}

TEST(RunCommandTest, FollowsNoLinkOutOfTheFolder) {
  const test::PlannedFolder folder;
  fs::create_directories(folder.beside("elsewhere"));
  fs::create_directory_symlink(folder.beside("elsewhere"), folder.folder() + "/sub-02");
  EXPECT_EQ(folder.run().code, config::ExitCode::CannotOpen);
  EXPECT_TRUE(fs::is_empty(folder.beside("elsewhere")));
  fs::remove(folder.folder() + "/sub-02");
  fs::create_directory_symlink(folder.beside("elsewhere"), folder.folder() + "/sourcedata");
  EXPECT_EQ(folder.run().code, config::ExitCode::CannotOpen);
}

TEST(RunCommandTest, ListsWhoAnsweredWhateverBecameOfTheRun) {
  const test::PlannedFolder folder;
  const auto end = folder.run([](const Study& study) -> Result<Observer> {
    return [all = formula_participants(study, {})](const TrialPlace& place,
                                                   const TrialAsk& ask) -> Result<TrialOutcome> {
      if (place.participant == 1) return fail("the power went off");
      return all(place, ask);
    };
  });
  EXPECT_EQ(end.code, config::ExitCode::BadInput);
  EXPECT_EQ(test::content_of(folder.folder() + "/participants.tsv"),
            "participant_id\tkind\nsub-01\tsimulated\nsub-02\tn/a\nsub-03\tsimulated\n");
}

TEST(RunCommandTest, WhoCannotPractiseGoesNoFurther) {
  const test::PlannedFolder folder;
  const auto end = folder.run([](const Study&) -> Result<Observer> {
    return [](const TrialPlace&, const TrialAsk& ask) {
      return TrialOutcome{.chosen = 1 - ask.stronger, .duration = 10};
    };
  });
  EXPECT_EQ(end.code, config::ExitCode::Done);
  const auto planned = *open_study(folder.folder());
  EXPECT_TRUE(fs::exists(planned.data.trials("sub-01", "stiffness", 1)));
  EXPECT_FALSE(fs::exists(planned.data.trials("sub-01", "stiffness", 2)));
}

TEST(RunCommandTest, NobodyBeyondTheStudy) {
  const test::PlannedFolder folder;
  EXPECT_EQ(folder.run(test::PlannedFolder::formula(), 4).code, config::ExitCode::BadInput);
  EXPECT_EQ(run_run({.folder = "/nowhere"},
                    test::PlannedFolder::formula(),
                    test::one_after_the_other,
                    [](const std::string&) {})
                .code,
            config::ExitCode::CannotOpen);
}

}  // namespace
}  // namespace palp::study
