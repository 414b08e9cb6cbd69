#include "netem/model/pipe.h"

#include <array>
#include <deque>
#include <vector>

#include <gtest/gtest.h>

#include "netem/model/impaired_transport.h"
#include "tests/netem/model/impairment_builders.h"

namespace palp::netem {
namespace {

using std::chrono::milliseconds;

using Buffer = std::array<std::byte, link::kDatagramSizeMax>;

TimePoint at_ms(std::int64_t milliseconds_since_start) {
  return TimePoint{milliseconds{milliseconds_since_start}};
}

std::vector<std::byte> saying(int value) { return {std::byte{1}, static_cast<std::byte>(value)}; }

TEST(PipeTest, CarriesEachEndsDatagramsToTheOther) {
  Pipe pipe{impaired("none"), impaired("none"), 1, 16};
  const auto surgeon = pipe.surgeon_end();
  const auto patient = pipe.patient_end();
  Buffer buffer{};
  EXPECT_TRUE(surgeon->send(saying(11), at_ms(1)));
  EXPECT_TRUE(patient->send(saying(22), at_ms(1)));
  ASSERT_TRUE(patient->receive(buffer, at_ms(1)));
  EXPECT_EQ(buffer[1], std::byte{11});
  ASSERT_TRUE(surgeon->receive(buffer, at_ms(1)));
  EXPECT_EQ(buffer[1], std::byte{22});
  EXPECT_FALSE(surgeon->receive(buffer, at_ms(1)));
  EXPECT_FALSE(patient->receive(buffer, at_ms(1)));
}

TEST(PipeTest, StampsArrivalWithTheReleaseHoweverLateItIsRead) {
  Pipe pipe{impaired("delay 7ms"), impaired("delay 3ms"), 1, 16};
  const auto surgeon = pipe.surgeon_end();
  const auto patient = pipe.patient_end();
  Buffer buffer{};
  surgeon->send(saying(1), at_ms(0));
  EXPECT_FALSE(patient->receive(buffer, at_ms(6)));
  const auto up = patient->receive(buffer, at_ms(20));
  ASSERT_TRUE(up);
  EXPECT_EQ(up->arrived_at, at_ms(7));
  EXPECT_EQ(up->size, 2U);
  patient->send(saying(2), at_ms(20));
  const auto down = surgeon->receive(buffer, at_ms(30));
  ASSERT_TRUE(down);
  EXPECT_EQ(down->arrived_at, at_ms(23));
}

TEST(PipeTest, LosesSilentlyAndCountsByDirection) {
  Pipe pipe{impaired("loss 100%"), impaired("none"), 1, 16};
  const auto surgeon = pipe.surgeon_end();
  Buffer buffer{};
  EXPECT_TRUE(surgeon->send(saying(1), at_ms(0)));
  EXPECT_FALSE(pipe.patient_end()->receive(buffer, at_ms(9)));
  EXPECT_EQ(pipe.channel(Direction::Up).counters().lost, 1U);
  EXPECT_EQ(pipe.channel(Direction::Down).counters().pushed, 0U);
}

/// A transport that hands over what a test put into it, stamped with its own arrival time.
class ScriptedTransport final : public link::Transport {
 public:
  struct Waiting {
    TimePoint at;
    std::vector<std::byte> bytes;
  };
  explicit ScriptedTransport(std::deque<Waiting>& waiting,
                             std::vector<std::vector<std::byte>>& sent)
      : waiting_{waiting}, sent_{sent} {}

  bool send(std::span<const std::byte> datagram, TimePoint /*now*/) noexcept override {
    sent_.emplace_back(datagram.begin(), datagram.end());
    return accepts;
  }
  std::optional<link::Datagram> receive(std::span<std::byte, link::kDatagramSizeMax> buffer,
                                        TimePoint now) noexcept override {
    if (waiting_.empty() || waiting_.front().at > now) return std::nullopt;
    const Waiting next = waiting_.front();
    waiting_.pop_front();
    std::copy_n(next.bytes.begin(), std::min(next.bytes.size(), buffer.size()), buffer.begin());
    return link::Datagram{next.bytes.size(), next.at};
  }
  bool accepts{true};

