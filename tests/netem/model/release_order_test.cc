#include "netem/model/release_order.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "common/core/random.h"

namespace palp::netem {
namespace {

constexpr TimePoint at(std::int64_t ns) { return TimePoint{Duration{ns}}; }

ReleaseOrder order(Order asked, std::uint32_t depth = 0) {
  Impairment law;
  law.order = asked;
  law.swap_depth = depth;
  ReleaseOrder order;
  order.change(law);
  return order;
}

TEST(ReleaseOrderTest, KeptNobodyLeavesBeforeWhoCameEarlierNorLaterThanNeeded) {
  ReleaseOrder kept = order(Order::Keep);
  TimePoint latest{};
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const TimePoint due = at(static_cast<std::int64_t>(1e6 * random_uniform(1, 2, i)));
    latest = std::max(latest, due);
    EXPECT_EQ(kept.fit(due, at(0), false), latest);
  }
}

TEST(ReleaseOrderTest, NetemLeavesWhenDue) {
  ReleaseOrder free = order(Order::Netem);
  EXPECT_EQ(free.fit(at(9), at(0), false), at(9));
  EXPECT_EQ(free.fit(at(4), at(0), false), at(4));
}

TEST(ReleaseOrderTest, WhoSwapsLeavesJustBeforeThoseItOvertakes) {
  ReleaseOrder swapped = order(Order::Swap, 2);
  EXPECT_EQ(swapped.fit(at(10), at(0), true), at(10)) << "nobody to overtake";
  EXPECT_EQ(swapped.fit(at(20), at(1), false), at(20));
  EXPECT_EQ(swapped.fit(at(15), at(2), false), at(20));
  EXPECT_EQ(swapped.fit(at(30), at(3), true), at(19)) << "two back";
  EXPECT_EQ(swapped.fit(at(25), at(4), false), at(25)) << "who swapped does not count";
  EXPECT_EQ(swapped.fit(at(40), at(24), true), at(40)) << "two back has left already";
}

TEST(ReleaseOrderTest, AnotherOrderGoesOnBehindTheLastOne) {
  ReleaseOrder changed = order(Order::Keep);
  EXPECT_EQ(changed.fit(at(50), at(0), false), at(50));
  Impairment law;
  law.order = Order::Swap;
  changed.change(law);
  EXPECT_EQ(changed.fit(at(10), at(1), false), at(50));
}

}  // namespace
}  // namespace palp::netem
