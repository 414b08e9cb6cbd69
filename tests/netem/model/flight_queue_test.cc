#include "netem/model/flight_queue.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "common/core/random.h"

namespace palp::netem {
namespace {

TimePoint at(std::int64_t ns) { return TimePoint{Duration{ns}}; }

void enter(FlightQueue& queue, std::int64_t release_ns, std::uint32_t place) {
  queue.push(queue.number(at(release_ns), place));
}

/// Goal: whoever overtakes whom, they leave by release, and of the same release as they came.
/// Method: a stable sort of the same.
TEST(FlightQueueTest, LeavesByReleaseThenAsTheyCame) {
  FlightQueue queue{500};
  std::vector<InFlight> expected;
  for (std::uint32_t place = 0; place < 500; ++place) {
    const auto release = static_cast<std::int64_t>(random_bits(3, 4, place) % 50 + place / 10);
    enter(queue, release, place);
    expected.push_back({release, place, place});
  }
  std::ranges::stable_sort(expected, {}, &InFlight::release_ns);
  EXPECT_LT(queue.in_line(), 100U) << "most overtake";
  for (const InFlight& next : expected) {
    ASSERT_NE(queue.first(), nullptr);
    ASSERT_EQ(queue.first()->place, next.place);
    ASSERT_EQ(queue.take_first().place, next.place);
  }
  EXPECT_EQ(queue.first(), nullptr);
  EXPECT_EQ(queue.size(), 0U);
}

TEST(FlightQueueTest, TheLineIsOfThoseWhoOvertakeNobody) {
  FlightQueue queue{4};
  enter(queue, 10, 0);
  enter(queue, 30, 1);
  enter(queue, 20, 2);
  enter(queue, 30, 3);
  EXPECT_EQ(queue.size(), 4U);
  ASSERT_EQ(queue.in_line(), 3U);
  EXPECT_EQ(queue.in_line(1).place, 1U);
  EXPECT_EQ(queue.in_line(2).place, 3U);
}

}  // namespace
}  // namespace palp::netem
