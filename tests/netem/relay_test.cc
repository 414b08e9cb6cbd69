#include "netem/relay.h"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "netem/relay_report.h"
#include "tests/netem/impairment_builders.h"

/// Goal: datagrams cross a real relay between real sockets as its channels decide, whatever the
/// peers do. Method: this thread is client, server and, through short calls of serve(), the relay;
/// the last tests start the program itself. Every wait has a deadline, ports come from the kernel.
namespace palp::netem {
namespace {

using std::chrono::milliseconds;

constexpr Duration kDeadline = std::chrono::seconds{10};
const Endpoint kAnyPort = *parse_endpoint("127.0.0.1:0");

std::vector<std::byte> saying(std::uint32_t number) {
  std::vector<std::byte> datagram(100);
  std::memcpy(datagram.data(), &number, sizeof number);
  return datagram;
}

struct Heard {
  std::vector<std::uint32_t> numbers;
  Endpoint from;
};

void hear(DatagramSocket& socket, Heard& heard) {
  for (auto got = socket.receive(); !got.empty(); got = socket.receive()) {
    for (const ReceivedDatagram& datagram : got) {
      std::uint32_t number = 0;
      std::memcpy(&number, datagram.bytes.data(), sizeof number);
      heard.numbers.push_back(number);
      heard.from = datagram.from;
    }
  }
}

class RelayTest : public ::testing::Test {
 protected:
  Relay relay(std::string_view up, std::string_view down = "none") {
    return Relay{{.listen = kAnyPort,
                  .forward = server_.local(),
                  .up = impaired(up),
                  .down = impaired(down),
                  .in_flight_max = 1024}};
  }
  /// Lets the relay work until `socket` has heard `count` datagrams or the deadline has passed.
  static Heard serve(Relay& relay, DatagramSocket& socket, std::size_t count) {
    Heard heard;
    const TimePoint until = monotonic_now() + kDeadline;
    while (heard.numbers.size() < count && monotonic_now() < until) {
      relay.serve(milliseconds{1});
      hear(socket, heard);
    }
    return heard;
  }
  DatagramSocket server_{DatagramSocket::bound(kAnyPort)};
};

TEST_F(RelayTest, CarriesDatagramsBothWays) {
  Relay relay = this->relay("none");
  DatagramSocket client = DatagramSocket::connected(relay.listening_on());
  for (std::uint32_t i = 0; i < 50; ++i) client.send(saying(i), std::nullopt);
  const Heard up = serve(relay, server_, 50);
  ASSERT_EQ(up.numbers.size(), 50U);
  EXPECT_TRUE(std::is_sorted(up.numbers.begin(), up.numbers.end()));
  for (std::uint32_t i = 0; i < 50; ++i) server_.send(saying(100 + i), up.from);
  const Heard down = serve(relay, client, 50);
  ASSERT_EQ(down.numbers.size(), 50U);
  EXPECT_EQ(down.numbers.front(), 100U);
  EXPECT_EQ(relay.traffic(Direction::Up).forwarded, 50U);
  EXPECT_EQ(relay.traffic(Direction::Down).forwarded, 50U);
}

TEST_F(RelayTest, HoldsEachDatagramForItsDelay) {
  Relay relay = this->relay("delay 30ms");
  DatagramSocket client = DatagramSocket::connected(relay.listening_on());
  for (std::uint32_t i = 0; i < 5; ++i) client.send(saying(i), std::nullopt);
  EXPECT_EQ(serve(relay, server_, 5).numbers.size(), 5U);
  const RelayTraffic traffic = relay.traffic(Direction::Up);
  // Sent no more than its send call's cost (20 us at most) before its time. How late is the
  // machine's affair, and reported.
  EXPECT_GE(traffic.delay.min(), milliseconds{30} - std::chrono::microseconds{20});
  EXPECT_EQ(relay.channel(Direction::Up).achieved_delay().max(), milliseconds{30});
}

TEST_F(RelayTest, LosesAndDuplicatesAsTheChannelDecides) {
  Relay relay = this->relay("loss 30% duplicate 20%");
  DatagramSocket client = DatagramSocket::connected(relay.listening_on());
  Channel twin{impaired("loss 30% duplicate 20%"), RelayConfig{}.seed, Direction::Up, 1024};
  Heard expected;
  std::array<std::byte, link::kDatagramSizeMax> buffer{};
  for (std::uint32_t i = 0; i < 200; ++i) {
    client.send(saying(i), std::nullopt);
    twin.push(saying(i), TimePoint{});
    while (const auto released = twin.pop(buffer, TimePoint{})) {
      expected.numbers.push_back(static_cast<std::uint32_t>(released->index));
    }
  }
  EXPECT_EQ(serve(relay, server_, expected.numbers.size()).numbers, expected.numbers);
  EXPECT_EQ(relay.channel(Direction::Up).counters().lost, twin.counters().lost);
}

TEST_F(RelayTest, ARestartedClientWithANewPortGetsTheReplies) {
  Relay relay = this->relay("none");
  Endpoint back;
  {
    DatagramSocket first = DatagramSocket::connected(relay.listening_on());
    first.send(saying(1), std::nullopt);
    back = serve(relay, server_, 1).from;
    EXPECT_EQ(relay.client(), first.local());
  }
  DatagramSocket second = DatagramSocket::connected(relay.listening_on());
  second.send(saying(2), std::nullopt);
  EXPECT_EQ(serve(relay, server_, 1).from, back) << "the patient sees one peer throughout";
  EXPECT_EQ(relay.client(), second.local());
  server_.send(saying(3), back);
  EXPECT_EQ(serve(relay, second, 1).numbers, std::vector<std::uint32_t>{3});
}

TEST_F(RelayTest, RepliesBeforeAnyClientAreCountedNotSent) {
  Relay relay = this->relay("none");
  server_.send(saying(2), relay.forwarding_from());
  const TimePoint until = monotonic_now() + kDeadline;
  while (relay.traffic(Direction::Down).unsent == 0 && monotonic_now() < until) {
    relay.serve(milliseconds{1});
  }
  EXPECT_EQ(relay.traffic(Direction::Down).unsent, 1U);
  EXPECT_EQ(relay.traffic(Direction::Down).forwarded, 0U);
  EXPECT_EQ(relay.traffic(Direction::Down).socket_errors, 0U);
  EXPECT_FALSE(relay.client());
}

TEST_F(RelayTest, SurvivesAServerThatVanishesAndComesBack) {
  Endpoint address;
  {
    const DatagramSocket gone = DatagramSocket::bound(kAnyPort);
    address = gone.local();
  }
  Relay relay{{.listen = kAnyPort, .forward = address, .in_flight_max = 64}};
  DatagramSocket client = DatagramSocket::connected(relay.listening_on());
  const TimePoint until = monotonic_now() + kDeadline;
  while (relay.traffic(Direction::Up).socket_errors == 0 && monotonic_now() < until) {
    client.send(saying(0), std::nullopt);
    relay.serve(milliseconds{1});
  }
  EXPECT_GT(relay.traffic(Direction::Up).socket_errors, 0U);
  DatagramSocket back = DatagramSocket::bound(address);
  client.send(saying(7), std::nullopt);
  const Heard heard = serve(relay, back, 1);
  ASSERT_FALSE(heard.numbers.empty());
  EXPECT_EQ(heard.numbers.back(), 7U);
}

TEST_F(RelayTest, StopsWhenItsDescriptorBecomesReadable) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  Relay relay{{.listen = kAnyPort,
               .forward = server_.local(),
               .in_flight_max = 64,
               .stop_descriptor = ends[0]}};
  EXPECT_TRUE(relay.serve(milliseconds{1}));
  ASSERT_EQ(::write(ends[1], "x", 1), 1);
  EXPECT_FALSE(relay.serve(kDeadline));
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST_F(RelayTest, AnAddressInUseIsAnException) {
  EXPECT_THROW(DatagramSocket::bound(server_.local()), std::system_error);
}

TEST(DatagramSocketTest, AnEarlierRefusalDoesNotCostTheDatagramAtHand) {
  Endpoint address;
  {
    const DatagramSocket gone = DatagramSocket::bound(kAnyPort);
    address = gone.local();
  }
  DatagramSocket socket = DatagramSocket::connected(address);
  EXPECT_TRUE(socket.send(saying(1), std::nullopt));
  // On loopback the refusal is there before the call returns; the next call hears of it.
  EXPECT_TRUE(socket.send(saying(2), std::nullopt));
  EXPECT_EQ(socket.errors(), 1U);
}

TEST(EndpointTest, ReadsAddressesAndRefusesTheRest) {
  EXPECT_EQ(to_string(*parse_endpoint("10.1.2.3:65535")), "10.1.2.3:65535");
  EXPECT_EQ(to_string(*parse_endpoint("localhost:0")), "127.0.0.1:0");
  for (const char* text : {"",
                           "127.0.0.1",
                           "127.0.0.1:",
                           "127.0.0.1:65536",
                           "127.0.0.1:-1",
                           "127.0.0.1:80x",
                           "host:80",
                           ":80",
                           "1.2.3:80",
                           "256.0.0.1:80"}) {
    EXPECT_FALSE(parse_endpoint(text)) << text;
  }
}

/// The program itself, ended at the latest by the destructor.
class Program {
 public:
  Program(std::vector<std::string> arguments, const std::filesystem::path& folder)
      : output_{folder / "stdout"}, error_{folder / "stderr"} {
    arguments.insert(arguments.begin(), PALP_NETEM_PROGRAM);
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    constexpr int kFlags = O_CREAT | O_TRUNC | O_WRONLY;
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output_.c_str(), kFlags, 0600);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, error_.c_str(), kFlags, 0600);
    ::posix_spawn(&pid_, pointers[0], &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
  }

