#include "common/io/process/process_time.h"

#include <gtest/gtest.h>

namespace palp::io {
namespace {

TEST(ProcessTimeTest, NeitherAccountFalls) {
  ProcessTime before = process_time();
  EXPECT_GT(before.cpu.count(), 0);
  for (int i = 0; i < 100; ++i) {
    const ProcessTime now = process_time();
    EXPECT_GE(now.cpu, before.cpu);
    EXPECT_GE(now.wall, before.wall);
    before = now;
  }
}

TEST(ProcessTimeTest, BothAccountsMoveUnderWork) {
  const ProcessTime before = process_time();
  ProcessTime now = before;
  // Asking is the work; the bound is far beyond the resolution of any clock.
  for (int i = 0; i < 10'000'000 && (now.cpu == before.cpu || now.wall == before.wall); ++i) {
    now = process_time();
  }
  EXPECT_GT(now.cpu, before.cpu);
  EXPECT_GT(now.wall, before.wall);
}

}  // namespace
}  // namespace palp::io
