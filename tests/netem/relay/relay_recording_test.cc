#include "netem/relay/relay_recording.h"

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "netem/model/impaired_transport.h"
#include "netem/model/pipe.h"
#include "netem/relay/pcapng.h"
#include "netem/relay/relay.h"
#include "netem/syntax/data_files.h"
#include "tests/netem/model/datagrams.h"
#include "tests/netem/model/impairment_builders.h"
#include "tests/support/own_path.h"

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
    std::string folder = test::own_path("recording");
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
  EXPECT_TRUE(writer.open(prefix));
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
  const auto closed = writer.close();
  EXPECT_TRUE(closed);
  EXPECT_EQ(closed->missed + closed->open, 0U);
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
    if (row.copy == 0) order.decided(push(at));
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
  ImpairedPath impaired_path{
      {.impairment = impairment}, 1, Direction::Up, 65'536, 1024, TimePoint{}};
  EXPECT_EQ(decided_again(csv,
                          [&](TimePoint at) {
                            while (impaired_path.pop(at)) {
                            }
                            return impaired_path.push(
                                {.at = at, .length = datagram.size(), .room = 65'536});
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

/// A relay that this thread serves, and its recording.
struct Recorded {
  explicit Recorded(std::string_view words)
      : relay{{.listen = kAnyPort,
               .forward = server.local(),
               .up = {.impairment = impaired(words)},
               .in_flight_max = 1024}},
        client{DatagramSocket::connected(relay.listening_on())},
        writer{relay.recording, relay.start(), wall_now()} {}
  /// Sends and waits until the relay has taken all of it in.
  void send(std::uint32_t count) {
    sent += count;
    for (std::uint32_t i = 0; i < count; ++i) client.send(saying(i), std::nullopt);
    serve_until([&] { return relay.channel(Direction::Up).counters().pushed >= sent; });
  }
  template <class Done>
  void serve_until(Done&& done) {
    const TimePoint until = monotonic_now() + kDeadline;
    while (!done() && monotonic_now() < until) relay.serve(std::chrono::microseconds{200});
    EXPECT_TRUE(done());
  }
  void serve_out() {
    serve_until([&] { return relay.channel(Direction::Up).in_flight() == 0; });
  }
  void change(const Change& change) {
    EXPECT_TRUE(relay.commands.try_enqueue({prepare(change), Direction::Up, monotonic_now(), {}}));
    const auto applied = relay.channel(Direction::Up).impaired_path().changes_applied();
    serve_until(
        [&] { return relay.channel(Direction::Up).impaired_path().changes_applied() > applied; });
  }
  DatagramSocket server = DatagramSocket::bound(kAnyPort);
  Relay relay;
  DatagramSocket client;
  RecordingWriter writer;
  std::uint64_t sent{};
};

/// The numbers of the datagrams, as they stand in the file.
std::vector<std::uint64_t> numbers(const std::string& csv) {
  std::vector<std::uint64_t> all;
  const Recording recording = *parse_recording("log", csv);
  for (const Recording::Row& row : recording.rows) all.push_back(row.index);
  return all;
}

std::vector<std::uint64_t> from_0_to(std::uint64_t end) {
  std::vector<std::uint64_t> all;
  for (std::uint64_t i = 0; i < end; ++i) all.push_back(i);
  return all;
}

TEST_F(RelayRecordingTest, LosesNothingWhenSlotsAreSwitchedOff) {
  Recorded run{"mode netem-6.1 delay 2ms slot 20ms"};
  ASSERT_TRUE(run.writer.open(folder_ + "/run"));
  run.send(20);
  run.change({.impairment = impaired("mode netem-6.1 delay 2ms")});
  run.send(20);
  run.serve_out();
  const auto gaps = run.writer.close();
  ASSERT_TRUE(gaps);
  EXPECT_EQ(gaps->open, 0U);
  EXPECT_EQ(numbers(read_all(folder_ + "/run-up.csv")), from_0_to(40));
}

TEST_F(RelayRecordingTest, WhatIsOnItsWayAtTheEndIsWrittenAndCounted) {
  Recorded run{"mode netem-6.1 delay 2ms slot 1000s"};
  ASSERT_TRUE(run.writer.open(folder_ + "/run"));
  run.send(20);
  const auto gaps = run.writer.close();
  ASSERT_TRUE(gaps);
  EXPECT_EQ(numbers(read_all(folder_ + "/run-up.csv")), from_0_to(20));
  EXPECT_EQ(gaps->open, run.relay.channel(Direction::Up).in_flight());
  EXPECT_GT(gaps->open, 0U);
}

TEST(RecordingWriterTest, AReleaseThatWasMissedStopsNothingForGood) {
  const std::string prefix = test::own_path("missed");
  RecordingQueue queue;
  RecordingWriter writer{queue, TimePoint{}, {}};
  ASSERT_TRUE(writer.open(prefix));
  constexpr std::uint64_t kCount = 300'000;  // more than may wait
  for (std::uint64_t i = 0; i < kCount; ++i) {
    // The first one's release never comes.
    const std::array decided{Decision{.index = i, .open = i == 0}};
    queue.decided(decided, Direction::Up);
    if (i % 1000 == 0) writer.drain();
  }
  writer.drain();
  EXPECT_GT(std::filesystem::file_size(prefix + "-up.csv"), kCount) << "written before the end";
  const auto gaps = writer.close();
  ASSERT_TRUE(gaps);
  EXPECT_EQ(gaps->open, 1U);
  EXPECT_EQ(gaps->missed, 0U);
  EXPECT_EQ(numbers(read_all(prefix + "-up.csv")).size(), kCount);
  for (const char* end : {"-up.csv", "-down.csv", ".pcapng"}) std::filesystem::remove(prefix + end);
}

TEST_F(RelayRecordingTest, BegunLiveItIsReplayedFromItsFirstDatagram) {
  Recorded run{kWords};
  run.send(50);
  run.serve_out();
  ASSERT_TRUE(run.writer.open(folder_ + "/first"));
  run.send(100);
  run.serve_out();
  ASSERT_TRUE(run.writer.close());
  const std::string first = read_all(folder_ + "/first-up.csv");
  EXPECT_EQ(numbers(first).front(), 0U);
  EXPECT_EQ(numbers(first).back(), 99U);
  Impairment replay;
  replay.replay = *parse_recording("first", first);
  const std::string second = recorded_run(folder_ + "/second", replay, 100);
  const Recording again = *parse_recording("second", second);
  EXPECT_EQ(replay.replay.rows, again.rows);
}

/// Source and destination port of each datagram of a capture that was sent towards `to`.
std::vector<std::uint16_t> sources_towards(const std::string& capture, std::uint16_t to) {
  std::vector<std::uint16_t> all;
  const auto number = [&](std::size_t at) {
    return static_cast<std::uint16_t>(static_cast<unsigned char>(capture[at]) << 8U |
                                      static_cast<unsigned char>(capture[at + 1]));
  };
  std::uint32_t length = 0;
  for (std::size_t at = 0; at + 12 <= capture.size(); at += length) {
    std::uint32_t type = 0;
    std::memcpy(&type, capture.data() + at, 4);
    std::memcpy(&length, capture.data() + at + 4, 4);
    constexpr std::size_t kUdp = 28 + 20;  // the block's head, the IP header
    if (type == 6 && number(at + kUdp + 2) == to) all.push_back(number(at + kUdp));
  }
  return all;
}

TEST_F(RelayRecordingTest, TheCaptureHasThePortsAsTheyWereThen) {
  Recorded run{"none"};
  ASSERT_TRUE(run.writer.open(folder_ + "/run"));
  run.send(1);
  run.serve_out();
  const std::uint16_t before = run.relay.forwarding_from().port();
  run.change({.kind = Change::Kind::Rebind});
  const std::uint16_t after = run.relay.forwarding_from().port();
  const std::uint16_t first = run.client.local().port();
  run.client = DatagramSocket::connected(run.relay.listening_on());
  run.send(1);
  run.serve_out();
  ASSERT_TRUE(run.writer.close());
  const std::string capture = read_all(folder_ + "/run.pcapng");
  EXPECT_EQ(sources_towards(capture, run.server.local().port()), (std::vector{before, after}));
  EXPECT_EQ(sources_towards(capture, run.relay.listening_on().port()),
            (std::vector{first, run.client.local().port()}));
}

}  // namespace
}  // namespace palp::netem