  void signal(int number) const { ::kill(pid_, number); }

  /// The exit code; -1: it did not end by itself before the deadline.
  int wait() {
    const TimePoint until = monotonic_now() + kDeadline;
    while (monotonic_now() < until) {
      int status = 0;
      if (::waitpid(pid_, &status, WNOHANG) == pid_) {
        pid_ = 0;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
      }
      ::usleep(1000);
    }
    return -1;
  }

  /// The address it says it listens on; nullopt: it has not said so before the deadline.
  [[nodiscard]] std::optional<Endpoint> listening_on() const {
    const TimePoint until = monotonic_now() + kDeadline;
    while (monotonic_now() < until) {
      const std::string text = read(output_);
      constexpr std::string_view kBegin = "listening on ";
      const std::size_t end = text.find('\n');
      if (text.starts_with(kBegin) && end != std::string::npos) {
        const auto endpoint =
            parse_endpoint(std::string_view{text}.substr(kBegin.size(), end - kBegin.size()));
        if (endpoint) return *endpoint;
      }
      ::usleep(1000);
    }
    return std::nullopt;
  }

  [[nodiscard]] std::string output() const { return read(output_); }
  [[nodiscard]] std::string errors() const { return read(error_); }

 private:
  static std::string read(const std::filesystem::path& path) {
    std::ifstream file{path};
    return {std::istreambuf_iterator<char>{file}, {}};
  }
  std::filesystem::path output_;
  std::filesystem::path error_;
  pid_t pid_{};
};

class RelayProgramTest : public ::testing::Test {
 protected:
  RelayProgramTest() {
    std::string name = (std::filesystem::temp_directory_path() / "palp-netem-XXXXXX").string();
    if (::mkdtemp(name.data()) != nullptr) folder_ = name;
  }
  ~RelayProgramTest() override { std::filesystem::remove_all(folder_); }
  [[nodiscard]] std::string report_path() const { return folder_ / "report.json"; }
  std::filesystem::path folder_;
};

TEST_F(RelayProgramTest, ForwardsUntilASignalAndWritesItsReport) {
  for (const int number : {SIGINT, SIGTERM}) {
    DatagramSocket server = DatagramSocket::bound(kAnyPort);
    Program program{{"relay",
                     "--listen",
                     "localhost:0",
                     "--forward",
                     to_string(server.local()),
                     "--up",
                     "delay 2ms",
                     "--down",
                     "loss 100%",
                     "--seed",
                     "5",
                     "--report",
                     report_path()},
                    folder_};
    const auto address = program.listening_on();
    ASSERT_TRUE(address) << program.errors();
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
    EXPECT_EQ(program.wait(), 0) << program.errors();

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
    for (const char* key :
         {"duplicated", "reordered", "delay_p99_ms", "late_releases", "socket_errors"}) {
      EXPECT_TRUE(report["up"].contains(key)) << key;
    }
  }
}

TEST_F(RelayProgramTest, EndsAfterItsDuration) {
  Program program{{"relay",
                   "--listen",
                   "localhost:0",
                   "--forward",
                   "localhost:9",
                   "--preset",
                   "lan",
                   "--duration-s",
                   "0.01",
                   "--report",
                   report_path()},
                  folder_};
  EXPECT_EQ(program.wait(), 0) << program.errors();
  EXPECT_EQ(nlohmann::json::parse(std::ifstream{report_path()})["preset"], "lan");
}

TEST_F(RelayProgramTest, ShowsItsPresets) {
  Program program{{"presets"}, folder_};
  EXPECT_EQ(program.wait(), 0);
  EXPECT_NE(program.output().find("transatlantic"), std::string::npos);
  EXPECT_NE(program.output().find("assumed"), std::string::npos);
}

TEST_F(RelayProgramTest, BadInputIsExitCode2AndASentence) {
  const std::vector<std::string> begin{
      "relay", "--listen", "localhost:0", "--forward", "localhost:9"};
  for (const std::vector<std::string>& wrong :
       std::vector<std::vector<std::string>>{{"--spec", "delay 5"},
                                             {"--up", "loss 200%"},
                                             {"--preset", "moon"},
                                             {"--rtt-ms", "-1"},
                                             {"--loss", "1.5"},
                                             {"--loss", "101%"},
                                             {"--jitter-ms", "nan"},
                                             {"--preset", "lan", "--rtt-ms", "1"},
                                             {"--seed", "x"},
                                             {"--duration-s", "-1"},
                                             {"--nonsense"}}) {
    std::vector<std::string> arguments = begin;
    arguments.insert(arguments.end(), wrong.begin(), wrong.end());
    Program program{arguments, folder_};
    EXPECT_EQ(program.wait(), 2) << wrong.front() << ' ' << wrong.back();
    EXPECT_FALSE(program.errors().empty()) << wrong.front();
  }
  Program program{{"relay", "--listen", "nowhere", "--forward", "localhost:9"}, folder_};
  EXPECT_EQ(program.wait(), 2);
  EXPECT_NE(program.errors().find("'nowhere'"), std::string::npos);
}

TEST_F(RelayProgramTest, WhatCannotBeOpenedIsExitCode3) {
  const DatagramSocket taken = DatagramSocket::bound(kAnyPort);
  Program busy{{"relay", "--listen", to_string(taken.local()), "--forward", "localhost:9"},
               folder_};
  EXPECT_EQ(busy.wait(), 3);
  EXPECT_NE(busy.errors().find(to_string(taken.local())), std::string::npos);
  Program unwritable{{"relay",
                      "--listen",
                      "localhost:0",
                      "--forward",
                      "localhost:9",
                      "--report",
                      folder_ / "no" / "folder.json"},
                     folder_};
  EXPECT_EQ(unwritable.wait(), 3);
}

}  // namespace
}  // namespace palp::netem
