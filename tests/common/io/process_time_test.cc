#include "common/io/process_time.h"

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

}  // namespace
}  // namespace palp::io
