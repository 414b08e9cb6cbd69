#include "netem/relay_recording.h"

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "netem/data_files.h"
#include "netem/impaired_transport.h"
#include "netem/pcapng.h"
#include "netem/pipe.h"
#include "netem/relay.h"
#include "tests/netem/datagrams.h"
#include "tests/netem/impairment_builders.h"

/// Goal: the three hosts decide alike, and what the relay records can be replayed. Method: a real
/// relay between sockets of the test is recorded; its arrival log is given to the others.
namespace palp::netem {
namespace {

using std::chrono::milliseconds;

constexpr const char* kWords =
    "delay 2ms 1ms 50% distribution normal loss 5% loss gemodel 2% 20% duplicate 10% corrupt 5% "
    "reorder 5% order netem";

std::string read_all(const std::string& path) {
  std::ifstream file{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{file}, {}};
}

/// The first six columns.
std::string without_length(const std::string& csv) {
  std::string text;
  std::size_t begin = 0;
  while (begin < csv.size()) {
    const std::size_t end = csv.find('\n', begin);
    const std::string line = csv.substr(begin, end - begin);
    text += line.substr(0, line.rfind(',')) + '\n';
    begin = end + 1;
  }
  return text;
}

class RelayRecordingTest : public ::testing::Test {
 protected:
  ~RelayRecordingTest() override { std::filesystem::remove_all(folder_); }
  const std::string folder_ = [] {
    std::string folder = ::testing::TempDir() + "palp-recording-" + std::to_string(::getpid());
    std::filesystem::create_directories(folder);
    return folder;
  }();
};

/// Sends `count` datagrams through a recorded relay. @returns what was recorded upwards.
std::string recorded_run(const std::string& prefix,
                         const Impairment& impairment,
                         std::uint32_t count) {
  DatagramSocket server = DatagramSocket::bound(kAnyPort);
  Relay relay{{.listen = kAnyPort, .forward = server.local(), .up = {.impairment = impairment}}};
  RecordingWriter writer{relay.recording, relay.start(), wall_now()};
  EXPECT_TRUE(writer.open(prefix,
                          {.client_side = relay.listening_on(),
                           .server_side = relay.forwarding_from(),
                           .server = server.local()}));
  DatagramSocket client = DatagramSocket::connected(relay.listening_on());
  Heard heard;
  for (std::uint32_t i = 0; i < count; ++i) {
    client.send(saying(i), std::nullopt);
    relay.serve(std::chrono::microseconds{100});
    hear(server, heard);
  }
  const TimePoint until = monotonic_now() + kDeadline;
  while (relay.channel(Direction::Up).in_flight() > 0 && monotonic_now() < until) {
    relay.serve(milliseconds{1});
  }
  writer.drain(client.local());
  EXPECT_TRUE(writer.close());
  return read_all(prefix + "-up.csv");
}

/// The same arrivals through a channel of another host.
template <class Push>
std::string decided_again(const std::string& csv, Push&& push) {
  std::string text = std::string{kRecordingHeader} + "\n";
  DecisionOrder order{[&](const Decision& decision) {
    append_recording_line(text, decision, TimePoint{});
    text += '\n';
  }};
  const Recording recording = *parse_recording("log", csv);
  std::size_t begin = csv.find('\n') + 1;
  for (const Recording::Row& row : recording.rows) {
    const std::size_t comma = csv.find(',', begin);
    const TimePoint at{Duration{std::stoll(csv.substr(comma + 1))}};
    begin = csv.find('\n', begin) + 1;
    if (row.copy == 0) order.decided(push(at), true);
  }
  return text;
}

TEST_F(RelayRecordingTest, TheThreeHostsDecideAlike) {
  const Impairment impairment = impaired(kWords);
  const std::string csv = recorded_run(folder_ + "/run", impairment, 2000);
  const std::string relay = without_length(csv);
  EXPECT_GT(relay.size(), 20'000U);
  const auto datagram = saying(1);

  // Virtual time, without bytes.
  Passage passage{{.impairment = impairment}, 1, Direction::Up, 65'536, 1024, TimePoint{}};
  EXPECT_EQ(
      decided_again(csv,
                    [&](TimePoint at) {
                      while (passage.pop(at)) {
                      }
                      return passage.push({.at = at, .length = datagram.size(), .room = 65'536});
                    }),
      relay);
  // In process: the channel that a site's transport and a pipe hold.
  Channel channel{impairment, 1, Direction::Up, 65'536};
  std::array<std::byte, link::kDatagramSizeMax> buffer{};
  EXPECT_EQ(decided_again(csv,
                          [&](TimePoint at) {
                            while (channel.pop(buffer, at)) {
                            }
                            return channel.push(datagram, at);
                          }),
            relay);
}

TEST_F(RelayRecordingTest, ARecordingReplayedIsRecordedTheSame) {
  const std::string first = recorded_run(folder_ + "/first", impaired(kWords), 500);
  Impairment replay;
  replay.replay = *parse_recording("first", first);
  replay.order = Order::Netem;
  const std::string second = recorded_run(folder_ + "/second", replay, 500);
  // The arrivals are another run's; what becomes of each datagram is the same.
  const Recording one = *parse_recording("first", first);
  const Recording other = *parse_recording("second", second);
  EXPECT_EQ(one.rows, other.rows);
}

TEST_F(RelayRecordingTest, TheCaptureHasEveryDatagramOfBothSides) {
  (void)recorded_run(folder_ + "/run", impaired("none"), 50);
  const std::string capture = read_all(folder_ + "/run.pcapng");
  std::vector<std::uint32_t> blocks;
  for (std::size_t at = 0; at + 12 <= capture.size();) {
    std::uint32_t type = 0;
    std::uint32_t length = 0;
    std::uint32_t again = 0;
    std::memcpy(&type, capture.data() + at, 4);
    std::memcpy(&length, capture.data() + at + 4, 4);
    ASSERT_EQ(length % 4, 0U);
    ASSERT_LE(at + length, capture.size());
    std::memcpy(&again, capture.data() + at + length - 4, 4);
    ASSERT_EQ(length, again);
    blocks.push_back(type);
    at += length;
  }
  ASSERT_EQ(blocks.size(), 3U + 100U);
  EXPECT_EQ(blocks[0], 0x0a0d0d0aU);
  EXPECT_EQ(blocks[1], 1U);
  EXPECT_EQ(blocks[3], 6U);
}

}  // namespace
}  // namespace palp::netem