 private:
  std::deque<Waiting>& waiting_;
  std::vector<std::vector<std::byte>>& sent_;
};

class ImpairedTransportTest : public ::testing::Test {
 protected:
  ImpairedTransport impaired_by(std::string_view words) {
    return ImpairedTransport{std::make_unique<ScriptedTransport>(waiting_, sent_),
                             Channel{impaired(words), 1, Direction::Up, 1024}};
  }
  std::deque<ScriptedTransport::Waiting> waiting_;
  std::vector<std::vector<std::byte>> sent_;
  Buffer buffer_{};
};

TEST_F(ImpairedTransportTest, DelaysWhatArrivesFromTheStampOfItsArrival) {
  ImpairedTransport transport = impaired_by("delay 5ms");
  waiting_.push_back({at_ms(2), saying(9)});
  EXPECT_FALSE(transport.receive(buffer_, at_ms(4)));
  EXPECT_FALSE(transport.receive(buffer_, at_ms(6)));
  const auto datagram = transport.receive(buffer_, at_ms(7));
  ASSERT_TRUE(datagram);
  EXPECT_EQ(datagram->arrived_at, at_ms(7));
  EXPECT_EQ(datagram->size, 2U);
  EXPECT_EQ(buffer_[1], std::byte{9});
}

TEST_F(ImpairedTransportTest, LeavesSendingAlone) {
  auto inner = std::make_unique<ScriptedTransport>(waiting_, sent_);
  ScriptedTransport& script = *inner;
  ImpairedTransport transport{std::move(inner),
                              Channel{impaired("loss 100%"), 1, Direction::Up, 16}};
  EXPECT_TRUE(transport.send(saying(3), at_ms(0)));
  script.accepts = false;
  EXPECT_FALSE(transport.send(saying(4), at_ms(0)));
  EXPECT_EQ(sent_, (std::vector{saying(3), saying(4)}));
}

TEST_F(ImpairedTransportTest, TakesABoundedNumberPerTick) {
  ImpairedTransport transport = impaired_by("none");
  constexpr std::size_t kFlood = 2 * link::kDatagramsPerTickMax;
  for (std::size_t i = 0; i < kFlood; ++i) waiting_.push_back({at_ms(1), saying(0)});
  const auto read_all = [&](TimePoint now) {
    std::size_t count = 0;
    while (transport.receive(buffer_, now)) ++count;
    return count;
  };
  EXPECT_EQ(read_all(at_ms(1)), link::kDatagramsPerTickMax);
  EXPECT_EQ(waiting_.size(), kFlood - link::kDatagramsPerTickMax);
  EXPECT_EQ(read_all(at_ms(2)), link::kDatagramsPerTickMax);
  EXPECT_TRUE(waiting_.empty());
}

TEST_F(ImpairedTransportTest, DropsAndCountsWhatWasCutOff) {
  ImpairedTransport transport = impaired_by("none");
  waiting_.push_back({at_ms(1), std::vector<std::byte>(1201)});
  waiting_.push_back({at_ms(1), std::vector<std::byte>(1200)});
  const auto datagram = transport.receive(buffer_, at_ms(1));
  ASSERT_TRUE(datagram);
  EXPECT_EQ(datagram->size, 1200U);
  EXPECT_EQ(transport.cut_off(), 1U);
}

TEST(PipeTest, BlackoutsCountFromTheStart) {
  const Impairment path = parse_impairment("blackout 1s 1s").value();
  const TimePoint start{std::chrono::seconds{5}};
  Pipe pipe{path, path, 1, 16, start};
  const auto surgeon = pipe.surgeon_end();
  const auto patient = pipe.patient_end();
  const std::array<std::byte, 4> bytes{};
  std::array<std::byte, link::kDatagramSizeMax> buffer{};
  for (const auto& [after, arrives] : {std::pair{std::chrono::milliseconds{999}, true},
                                       std::pair{std::chrono::milliseconds{1001}, false},
                                       std::pair{std::chrono::milliseconds{2001}, true}}) {
    surgeon->send(bytes, start + after);
    EXPECT_EQ(patient->receive(buffer, start + after).has_value(), arrives) << after.count();
  }
}

}  // namespace
}  // namespace palp::netem
