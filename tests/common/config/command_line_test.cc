#include "common/config/command_line.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <unistd.h>

#include "common/config/report.h"
#include "proto/config.pb.h"
#include "tests/support/own_path.h"

namespace palp::config {
namespace {

using testing::HasSubstr;

std::optional<ExitStatus> parse(CommandLine& line, const std::vector<std::string>& words) {
  std::vector<const char*> argv{"program"};
  for (const std::string& word : words) {
    argv.push_back(word.c_str());
  }
  return line.parse(static_cast<int>(argv.size()), argv.data());
}

/// A program with a flag of each kind, and what it read.
struct Program {
  CommandLine line{"palp-x", "does x"};
  std::string report;
  std::string mode{"exact"};
  double rate{1};
  std::uint64_t count{10};
  std::optional<double> limit;
  std::optional<std::uint64_t> seed;
  std::optional<HostAndPort> peer;
  bool bare{};

  Program() {
    line.text("--report", report, "FILE", "where the report goes");
    line.choice("--mode", mode, {"exact", "netem-6.1"}, "which one");
    line.number("--rate-hz", rate, {.min = 0.5, .max = 50, .unit = "Hz"}, "how often");
    line.whole("--count", count, {.min = 1, .max = 100, .unit = "packets"}, "how many");
    line.number("--limit-n", limit, {.min = -1, .max = 1, .unit = "N"}, "how far");
    line.whole("--seed", seed, {.min = 0, .max = UINT64_MAX}, "seed of the run");
    line.address("--peer", peer, 1, "where to");
    line.toggle("--bare", bare, "without bytes");
  }
};

/// The sentence that `words` get, without the program's name; the code must be BadInput.
std::string refusal(const std::vector<std::string>& words) {
  Program program;
  const auto exit_status = parse(program.line, words);
  if (!exit_status) {
    return "";
  }
  EXPECT_EQ(exit_status->code, ExitCode::BadInput);
  EXPECT_EQ(exit_status->text.rfind("palp-x: ", 0), 0U) << exit_status->text;
  return exit_status->text.substr(8);
}

TEST(CommandLineTest, ReadsFlagsOfEveryKind) {
  Program program;
  EXPECT_FALSE(program.line.given("--report"));
  ASSERT_FALSE(parse(program.line,
                     {"--report",
                      "a.json",
                      "--mode=netem-6.1",
                      "--rate-hz",
                      "2.5",
                      "--count",
                      "7",
                      "--limit-n",
                      "-0.5",
                      "--seed",
                      "18446744073709551615",
                      "--peer",
                      "127.0.0.1:9000",
                      "--bare"}));
  EXPECT_EQ(program.report, "a.json");
  EXPECT_EQ(program.mode, "netem-6.1");
  EXPECT_EQ(program.rate, 2.5);
  EXPECT_EQ(program.count, 7U);
  EXPECT_EQ(program.limit, -0.5);
  EXPECT_EQ(program.seed, UINT64_MAX);
  EXPECT_EQ(program.peer, (HostAndPort{.host = "127.0.0.1", .port = 9000}));
  EXPECT_TRUE(program.bare);
  EXPECT_TRUE(program.line.given("--report"));
}

TEST(CommandLineTest, AReportIsKnownAlsoWhereAWordTooManyEndsTheProgram) {
  Program program;
  ASSERT_TRUE(parse(program.line, {"--bogus", "--report", "a.json"}));
  EXPECT_EQ(program.report, "a.json");
}

TEST(CommandLineTest, KeepsDefaultsOfWhatIsNotGiven) {
  Program program;
  ASSERT_FALSE(parse(program.line, {}));
  EXPECT_EQ(program.rate, 1);
  EXPECT_EQ(program.count, 10U);
  EXPECT_FALSE(program.limit);
  EXPECT_FALSE(program.seed);
  EXPECT_FALSE(program.bare);
}

TEST(CommandLineTest, NamesFlagValueAndLimit) {
  EXPECT_EQ(refusal({"--rate-hz", "50.5"}), "--rate-hz = 50.5 is out of range: 0.5 to 50 Hz");
  EXPECT_EQ(refusal({"--rate-hz", "fast"}), "--rate-hz = fast is not a number: 0.5 to 50 Hz");
  EXPECT_EQ(refusal({"--count", "0"}), "--count = 0 is out of range: 1 to 100 packets");
  EXPECT_EQ(refusal({"--count", "-3"}), "--count = -3 is not a whole number: 1 to 100 packets");
  EXPECT_EQ(refusal({"--mode", "fast"}), "--mode = fast is not one of: exact, netem-6.1");
  EXPECT_EQ(refusal({"--peer", "here"}),
            "--peer: address \"here\" has no port; expected HOST:PORT, for example 127.0.0.1:9000");
}

TEST(CommandLineTest, HoldsRangesOnBothSidesOfTheirBorders) {
  EXPECT_EQ(refusal({"--rate-hz", "0.5"}), "");
  EXPECT_EQ(refusal({"--rate-hz", "50"}), "");
  EXPECT_NE(refusal({"--rate-hz", "0.4999999999999999"}), "");
  EXPECT_NE(refusal({"--rate-hz", "50.00000000000001"}), "");
  EXPECT_EQ(refusal({"--count", "1"}), "");
  EXPECT_EQ(refusal({"--count", "100"}), "");
  EXPECT_NE(refusal({"--count", "101"}), "");
  EXPECT_NE(refusal({"--seed", "18446744073709551616"}), "");
  EXPECT_NE(refusal({"--peer", "127.0.0.1:0"}), "");
}

TEST(CommandLineTest, RefusesWhatIsNotWhollyAFiniteNumber) {
  for (const char* value : {"nan", "inf", "-inf", "1e999", "2x", " 2", "2 ", "+2", "0x2", ""}) {
    EXPECT_NE(refusal({"--rate-hz", value}), "") << value;
  }
}

TEST(CommandLineTest, RefusesUnknownMissingAndRepeated) {
  EXPECT_EQ(refusal({"--nothing"}), "\"--nothing\" is not expected here; see --help");
  EXPECT_EQ(refusal({"word"}), "\"word\" is not expected here; see --help");
  EXPECT_EQ(refusal({"--report"}), "--report needs a value");
  EXPECT_EQ(refusal({"--report", "--bare"}), "--report needs a value, not --bare");
  EXPECT_EQ(refusal({"--report", ""}), "--report is empty");
  EXPECT_EQ(refusal({"--seed", "1", "--seed", "2"}),
            "--seed is given 2 times, at most once is meant");
  EXPECT_EQ(refusal({"--bare=maybe"}), "--bare takes no value");
  EXPECT_EQ(refusal({"--bare=false"}), "--bare takes no value");
  EXPECT_NE(refusal({"--rep", "a"}), "") << "no abbreviations";
}

TEST(CommandLineTest, HelpSaysMeaningUnitRangeAndDefault) {
  Program program;
  const auto exit_status = parse(program.line, {"--help"});
  ASSERT_TRUE(exit_status);
  EXPECT_EQ(exit_status->code, ExitCode::Done);
  EXPECT_THAT(exit_status->text, HasSubstr("does x"));
  EXPECT_THAT(exit_status->text, HasSubstr("how often [Hz], 0.5 to 50, default 1"));
  EXPECT_THAT(exit_status->text, HasSubstr("--peer HOST:PORT"));
}

TEST(CommandLineTest, HelpWinsOverMistakes) {
  Program program;
  const auto exit_status = parse(program.line, {"--help", "--nothing", "--rate-hz", "x"});
  ASSERT_TRUE(exit_status);
  EXPECT_EQ(exit_status->code, ExitCode::Done);
}

TEST(CommandLineTest, VersionNamesTheProgram) {
  Program program;
  const auto exit_status = parse(program.line, {"--version"});
  ASSERT_TRUE(exit_status);
  EXPECT_EQ(exit_status->code, ExitCode::Done);
  EXPECT_EQ(exit_status->text.rfind("palp-x (palp) 0.", 0), 0U) << exit_status->text;
}

/// A program with verbs, each with flags and arguments of its own.
struct VerbProgram {
  CommandLine line{"palp-v", "has verbs"};
  CommandLine& run{line.verb("run", "runs a scenario")};
  CommandLine& merge{line.verb("merge", "merges files")};
  std::string scenario;
  std::optional<std::uint64_t> seed;
  std::vector<std::string> files;

