#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "netem/relay/relay_report.h"
#include "tests/netem/model/datagrams.h"
#include "tests/netem/relay/control_line.h"
#include "tests/system/process.h"

/// Goal: palp-netem does what its command line says, and tells scripts how it ended.
/// Method: the program itself between sockets of the test.
namespace palp::netem {
namespace {

using system_test::Process;
using testing::HasSubstr;
using testing::StartsWith;

constexpr auto kLimit = std::chrono::duration_cast<std::chrono::milliseconds>(kDeadline);

class RelayProgramTest : public ::testing::Test {
 protected:
  ~RelayProgramTest() override { std::filesystem::remove_all(folder_); }
  /// palp-netem with a log of its own.
  Process start(std::vector<std::string> arguments) {
    const std::string log = folder_ + "/log" + std::to_string(++started_);
    return Process{"palp-netem", std::move(arguments), log};
  }
  Process start_relay(const std::vector<std::string>& more) {
    std::vector<std::string> arguments{
        "relay", "--listen", "localhost:0", "--forward", "localhost:9"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return start(arguments);
  }
  /// Where a relay listens for live control, once it serves.
  static std::string control_of(Process& program) {
    EXPECT_TRUE(program.wait_for("\ndown ", kLimit)) << program.output();
    const std::string output = program.output();
    const std::size_t at = output.find("control on ") + 11;
    return output.substr(at, output.find('\n', at) - at);
  }
  [[nodiscard]] std::string report_path() const { return folder_ + "/report.json"; }
  const std::string folder_ = system_test::make_folder("palp-netem");
  const std::string control_ = "unix:" + folder_ + "/control";
  int started_{};
};

TEST_F(RelayProgramTest, ForwardsUntilASignalAndWritesItsReport) {
  for (const int number : {SIGINT, SIGTERM}) {
    DatagramSocket server = DatagramSocket::bound(kAnyPort);
    Process program = start({"relay",
                             "--listen",
                             "localhost:0",
                             "--forward",
                             server.local().to_string(),
                             "--up",
                             "delay 2ms",
                             "--down",
                             "loss 100%",
                             "--seed",
                             "5",
                             "--report",
                             report_path()});
    const auto address = io::resolve_endpoint(program.address());
    ASSERT_TRUE(address) << program.output();
    DatagramSocket client = DatagramSocket::connected(*address);
    for (std::uint32_t i = 0; i < 20; ++i) client.send(saying(i), std::nullopt);
    Heard heard;
    const TimePoint until = monotonic_now() + kDeadline;
    while (heard.numbers.size() < 20 && monotonic_now() < until) hear(server, heard);
    ASSERT_EQ(heard.numbers.size(), 20U);
    server.send(saying(1), heard.from);
    // The reply is lost on the way; a datagram up that arrives later tells that it has been read.
    client.send(saying(20), std::nullopt);
    while (heard.numbers.size() < 21 && monotonic_now() < until) hear(server, heard);
    program.signal(number);
    EXPECT_EQ(program.wait(kLimit), 0) << program.output();

    const auto report = nlohmann::json::parse(std::ifstream{report_path()});
    EXPECT_EQ(report["schema"], "palp.relay/1");
    EXPECT_EQ(report["seed"], 5);
    EXPECT_EQ(report["up"]["asked"], "delay 2ms");
    EXPECT_EQ(report["up"]["sent"], 21);
    EXPECT_EQ(report["up"]["received"], 21);
    EXPECT_EQ(report["up"]["lost"], 0);
    EXPECT_GE(report["up"]["delay_p50_ms"].get<double>(), 1.98);
    EXPECT_EQ(report["down"]["sent"], 1);
    EXPECT_EQ(report["down"]["lost"], 1);
    EXPECT_TRUE(report["down"]["delay_p50_ms"].is_null());
    for (const char* key : {"duplicated",
                            "reordered",
                            "delay_p99_ms",
                            "jitter_ms",
                            "late_releases",
                            "socket_errors"}) {
      EXPECT_TRUE(report["up"].contains(key)) << key;
    }
  }
}

TEST_F(RelayProgramTest, EndsAfterItsDuration) {
  Process program =
      start_relay({"--preset", "lan", "--duration-s", "0.01", "--report", report_path()});
  EXPECT_EQ(program.wait(kLimit), 0) << program.output();
  EXPECT_EQ(nlohmann::json::parse(std::ifstream{report_path()})["preset"], "lan");
}

TEST_F(RelayProgramTest, LossIsAFractionOrAShare) {
  for (const char* loss : {"0.05", "5%"}) {
    Process program = start_relay({"--loss", loss, "--duration-s", "0.001"});
    EXPECT_EQ(program.wait(kLimit), 0) << program.output();
    EXPECT_THAT(program.output(), HasSubstr("\nup   loss 5%\n")) << loss;
  }
}

TEST_F(RelayProgramTest, PassesBetweenTheFamiliesOfAddresses) {
  Process program =
      start({"relay", "--listen", "[::1]:0", "--forward", "127.0.0.1:9", "--duration-s", "0.001"});
  EXPECT_EQ(program.wait(kLimit), 0);
  EXPECT_THAT(program.output(), HasSubstr("listening on [::1]:"));
}

TEST_F(RelayProgramTest, SimulatesIntoACsv) {
  const std::string csv = folder_ + "/decisions.csv";
  Process program = start({"simulate",
                           "--spec",
                           "delay 10ms rate 2mbit",
                           "--packets",
                           "20",
                           "--interval-us",
                           "1000",
                           "--burst",
                           "10",
                           "--mode",
                           "netem-6.1",
                           "--seed",
                           "5",
                           "--direction",
                           "down",
                           "--csv",
                           csv});
  EXPECT_EQ(program.wait(kLimit), 0) << program.output();
  std::ifstream file{csv};
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line, "index,sent_ns,arrived_ns,copy,verdict,flipped_bit");
  std::getline(file, line);
  EXPECT_EQ(line, "0,0,10568000,0,delivered,");
  for (int i = 0; i < 10; ++i) std::getline(file, line);
  EXPECT_EQ(line, "10,10000000,20568000,0,delivered,");
}

TEST_F(RelayProgramTest, SimulateRefusesWithTheColumn) {
  Process program = start({"simulate", "--spec", "delay 10ms los 5x%", "--packets", "20"});
  EXPECT_EQ(program.wait(kLimit), 2);
  EXPECT_THAT(program.output(), HasSubstr("column 16"));
}

TEST_F(RelayProgramTest, FollowsATimelineAndItsControl) {
  const std::string timeline = folder_ + "/day.textproto";
  std::ofstream{timeline} << "event { set: \"delay 1ms\" }\n";
  Process program =
      start_relay({"--timeline", timeline, "--control", control_, "--report", report_path()});
  const std::string address = control_of(program);
  EXPECT_THAT(ask(address, "{\"set\":\"delay 5ms\"}"), HasSubstr("applied_at_s"));
  EXPECT_THAT(ask(address, "{\"set\":\"delay 5minutes\"}"), HasSubstr("column 7"));
  EXPECT_THAT(ask(address, "{\"stats\":true}"), HasSubstr("\"up\":{\"sent\":0"));
  EXPECT_THAT(ask(address, "{\"quit\":true}"), HasSubstr("quit"));
  EXPECT_EQ(program.wait(kLimit), 0) << program.output();
  EXPECT_EQ(nlohmann::json::parse(std::ifstream{report_path()})["down"]["changes_applied"], 1);
}

TEST_F(RelayProgramTest, AChangeForNowIsAppliedHoweverManyWait) {
  Process program = start_relay({"--control", control_});
  const Call call{control_of(program)};
  for (int i = 0; i < 200; ++i) call.say("{\"at_s\":900,\"set\":\"delay 9ms\"}\n");
  call.say("{\"dir\":\"UP\",\"set\":\"delay 7ms\"}\n");
  EXPECT_THAT(call.hear(), StartsWith("{\"applied_at_s\":")) << "the first that was applied";
  call.say("{\"stats\":true}\n");
  const auto stats = nlohmann::json::parse(call.hear());
  EXPECT_EQ(stats["up"]["law"], "delay 7ms");
  EXPECT_EQ(stats["down"]["law"], "none");
  call.say("{\"at_s\":0.001,\"dir\":\"DOWN\",\"rebind\":{}}\n");
  const auto applied = nlohmann::json::parse(call.hear());
  EXPECT_EQ(applied["at_s"], 0.001) << "what was asked ...";
  EXPECT_GT(applied["applied_at_s"].get<double>(), 0.001) << "... and when it was";
}

TEST_F(RelayProgramTest, ATraceKeepsTheRestOfTheLawThatHolds) {
  const std::string trace = folder_ + "/walk.csv";
  std::ofstream{trace} << "t_ms,delay_ms\n0,5\n100,7\n";
  const std::string timeline = folder_ + "/day.textproto";
  std::ofstream{timeline} << "event { set: \"delay 1ms\" }\n"
                             "event { at_s: 0.0001 dir: UP set: \"loss 100%\" }\n";
  Process program =
      start_relay({"--timeline", timeline, "--control", control_, "--control-folder", folder_});
  const Call call{control_of(program)};
  // Nobody has come yet, so nothing made the relay look at its timeline.
  call.say("{\"dir\":\"DOWN\",\"set\":\"loss 50%\"}\n{\"trace\":{\"file\":\"" + trace + "\"}}\n");
  EXPECT_THAT(call.hear(), HasSubstr("applied"));
  EXPECT_THAT(call.hear(), HasSubstr("applied"));
  call.say("{\"stats\":true}\n");
  const auto stats = nlohmann::json::parse(call.hear());
  EXPECT_THAT(stats["up"]["law"], HasSubstr("loss 100%"));
  EXPECT_THAT(stats["up"]["law"], HasSubstr("trace"));
  EXPECT_THAT(stats["down"]["law"], HasSubstr("loss 50%"));
}

TEST_F(RelayProgramTest, APortAsksForTheTokenOfItsFile) {
  const std::string token_file = folder_ + "/token";
  Process program = start_relay({"--control", "127.0.0.1:0", "--control-token", token_file});
  const std::string address = control_of(program);
  std::string token;
  std::ifstream{token_file} >> token;
  EXPECT_EQ(std::filesystem::status(token_file).permissions(),
            std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  EXPECT_EQ(ask(address, "{\"quit\":true}"), "");
  const Call post{address};
  post.say("POST / HTTP/1.1\r\nOrigin: http://evil.example\r\n\r\n{\"quit\":true}\n");
  EXPECT_THAT(post.hear(), HasSubstr("error"));
  const Call owner{address};
  owner.say("{\"token\": \"" + token + "\"}\n{\"stats\":true}\n");
  EXPECT_EQ(owner.hear(), "{\"token\":true}\n");
  EXPECT_THAT(owner.hear(), HasSubstr("\"up\"")) << "it still runs";
}

TEST_F(RelayProgramTest, LiveControlNamesFilesOfItsFolderOnly) {
  const std::string inside = folder_ + "/inside";
  std::filesystem::create_directory(inside);
  std::ofstream{folder_ + "/mine.csv"} << "t_ms,delay_ms\n0,5\n100,7\n";
  std::ofstream{inside + "/there-up.csv"} << "precious";
  std::filesystem::create_symlink(folder_ + "/mine.csv", inside + "/link.csv");
  Process program = start_relay({"--control", control_, "--control-folder", inside});
  const std::string address = control_of(program);
  for (const std::string& name : {folder_ + "/mine.csv",
                                  std::string{"../mine.csv"},
                                  std::string{"link.csv"},
                                  std::string{"/proc/kmsg"},
                                  std::string{"/dev/zero"}}) {
    EXPECT_THAT(ask(address, "{\"trace\":{\"file\":\"" + name + "\"}}"), HasSubstr("outside"))
        << name;
    EXPECT_THAT(ask(address, "{\"set\":\"replay " + name + "\"}"), HasSubstr("outside")) << name;
  }
  EXPECT_THAT(ask(address, "{\"record\":\"../new\"}"), HasSubstr("outside"));
  EXPECT_FALSE(std::filesystem::exists(folder_ + "/new-up.csv"));
  EXPECT_THAT(ask(address, "{\"record\":\"there\"}"), HasSubstr("error"));
  EXPECT_EQ(std::filesystem::file_size(inside + "/there-up.csv"), 8U) << "nothing is truncated";
  EXPECT_THAT(ask(address, "{\"record\":\"run\"}"), HasSubstr("{\"recording\":true}"));
  EXPECT_THAT(ask(address, "{\"record\":\"\"}"), HasSubstr("{\"recording\":false"));
  EXPECT_GT(std::filesystem::file_size(inside + "/run-up.csv"), 8U);
}

TEST_F(RelayProgramTest, WithoutAFolderLiveControlNamesNoFile) {
  Process program = start_relay({"--control", control_});
  const std::string address = control_of(program);
  std::ofstream{folder_ + "/mine.csv"} << "t_ms,delay_ms\n0,5\n100,7\n";
  EXPECT_THAT(ask(address, "{\"trace\":{\"file\":\"" + folder_ + "/mine.csv\"}}"),
              HasSubstr("--control-folder"));
  EXPECT_THAT(ask(address, "{\"record\":\"" + folder_ + "/run\"}"), HasSubstr("--control-folder"));
  EXPECT_FALSE(std::filesystem::exists(folder_ + "/run-up.csv"));
  EXPECT_THAT(ask(address, "{\"trace\":{\"file\":\"5g_n78_arterial_v80_handover.csv\"}}"),
              HasSubstr("applied_at_s"))
      << "what comes with the programs";
}

TEST_F(RelayProgramTest, EndsThoughNobodyReadsWhatItSays) {
  int ends[2];
  ASSERT_EQ(::pipe2(ends, O_NONBLOCK | O_CLOEXEC), 0);
  const std::string filling(4096, 'x');
  while (::write(ends[1], filling.data(), filling.size()) > 0) {
  }
  ::fcntl(ends[1], F_SETFL, 0);
  const std::string path = "/proc/" + std::to_string(::getpid()) + "/fd/" + std::to_string(ends[1]);
  Process program{"palp-netem",
                  {"relay",
                   "--listen",
                   "localhost:0",
                   "--forward",
                   "localhost:9",
                   "--status-s",
                   "0.01",
                   "--report",
                   report_path()},
                  path};
  const TimePoint until = monotonic_now() + kDeadline;
  while (!std::filesystem::exists(report_path()) && monotonic_now() < until) {
  }
  program.signal(SIGINT);
  EXPECT_TRUE(program.wait(kLimit));
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST_F(RelayProgramTest, HelpExplainsTheWordsOfAnImpairment) {
  Process program = start({"relay", "--help"});
  EXPECT_EQ(program.wait(kLimit), 0);
  EXPECT_THAT(program.output(), HasSubstr("loss gilbert-time"));
}

TEST_F(RelayProgramTest, ShowsItsPresets) {
  Process program = start({"presets"});
  EXPECT_EQ(program.wait(kLimit), 0);
  EXPECT_NE(program.output().find("transatlantic"), std::string::npos);
  EXPECT_NE(program.output().find("assumed"), std::string::npos);
}

TEST_F(RelayProgramTest, BadInputIsExitCode2AndASentence) {
  for (const std::vector<std::string>& wrong :
       std::vector<std::vector<std::string>>{{"--spec", "delay 5minutes"},
                                             {"--up", "loss 200%"},
                                             {"--preset", "moon"},
                                             {"--rtt-ms", "-1"},
                                             {"--loss", "1.5"},
                                             {"--loss", "101%"},
                                             {"--jitter-ms", "nan"},
                                             {"--preset", "lan", "--rtt-ms", "1"},
                                             {"--spec", "loss 1%", "--down", "none"},
                                             {"--rtt-ms", "1", "--delay-ms", "1"},
                                             {"--loss", "5%", "--up", "none"},
                                             {"--seed", "x"},
                                             {"--duration-s", "-1"},
                                             {"--control", "foo"},
                                             {"--control", "192.0.2.1:5"},
                                             {"--control", "unix:"},
                                             {"--control", "127.0.0.1:0"},
                                             {"--mode", "netem-6.1", "--preset", "leo"},
                                             {"--mode", "netem-6.1", "--rtt-ms", "50"},
                                             {"--mode", "netem-6.1", "--timeline", "day"},
                                             {"--nonsense"}}) {
    Process program = start_relay(wrong);
    EXPECT_EQ(program.wait(kLimit), 2) << wrong.front() << ' ' << wrong.back();
    EXPECT_THAT(program.output(), StartsWith("palp-netem: ")) << wrong.front();
  }
  for (const std::vector<std::string>& wrong :
       std::vector<std::vector<std::string>>{{},
                                             {"presets", "moon"},
                                             {"relay", "--listen", "localhost:0"},
                                             {"relay", "--forward", "localhost:9"}}) {
    EXPECT_EQ(start(wrong).wait(kLimit), 2) << testing::PrintToString(wrong);
  }
  Process lost = start({"relay", "--listen", "nowhere", "--forward", "localhost:9"});
  EXPECT_EQ(lost.wait(kLimit), 2);
  EXPECT_THAT(lost.output(), HasSubstr("\"nowhere\""));
  Process to_any = start({"relay", "--listen", "localhost:0", "--forward", "localhost:0"});
  EXPECT_EQ(to_any.wait(kLimit), 2);
  EXPECT_THAT(to_any.output(), HasSubstr("1 to 65535"));
}

TEST_F(RelayProgramTest, WhatCannotBeOpenedIsExitCode3) {
  Process absent = start_relay({"--timeline", "no such file"});
  EXPECT_EQ(absent.wait(kLimit), 3);
  EXPECT_THAT(absent.output(), StartsWith("palp-netem: --timeline: no file"));
  const DatagramSocket taken = DatagramSocket::bound(kAnyPort);
  Process busy =
      start({"relay", "--listen", taken.local().to_string(), "--forward", "localhost:9"});
  EXPECT_EQ(busy.wait(kLimit), 3);
  EXPECT_THAT(busy.output(), HasSubstr(taken.local().to_string()));
  EXPECT_EQ(start_relay({"--report", folder_ + "/no/folder.json"}).wait(kLimit), 3);
  EXPECT_EQ(start_relay({"--record", folder_ + "/no/folder"}).wait(kLimit), 3);
  EXPECT_EQ(start_relay({"--control", "unix:" + folder_ + "/no/folder"}).wait(kLimit), 3);
}

}  // namespace
}  // namespace palp::netem
