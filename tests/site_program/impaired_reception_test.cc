#include "site_program/impaired_reception.h"

#include <array>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::site_program {
namespace {

using testing::HasSubstr;

/// Gives one datagram of one byte at every tick.
class Source final : public link::Transport {
 public:
  bool send(std::span<const std::byte>, TimePoint) noexcept override { return true; }
  std::optional<link::Datagram> receive(std::span<std::byte, link::kDatagramSizeMax> buffer,
                                        TimePoint now) noexcept override {
    if (now == given_at_) return std::nullopt;
    given_at_ = now;
    buffer[0] = std::byte{7};
    return link::Datagram{.size = 1, .arrived_at = now};
  }

 private:
  TimePoint given_at_{TimePoint::min()};
};

/// How many datagrams pass in so many ticks of 1 ms.
int passed(const io::TransportWrap& wrap, int ticks) {
  const auto transport = wrap(std::make_unique<Source>());
  std::array<std::byte, link::kDatagramSizeMax> buffer{};
  int count = 0;
  for (int tick = 0; tick < ticks; ++tick) {
    const TimePoint now{std::chrono::milliseconds{tick}};
    while (transport->receive(buffer, now)) ++count;
  }
  return count;
}

TEST(ImpairedReceptionTest, NothingAskedForIsNothingBetween) {
  const auto wrap = impaired_reception({}, netem::Direction::Up, 1, {});
  ASSERT_TRUE(wrap);
  EXPECT_FALSE(*wrap);
}

TEST(ImpairedReceptionTest, NumbersAndWordsImpair) {
  const auto delayed =
      impaired_reception({.delay = std::chrono::milliseconds{10}}, netem::Direction::Up, 1, {});
  EXPECT_EQ(passed(delayed.value(), 100), 90);
  const auto lossy = impaired_reception({.loss = 1}, netem::Direction::Up, 1, {});
  EXPECT_EQ(passed(lossy.value(), 100), 0);
  const auto spoken = impaired_reception({.spec = "delay 20ms"}, netem::Direction::Up, 1, {});
  EXPECT_EQ(passed(spoken.value(), 100), 80);
}

TEST(ImpairedReceptionTest, TheSeedAndTheDirectionDecide) {
  const auto count = [](netem::Direction direction, std::uint64_t seed) {
    return passed(impaired_reception({.loss = 0.5}, direction, seed, {}).value(), 1000);
  };
  EXPECT_EQ(count(netem::Direction::Up, 1), count(netem::Direction::Up, 1));
  EXPECT_NE(count(netem::Direction::Up, 1), count(netem::Direction::Up, 2));
  EXPECT_NE(count(netem::Direction::Up, 1), count(netem::Direction::Down, 1));
}

TEST(ImpairedReceptionTest, WordsThatNobodyKnowsAreASentence) {
  const auto wrap = impaired_reception({.spec = "delay much"}, netem::Direction::Up, 1, {});
  ASSERT_FALSE(wrap);
  EXPECT_THAT(wrap.error().text, HasSubstr("--impair"));
}

}  // namespace
}  // namespace palp::site_program