  VerbProgram() {
    run.argument("SCENARIO", scenario, "what to run");
    run.required();
    run.whole("--seed", seed, {.min = 0, .max = 9}, "seed");
    merge.arguments("FILES", files, "what to merge");
  }
};

std::string verb_refusal(const std::vector<std::string>& words) {
  VerbProgram program;
  const auto exit_status = parse(program.line, words);
  return exit_status ? exit_status->text : "";
}

TEST(CommandLineTest, ReadsVerbsAndArguments) {
  VerbProgram program;
  ASSERT_FALSE(parse(program.line, {"run", "standard", "--seed", "3"}));
  EXPECT_EQ(program.line.chosen_verb(), "run");
  EXPECT_EQ(program.scenario, "standard");
  EXPECT_EQ(program.seed, 3U);
  VerbProgram other;
  ASSERT_FALSE(parse(other.line, {"merge", "a", "b", "c"}));
  EXPECT_EQ(other.line.chosen_verb(), "merge");
  EXPECT_THAT(other.files, testing::ElementsAre("a", "b", "c"));
}

TEST(CommandLineTest, TakesFlagsOfTheProgramOnBothSidesOfTheVerb) {
  for (const bool behind : {false, true}) {
    VerbProgram program;
    std::string report;
    program.line.text("--report", report, "FILE", "report");
    using Words = std::vector<std::string>;
    ASSERT_FALSE(parse(program.line,
                       behind ? Words{"run", "standard", "--report", "r", "--seed", "3"}
                              : Words{"--report", "r", "run", "standard", "--seed", "3"}));
    EXPECT_EQ(report, "r");
    EXPECT_EQ(program.seed, 3U);
  }
}

TEST(CommandLineTest, RefusesWrongVerbsAndArguments) {
  EXPECT_EQ(verb_refusal({}), "palp-v: a verb is missing, one of: run, merge");
  EXPECT_EQ(verb_refusal({"walk"}), "palp-v: \"walk\" is no verb of palp-v, there are: run, merge");
  EXPECT_EQ(verb_refusal({"run"}), "palp-v: SCENARIO is missing; see --help");
  EXPECT_EQ(verb_refusal({"merge"}), "palp-v: FILES is missing; see --help");
  EXPECT_EQ(verb_refusal({"run", "a", "b"}), "palp-v: \"b\" is not expected here; see --help");
  EXPECT_EQ(verb_refusal({"run", "a", "--seed", "10"}),
            "palp-v: --seed = 10 is out of range: 0 to 9");
  EXPECT_NE(verb_refusal({"run", "a", "merge", "b"}), "");
  EXPECT_NE(verb_refusal({"merge", "a", "--seed", "1"}), "") << "a flag of another verb";
}

TEST(CommandLineTest, HelpOfAVerbIsItsOwn) {
  VerbProgram program;
  const auto exit_status = parse(program.line, {"run", "--help"});
  ASSERT_TRUE(exit_status);
  EXPECT_EQ(exit_status->code, ExitCode::Done);
  EXPECT_THAT(exit_status->text, HasSubstr("SCENARIO"));
}

TEST(CommandLineTest, VerbsMayBeOptional) {
  VerbProgram program;
  program.line.verbs_optional();
  ASSERT_FALSE(parse(program.line, {}));
  EXPECT_EQ(program.line.chosen_verb(), "");
}

/// A site, as its main() would declare it.
class SettingsFlagsTest : public testing::Test {
 protected:
  SettingsFlagsTest() {
    line_.settings(document_);
    line_.knob("--delay-ms", "impairment.delay_ms");
    line_.knob("--listen", "listen");
    line_.knob("--insecure", "link.insecure");
  }
  ~SettingsFlagsTest() override { std::filesystem::remove(file_); }

