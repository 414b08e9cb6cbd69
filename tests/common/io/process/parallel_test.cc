#include "common/io/process/parallel.h"

#include <atomic>
#include <vector>

#include <gtest/gtest.h>

namespace palp::io {
namespace {

TEST(ParallelTest, EveryIndexIsWorkedOnOnceWhateverTheNumberOfThreads) {
  for (const std::size_t threads : {1U, 2U, 7U}) {
    std::vector<std::atomic<int>> done(100);
    for_each_index(done.size(), threads, [&](std::size_t i) { ++done[i]; });
    for (const auto& times : done) EXPECT_EQ(times.load(), 1);
  }
}

TEST(ParallelTest, NothingToDoIsDoneAtOnce) {
  for_each_index(0, 4, [](std::size_t) { FAIL(); });
}

TEST(ParallelTest, ThereIsAProcessor) { EXPECT_GE(processors(), 1U); }

}  // namespace
}  // namespace palp::io
