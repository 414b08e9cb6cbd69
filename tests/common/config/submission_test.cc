#include "common/config/submission.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include "common/core/whole_file.h"
#include "tests/support/own_path.h"

namespace palp::config {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const ShardForm kForm{.program = "palp-lab",
                      .part_flag = "--cases",
                      .part_ending = ".csv",
                      .resume = "--resume",
                      .first = 0,
                      .of_merge = {"--report", "--svg"}};

class SubmissionTest : public testing::Test {
 protected:
  ~SubmissionTest() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] ExitStatus progress() const {
    CommandLine line{"palp-lab", "tests"};
    const ProgressCommand command{line};
    const std::array argv{"palp-lab", "progress", folder_.c_str()};
    const auto refused = line.parse(static_cast<int>(argv.size()), argv.data());
    return refused ? *refused : command.run();
  }

  std::string folder_{test::own_path("submission")};
  Submission submission_{
      .form = kForm,
      .engine = "print",
      .folder = folder_,
      .hosts = {},
      .shards = 3,
      .from = "/srv/it's",
      .command = {"/bin/palp-lab", "montecarlo", "--set", "mc", "--report=r.json", "--svg", "x"}};
};

TEST(CommandOfShardTest, KeepsWhatTheCasesAreAndDropsTheRest) {
  Submission submission{.form = kForm};
  submission.command = {"palp-lab",
                        "montecarlo",
                        "--resume",
                        "--set",
                        "mc",
                        "--submit",
                        "print",
                        "--folder=F",
                        "--seed",
                        "7",
                        "--shards",
                        "9",
                        "--report",
                        "all.json",
                        "--cores",
                        "2"};
  EXPECT_THAT(command_of_shard(submission),
              ElementsAre("palp-lab", "montecarlo", "--set", "mc", "--seed", "7"));
  EXPECT_THAT(outputs_of(submission), ElementsAre("--report", "all.json"));
}

TEST(CommandOfShardTest, ASwitchOfTheMergeTakesNoWordAndWhatBothNeedBothGet) {
  Submission submission{.form = kForm};
  submission.form.switches = {"--off-axis"};
  submission.form.of_both = {"--accuracy"};
  submission.command = {
      "palp-fem", "database", "--off-axis", "--report", "r.json", "--accuracy", "coarse"};
  EXPECT_THAT(command_of_shard(submission),
              ElementsAre("palp-fem", "database", "--accuracy", "coarse"));
  EXPECT_THAT(outputs_of(submission),
              ElementsAre("--report", "r.json", "--accuracy", "coarse", "--off-axis"));
}

TEST_F(SubmissionTest, AShardRunsItsPartOnlyOnceAndTheMergeWritesTheReport) {
  const std::string shard = shard_script(submission_);
  EXPECT_THAT(shard, HasSubstr("[ -s \"$part\" ] && exit 0"));
  EXPECT_THAT(
      shard, HasSubstr("'--set' 'mc' --shard \"$shard/3\" --cases \"$part\" --cores 1 --resume\n"));
  EXPECT_THAT(shard, HasSubstr("cd '/srv/it'\\''s'"));
  EXPECT_THAT(shard, Not(HasSubstr("r.json")));
  EXPECT_THAT(merge_script(submission_), HasSubstr("part-2.csv' '--report=r.json' '--svg' 'x'"));
}

TEST_F(SubmissionTest, SlurmMergesAfterTheArray) {
  submission_.engine = "slurm";
  const std::string start = start_script(submission_);
  EXPECT_THAT(start, HasSubstr("sbatch --parsable --array=0-2 "));
  EXPECT_THAT(start, HasSubstr("--dependency=afterok:"));
}

TEST_F(SubmissionTest, ProgressNamesWhatIsMissing) {
  EXPECT_EQ(progress().code, ExitCode::CannotOpen);
  ASSERT_TRUE(write_submission(submission_));
  std::ofstream{folder_ + "/part-1.csv"} << "rows";
  EXPECT_EQ(progress().code, ExitCode::Missed);
  EXPECT_THAT(progress().text, HasSubstr("1 of 3 shards; missing: 0, 2"));
  std::ofstream{folder_ + "/part-0.csv"} << "rows";
  std::ofstream{folder_ + "/part-2.csv"} << "rows";
  EXPECT_EQ(progress().code, ExitCode::Done);
}

TEST_F(SubmissionTest, AProgramMayCountItsShardsFromOne) {
  submission_.form = {.program = "palp-fem",
                      .part_flag = "--out",
                      .part_ending = ".bin",
                      .resume = "",
                      .first = 1,
                      .of_merge = {"--out"}};
  EXPECT_THAT(shard_script(submission_),
              HasSubstr("--shard \"$((shard + 1))/3\" --out \"$part\" --cores 1\n"));
  EXPECT_THAT(merge_script(submission_), HasSubstr("/part-2.bin'"));
  ASSERT_TRUE(write_submission(submission_));
  for (const char* part : {"0", "1", "2"}) {
    std::ofstream{folder_ + "/part-" + part + ".bin"} << "curves";
  }
  EXPECT_EQ(progress().code, ExitCode::Done);
}

TEST_F(SubmissionTest, AFolderOfAnotherCommandIsRefused) {
  ASSERT_TRUE(write_submission(submission_));
  submission_.engine = "slurm";
  ASSERT_TRUE(write_submission(submission_)) << "by another engine, the shards are the same";
  submission_.command[3] = "mc-hard";
  EXPECT_THAT(write_submission(submission_).error().text, HasSubstr("another command"));
}

/// Runs what --submit ssh writes with a program that ends as each of `ends` says.
int end_of(Submission submission, const std::string& ends) {
  submission.engine = "ssh";
  submission.from = "/";
  submission.command = {submission.folder + "/program"};
  const auto start = write_submission(submission);
  if (!start) return -1;
  std::ofstream{submission.command.front()}
      << "#!/bin/sh\n[ $1 = merge ] && exit 1\nset -- ${2%/*} " << ends
      << "\nshift $1\nshift\n[ $1 = killed ] && kill -9 $$\nexit $1\n";
  std::filesystem::permissions(submission.command.front(), std::filesystem::perms::owner_all);
  return WEXITSTATUS(std::system(("sh " + *start + " >/dev/null 2>&1").c_str()));
}

TEST_F(SubmissionTest, OverSshItEndsAsTheWorstShardDid) {
  if (std::system("command -v parallel >/dev/null") != 0) GTEST_SKIP() << "no GNU parallel";
  EXPECT_EQ(end_of(submission_, "0 0 0"), 1) << "as the merge";
  EXPECT_EQ(end_of(submission_, "0 2 0"), 2);
  EXPECT_EQ(end_of(submission_, "1 3 2"), 3);
  EXPECT_EQ(end_of(submission_, "0 killed 0"), 4) << "cut short";
  EXPECT_EQ(end_of(submission_, "0 0 255"), 3) << "a host that cannot be reached";
}

TEST_F(SubmissionTest, WithoutAFolderNothingIsWritten) {
  submission_.folder.clear();
  EXPECT_THAT(write_submission(submission_).error().text, HasSubstr("--folder"));
}

}  // namespace
}  // namespace palp::config
