#include "common/io/process/system_text.h"

#include <cerrno>

#include <gtest/gtest.h>

namespace palp::io {
namespace {

TEST(SystemTextTest, FitsTheEndOfASentence) {
  EXPECT_EQ(system_text(EADDRINUSE), "address already in use");
  EXPECT_EQ(system_text(EDOTDOT), "RFS specific error");
}

}  // namespace
}  // namespace palp::io
