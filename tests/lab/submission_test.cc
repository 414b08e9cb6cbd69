#include "lab/submission.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "common/core/whole_file.h"

namespace palp::lab {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class SubmissionTest : public testing::Test {
 protected:
  ~SubmissionTest() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] config::ExitStatus progress() const {
    config::CommandLine line{"palp-lab", "tests"};
    const ProgressCommand command{line};
    const std::array argv{"palp-lab", "progress", folder_.c_str()};
    const auto refused = line.parse(static_cast<int>(argv.size()), argv.data());
    return refused ? *refused : command.run();
  }

  std::string folder_{testing::TempDir() + "palp_submission_" + std::to_string(::getpid())};
  Submission submission_{
      .engine = "print",
      .folder = folder_,
      .hosts = {},
      .shards = 3,
      .from = "/srv/it's",
      .command = {"/bin/palp-lab", "montecarlo", "--set", "mc", "--report=r.json", "--svg", "x"}};
};

TEST(CommandOfShardTest, KeepsWhatTheCasesAreAndDropsTheRest) {
  const std::vector<std::string> words{"palp-lab",
                                       "montecarlo",
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
  EXPECT_THAT(command_of_shard(words),
              ElementsAre("palp-lab", "montecarlo", "--set", "mc", "--seed", "7"));
  EXPECT_THAT(outputs_of(words), ElementsAre("--report", "all.json"));
}

TEST_F(SubmissionTest, AShardRunsItsPartOnlyOnceAndTheMergeWritesTheReport) {
  const std::string shard = shard_script(submission_);
  EXPECT_THAT(shard, HasSubstr("[ -s \"$part\" ] && exit 0"));
  EXPECT_THAT(shard, HasSubstr("'--set' 'mc' --shard \"$shard/3\" --cases \"$part\""));
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
  EXPECT_EQ(progress().code, config::ExitCode::CannotOpen);
  ASSERT_TRUE(write_submission(submission_));
  std::ofstream{folder_ + "/part-1.csv"} << "rows";
  EXPECT_EQ(progress().code, config::ExitCode::Missed);
  EXPECT_THAT(progress().text, HasSubstr("1 of 3 shards; missing: 0, 2"));
  std::ofstream{folder_ + "/part-0.csv"} << "rows";
  std::ofstream{folder_ + "/part-2.csv"} << "rows";
  EXPECT_EQ(progress().code, config::ExitCode::Done);
}

TEST_F(SubmissionTest, WithoutAFolderNothingIsWritten) {
  submission_.folder.clear();
  EXPECT_THAT(write_submission(submission_).error().text, HasSubstr("--folder"));
}

}  // namespace
}  // namespace palp::lab
