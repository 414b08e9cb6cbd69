#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include "tests/system/process.h"

/// Goal: what cannot work is told in one sentence on standard error, and in the exit code.
/// Method: the programs with one thing wrong.
namespace palp::system_test {
namespace {

using testing::HasSubstr;

constexpr int kBadInput = 2;
constexpr int kNotReached = 3;
constexpr int kCutShort = 4;

class BadInputTest : public ::testing::Test {
 protected:
  ~BadInputTest() override { std::filesystem::remove_all(folder_); }

  /// One line about `about` on standard error, nothing on standard output, and `code`.
  void expect_refusal(const std::string& command, int code, const std::string& about) const {
    SCOPED_TRACE(command);
    EXPECT_EQ(run(command), code);
    const std::string complaint = text("err");
    EXPECT_EQ(std::ranges::count(complaint, '\n'), 1) << complaint;
    EXPECT_THAT(complaint, HasSubstr(about));
    EXPECT_EQ(text("out"), "");
  }

  /// @returns the exit code; 124 if it still ran after 20 s.
  [[nodiscard]] int run(const std::string& command) const {
    const std::string line = "timeout -s KILL 20 '" PALP_BINARY_FOLDER "'/" + command + " >'" +
                             folder_ + "/out' 2>'" + folder_ + "/err' </dev/null";
    const int status = std::system(line.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  [[nodiscard]] std::string text(const std::string& name) const {
    std::ifstream file{folder_ + "/" + name};
    return {std::istreambuf_iterator<char>{file}, {}};
  }

  std::string folder_{make_folder("bad-input")};
};

TEST_F(BadInputTest, AReportThatWouldTakeThePlaceOfAnotherFile) {
  const std::string file = folder_ + "/precious";
  std::ofstream{file} << "content";
  for (const std::string command : {"palp-surgeon --peer 127.0.0.1:9 --session-file ",
                                    "palp-patient --listen 127.0.0.1:0 --phantom file:",
                                    "palp-patient check --config ",
                                    "palp-lab merge ",
                                    "palp-lab montecarlo --count 1 --cases ",
                                    "palp-lab run standard --no-such-flag --trace ",
                                    "palp-netem relay --listen 127.0.0.1:0 --timeline ",
                                    "palp-review metrics "}) {
    SCOPED_TRACE(command);
    EXPECT_EQ(run(command + file + " --report " + file), kBadInput);
    EXPECT_EQ(text("precious"), "content");
  }
  expect_refusal("palp-lab merge " + file + " --report " + file, kBadInput, "name one file");
}

TEST_F(BadInputTest, AnOutputThatWouldTakeThePlaceOfAnotherFile) {
  const std::string file = folder_ + "/precious";
  std::ofstream{file} << "content";
  const std::string pair = " --surgeon other --patient " + file;
  for (const std::string& command : {"palp-review report" + pair + " --out ",
                                     "palp-review plot" + pair + " --svg ",
                                     "palp-review plot" + pair + " --pdf ",
                                     "palp-lab run " + file + " --svg ",
                                     "palp-lab run standard --phantom file:" + file + " --trace ",
                                     "palp-lab merge " + file + " --cases ",
                                     "palp-fem merge " + file + " --out ",
                                     "palp-fem curve --vtu " + file + " --csv "}) {
    expect_refusal(command + file, kBadInput, "name one file");
    EXPECT_EQ(text("precious"), "content");
  }
  const std::string prefix = folder_ + "/q";
  expect_refusal(
      "palp-lab run standard --session-files " + prefix + " --trace " + prefix + "surgeon.mcap",
      kBadInput,
      "name one file");
  std::ofstream{folder_ + "/old.mcap"} << "\x89MCAP0\r\n";
  expect_refusal("palp-fem curve --indentations-mm 0.5 --csv " + folder_ + "/old.mcap",
                 kBadInput,
                 "a session file");
}

TEST_F(BadInputTest, UnknownFlag) {
  for (const std::string program :
       {"palp-surgeon", "palp-patient", "palp-lab run", "palp-netem relay"}) {
    expect_refusal(program + " --no-such-flag", kBadInput, "--no-such-flag");
  }
}

TEST_F(BadInputTest, UnknownPhantom) {
  expect_refusal(
      "palp-patient --listen 127.0.0.1:0 --insecure --phantom jelly", kBadInput, "'jelly'");
}

TEST_F(BadInputTest, BadNumber) {
  const std::string surgeon = "palp-surgeon --peer 127.0.0.1:9 --insecure ";
  expect_refusal(surgeon + "--loss a-lot", kBadInput, "--loss = a-lot");
  expect_refusal(surgeon + "--loss 1.5", kBadInput, "0 to 1");
  expect_refusal("palp-netem relay --listen 127.0.0.1:0 --forward 127.0.0.1:9 --rtt-ms long",
                 kBadInput,
                 "--rtt-ms = long");
}

TEST_F(BadInputTest, PortInUse) {
  Process patient{"palp-patient", {"--listen", "127.0.0.1:0", "--insecure"}, folder_ + "/log"};
  const std::string address = patient.address();
  ASSERT_NE(address, "") << patient.output();
  expect_refusal(
      "palp-netem relay --forward 127.0.0.1:9 --listen " + address, kNotReached, address);
}

TEST_F(BadInputTest, MissingFile) {
  expect_refusal("palp-surgeon --config no-such-file", kNotReached, "no-such-file");
  expect_refusal("palp-patient --config no-such-file", kNotReached, "no-such-file");
  expect_refusal("palp-review check no-such-file", kNotReached, "no-such-file");
  expect_refusal("palp-surgeon --peer 127.0.0.1:9 --insecure --master script:no-such-file",
                 kNotReached,
                 "no-such-file");
  expect_refusal("palp-patient --listen 127.0.0.1:0 --insecure --phantom file:no-such-file",
                 kNotReached,
                 "no-such-file");
  expect_refusal("palp-lab run no-such-file", kBadInput, "no-such-file");
}

TEST_F(BadInputTest, AReportThatCannotBeWrittenIsToldBeforeTheSession) {
  const std::string nowhere = " --report /nowhere/at/all.json";
  for (const std::string program : {"palp-patient --listen 127.0.0.1:0 --insecure",
                                    "palp-surgeon --peer 127.0.0.1:9 --insecure",
                                    "palp-surgeon check --seconds 9",
                                    "palp-netem relay --listen 127.0.0.1:0 --forward 127.0.0.1:9",
                                    "palp-lab run long"}) {
    expect_refusal(program + nowhere, kNotReached, "--report: cannot write /nowhere/at/all.json");
  }
}

TEST_F(BadInputTest, AReportInPlaceOfTheSessionFileIsToldBeforeTheSession) {
  const std::string old = folder_ + "/old.mcap";
  const std::string second = folder_ + "/report";
  std::ofstream{old} << "an old session";
  std::filesystem::create_hard_link(old, second);
  const std::string sentence = "name one file";
  for (const std::string program : {"palp-patient --listen 127.0.0.1:0 --insecure --report ",
                                    "palp-surgeon --peer 127.0.0.1:9 --insecure --report "}) {
    for (const std::string& file :
         {" --session-file " + second, " --session-file " + old, " --set record.file=" + old}) {
      std::string line = program;
      line.append(second).append(file);
      expect_refusal(line, kBadInput, sentence);
      // What is wrong besides is told; no report of it in that place.
      line.append(" --loss 9");
      expect_refusal(line, kBadInput, "0 to 1");
      EXPECT_EQ(text("old.mcap"), "an old session");
    }
  }
}

TEST_F(BadInputTest, KeysOfTwoAuthoritiesAreToldWithTheRemedyAndNotRetried) {
  const std::string ours = folder_ + "/ours";
  const std::string theirs = folder_ + "/theirs";
  ASSERT_TRUE(make_certificates(ours) && make_certificates(theirs));
  Process patient{"palp-patient",
                  {"--listen", "127.0.0.1:0", "--identity", ours + "/patient"},
                  folder_ + "/log"};
  const std::string address = patient.address();
  ASSERT_NE(address, "") << patient.output();
  EXPECT_EQ(run("palp-surgeon --peer " + address + " --identity '" + theirs + "/surgeon'"),
            kNotReached);
  EXPECT_THAT(text("err"), HasSubstr("keys come from two different authorities"));
  EXPECT_THAT(text("err"), HasSubstr("palp-surgeon certificates"));
}

TEST_F(BadInputTest, EveryProgramComplainsInTheSameForm) {
  for (const std::string program : {"palp-surgeon --peer nowhere --insecure",
                                    "palp-patient --listen nowhere --insecure",
                                    "palp-netem presets moon",
                                    "palp-lab run moon",
                                    "palp-review check moon"}) {
    EXPECT_NE(run(program), 0);
    EXPECT_EQ(text("err").find(program.substr(0, program.find(' ')) + ": "), 0U) << text("err");
  }
}

TEST_F(BadInputTest, AResultThatStandardOutputDoesNotTakeIsNotDone) {
  for (const std::string command : {"palp-fem curve --indentations-mm 0.5",
                                    "palp-netem presets",
                                    "palp-lab scenarios",
                                    "palp-review --version",
                                    "palp-surgeon --help"}) {
    SCOPED_TRACE(command);
    const std::string line =
        "'" PALP_BINARY_FOLDER "'/" + command + " >/dev/full 2>'" + folder_ + "/err'";
    const int status = std::system(line.c_str());
    EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, kNotReached);
    EXPECT_THAT(text("err"), HasSubstr(": standard output could not be written"));
  }
}

TEST_F(BadInputTest, ARunWhoseSessionFilesAreNotWholeIsNotDone) {
  // No file of more than 100 kB, as on a disk that is full.
  const std::string line = "trap '' XFSZ; ulimit -f 200; '" PALP_BINARY_FOLDER
                           "'/palp-lab run standard --session-files '" +
                           folder_ + "/x-' --report '" + folder_ + "/r.json' >'" + folder_ +
                           "/out' 2>'" + folder_ + "/err'";
  const int status = std::system(line.c_str());
  EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 1);
  EXPECT_THAT(text("err"), HasSubstr("recording failed: session file "));
  EXPECT_THAT(text("out"), HasSubstr("stability")) << "the run is worth what it was";
  EXPECT_THAT(text("r.json"), HasSubstr("could not be written any further"));
}

TEST_F(BadInputTest, ARunWhoseOperatorIsRefusedIsNotDone) {
  const std::string scenario = folder_ + "/refused.textproto";
  std::ofstream{scenario} << "surgeon { coupling { name: 'direct' } } up { delay_ms: 50 }\n"
                             "patient { coupling { name: 'direct' } } down { delay_ms: 50 }\n";
  EXPECT_EQ(run("palp-lab run --bare " + scenario), kCutShort);
  EXPECT_THAT(text("out"), HasSubstr("stability"));
  EXPECT_THAT(text("err"), HasSubstr("refused"));
}

}  // namespace
}  // namespace palp::system_test
