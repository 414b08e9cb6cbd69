#include "review/replay_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "review/recover.h"
#include "tests/review/lab_files.h"

namespace palp::review {
namespace {

using testing::HasSubstr;

const test::LabFiles& three_seconds() {
  static const test::LabFiles files = test::lab_files(test::lab_scenario(std::chrono::seconds{3}));
  return files;
}

TEST(ReplayCommandTest, TheFileAloneIsEnough) {
  for (const auto bytes : {three_seconds().surgeon.bytes(), three_seconds().patient.bytes()}) {
    const auto answer = replay_command({bytes}, {});
    ASSERT_TRUE(answer) << answer.error().text;
    EXPECT_TRUE(answer->same) << answer->text;
    EXPECT_THAT(answer->text, HasSubstr("3000 ticks"));
  }
}

TEST(ReplayCommandTest, AnotherCouplingsHalfDoesNotUnderstandTheTelegrams) {
  const record::FileBytes file = three_seconds().patient.bytes();
  for (const ReplayAsk& ask :
       {ReplayAsk{.coupling = "wave"}, ReplayAsk{.set = {"coupling.name=wave"}}}) {
    const auto answer = replay_command({file}, ask);
    ASSERT_FALSE(answer);
    EXPECT_THAT(answer.error().text, HasSubstr("palp-lab run again.textproto --coupling wave"));
  }
  const auto own = replay_command({file}, {.coupling = "mmt"});
  EXPECT_TRUE(own) << own.error().text;
}

TEST(ReplayCommandTest, TellsWhatAnotherSettingWouldHaveSaid) {
  const auto answer = replay_command({three_seconds().patient.bytes()},
                                     {.set = {"motion_gate.speed_near_surface_m_per_s=0.01"}});
  ASSERT_TRUE(answer) << answer.error().text;
  EXPECT_THAT(answer->text, HasSubstr("target of the stage"));
}

TEST(ReplayCommandTest, TellsWhatAnotherEstimatorWouldHaveSaidOfAllPlaces) {
  const test::LabFiles nine_taps =
      test::lab_files(test::lab_scenario(std::chrono::seconds{40}, {}, "map"));
  const auto bytes = nine_taps.patient.bytes();
  const auto evener = replay_command({bytes}, {.set = {"estimator.place_spread=0.01"}});
  ASSERT_TRUE(evener) << evener.error().text;
  EXPECT_THAT(evener->text, HasSubstr("together, the session: One round inclusion, if the"));
  EXPECT_THAT(evener->text, HasSubstr("together, now: One round inclusion, if the"));
  EXPECT_THAT(evener->text, HasSubstr("varies by 1 % from place to place"));
  const auto papers = replay_command({bytes}, {.estimator = "paper"});
  ASSERT_TRUE(papers) << papers.error().text;
  EXPECT_THAT(papers->text, HasSubstr("all places together, now: nothing"));
}

TEST(ReplayCommandTest, ADamagedFileIsNoDifference) {
  const auto bytes = three_seconds().surgeon.bytes();
  std::vector<std::byte> damaged{bytes.begin(), bytes.end()};
  damaged[damaged.size() / 2] ^= std::byte{1};
  const auto answer = replay_command({damaged}, {});
  ASSERT_FALSE(answer);
  EXPECT_THAT(answer.error().text, HasSubstr("damaged"));
}

TEST(ReplayCommandTest, AFileThatWasCutOffIsDoneAgainToItsEnd) {
  const auto bytes = three_seconds().surgeon.bytes();
  const auto answer = replay_command({bytes.first(bytes.size() / 2)}, {});
  ASSERT_TRUE(answer) << answer.error().text;
  EXPECT_TRUE(answer->same) << answer->text;
  EXPECT_THAT(answer->text, HasSubstr("the file was not closed"));
}

TEST(ReplayCommandTest, ARecoveredFileSaysSoAndMissingTicksAreNoDifference) {
  const auto recovered = [](const record::FileBytes& file) {
    record::MemorySink out;
    EXPECT_TRUE(recover(file, out));
    return std::vector<std::byte>{out.bytes().begin(), out.bytes().end()};
  };
  const auto bytes = three_seconds().surgeon.bytes();
  const auto cut = replay_command({recovered(bytes.first(bytes.size() / 2))}, {});
  ASSERT_TRUE(cut) << cut.error().text;
  EXPECT_THAT(cut->text, HasSubstr("same; the file was recovered"));
  std::vector<std::byte> damaged{bytes.begin(), bytes.end()};
  damaged[damaged.size() / 2] ^= std::byte{1};
  const auto torn = replay_command({recovered(damaged)}, {});
  ASSERT_FALSE(torn);
  EXPECT_THAT(torn.error().text, HasSubstr("damaged before its tick"));
}

TEST(ReplayCommandTest, AFileWithoutATickIsNoneThatWasDoneAgain) {
  const auto bytes = three_seconds().surgeon.bytes();
  // All that stands before the first chunk, which begins with half a second.
  const auto answer = replay_command({bytes.first(bytes.size() / 30)}, {});
  ASSERT_FALSE(answer);
  EXPECT_THAT(answer.error().text, HasSubstr("no tick"));
}

TEST(ReplayCommandTest, RefusesInASentence) {
  const auto of_surgeon = replay_command({three_seconds().surgeon.bytes()}, {.estimator = "paper"});
  ASSERT_FALSE(of_surgeon);
  EXPECT_THAT(of_surgeon.error().text, HasSubstr("patient's file"));
  const auto unknown = replay_command({three_seconds().patient.bytes()}, {.coupling = "felt"});
  EXPECT_FALSE(unknown);
  const auto twice =
      replay_command({three_seconds().patient.bytes(), three_seconds().patient.bytes()}, {});
  ASSERT_FALSE(twice);
  EXPECT_THAT(twice.error().text, HasSubstr("number 1 of its run where number 2 is due"));
}

}  // namespace
}  // namespace palp::review