  [[nodiscard]] const proto::config::PatientConfig& patient() const {
    return document_.as<proto::config::PatientConfig>();
  }

  Document document_{patient_document()};
  CommandLine line_{"palp-patient", "the patient site"};
  std::string file_{test::own_path("command_line_test.conf")};
};

TEST_F(SettingsFlagsTest, FlagsBeatSetWhichBeatsTheFileWhichBeatsDefaults) {
  ASSERT_TRUE(write_whole_file(
      file_, "impairment { delay_ms: 1 jitter_ms: 1 loss: 0.5 } motion_gate { force_limit_n: 1 }"));
  ASSERT_FALSE(parse(line_,
                     {"--delay-ms",
                      "3",
                      "--set",
                      "impairment.delay_ms=2",
                      "--set",
                      "impairment.jitter_ms=2",
                      "--config",
                      file_,
                      "--insecure"}));
  EXPECT_EQ(patient().impairment().delay_ms(), 3);
  EXPECT_EQ(patient().impairment().jitter_ms(), 2);
  EXPECT_EQ(patient().impairment().loss(), 0.5);
  EXPECT_EQ(patient().motion_gate().force_limit_n(), 1);
  EXPECT_EQ(patient().motion_gate().force_stop_n(), 5);
  EXPECT_TRUE(patient().link().insecure());
}

TEST_F(SettingsFlagsTest, NamesTheFlagOfABadKnob) {
  const auto exit_status = parse(line_, {"--delay-ms", "nan"});
  ASSERT_TRUE(exit_status);
  EXPECT_EQ(exit_status->code, ExitCode::BadInput);
  EXPECT_EQ(exit_status->text,
            "palp-patient: --delay-ms = nan is not a number: one-way delay [ms], 0 to 5000, "
            "default 0");
}

TEST_F(SettingsFlagsTest, NamesThePathOfABadSetting) {
  const auto exit_status = parse(line_, {"--set", "motion_gate.force_limit_n=12"});
  ASSERT_TRUE(exit_status);
  EXPECT_EQ(exit_status->code, ExitCode::BadInput);
  EXPECT_EQ(exit_status->text,
            "palp-patient: --set motion_gate.force_limit_n = 12 is out of range: 0.1 to 10 N");
}

TEST_F(SettingsFlagsTest, NamesThePlaceInABadFile) {
  ASSERT_TRUE(write_whole_file(file_, "seed: 1\nseed: x\n"));
  const auto exit_status = parse(line_, {"--config", file_});
  ASSERT_TRUE(exit_status);
  EXPECT_EQ(exit_status->code, ExitCode::BadInput);
  EXPECT_THAT(exit_status->text, HasSubstr(":2:"));
}

TEST_F(SettingsFlagsTest, AFileThatCannotBeReadIsCannotOpen) {
  const auto exit_status = parse(line_, {"--config", "/nowhere/a.conf"});
  ASSERT_TRUE(exit_status);
  EXPECT_EQ(exit_status->code, ExitCode::CannotOpen);
  EXPECT_EQ(exit_status->text,
            "palp-patient: --config: cannot read /nowhere/a.conf: No such file or directory");
}

TEST_F(SettingsFlagsTest, ChecksRelationsWhenAllIsTogether) {
  const auto exit_status = parse(line_, {"--set", "link.hold_after_ms=600"});
  ASSERT_TRUE(exit_status);
  EXPECT_THAT(exit_status->text, HasSubstr("is above link.lost_after_ms = 500 ms"));
}

TEST_F(SettingsFlagsTest, HelpListsFlagsAndEverySetting) {
  const auto exit_status = parse(line_, {"--help"});
  ASSERT_TRUE(exit_status);
  EXPECT_THAT(exit_status->text, HasSubstr("one-way delay [ms], 0 to 5000, default 0"));
  EXPECT_THAT(exit_status->text, HasSubstr("motion_gate.force_limit_n"));
  EXPECT_THAT(exit_status->text, HasSubstr("simulated_phantom.sensor_noise_mn"));
}

RC_GTEST_PROP(CommandLineTest, GarbageGetsOneSentence, (const std::vector<std::string>& noise)) {
  std::vector<std::string> words;
  for (const std::string& word : noise) {
    words.push_back(word.substr(0, word.find('\0')));
    if (word.size() % 3 == 0) {
      words.emplace_back("--rate-hz");
    }
  }
  Program program;
  const auto exit_status = parse(program.line, words);
  RC_ASSERT(!exit_status || exit_status->code == ExitCode::Done ||
            (exit_status->code == ExitCode::BadInput &&
             exit_status->text.find('\n') == std::string::npos));
}

TEST(FooterTest, StandsInTheHelpOfItsVerb) {
  CommandLine line{"palp-x", "does x"};
  line.verb("go", "goes").footer("Words of a path: straight, round.");
  const auto exit_status = parse(line, {"go", "--help"});
  ASSERT_TRUE(exit_status);
  EXPECT_EQ(exit_status->code, ExitCode::Done);
  EXPECT_THAT(exit_status->text, HasSubstr("Words of a path: straight, round."));
}

}  // namespace
}  // namespace palp::config
