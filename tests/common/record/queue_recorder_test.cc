#include "common/record/queue_recorder.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/common/record/record_samples.h"

namespace palp::record {
namespace {

TEST(QueueRecorderTest, GivesRecordsBackInOrder) {
  QueueRecorder queue{16};
  for (int k = 0; k < 10; ++k) {
    ASSERT_TRUE(queue.record(test::tick(k)));
  }
  std::vector<TimePoint> seen;
  EXPECT_EQ(queue.drain([&](const Record& r) { seen.push_back(std::get<SiteTick>(r).at); }), 10u);
  for (int k = 0; k < 10; ++k) {
    EXPECT_EQ(seen[static_cast<std::size_t>(k)], test::at_ms(k));
  }
  EXPECT_EQ(queue.drain([](const Record&) {}), 0u);
}

TEST(QueueRecorderTest, FullQueueDropsTheNewestAndCountsIt) {
  QueueRecorder queue{16};
  std::uint64_t taken = 0;
  std::uint64_t refused = 0;
  for (int k = 0; k < 1000; ++k) {
    (queue.record(test::tick(k)) ? taken : refused) += 1;
  }
  EXPECT_GE(taken, 16u);
  EXPECT_GT(refused, 0u);
  EXPECT_EQ(queue.dropped(), refused);
  std::int64_t expected = 0;
  EXPECT_EQ(queue.drain([&](const Record& r) {
    EXPECT_EQ(std::get<SiteTick>(r).at, test::at_ms(expected++));
  }),
            taken);
  EXPECT_TRUE(queue.record(test::tick(0))) << "there is room again";
  EXPECT_EQ(queue.dropped(), refused);
}

TEST(QueueRecorderTest, HoldsAsManyAsItWasAskedFor) {
  QueueRecorder queue;
  for (int k = 0; k < 16384; ++k) {
    ASSERT_TRUE(queue.record(test::tick(k)));
  }
}

}  // namespace
}  // namespace palp::record
