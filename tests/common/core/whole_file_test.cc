// Goal: no name of a file makes a program hang, run out of memory or go on with half a file.
#include "common/core/whole_file.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/own_path.h"

namespace palp {
namespace {

constexpr std::size_t kMiB = 1U << 20U;

TEST(WholeFileTest, SaysWhyItCannotRead) {
  EXPECT_EQ(read_whole_file("/nowhere/a.conf", kMiB).error().text,
            "cannot read /nowhere/a.conf: No such file or directory");
  EXPECT_TRUE(read_whole_file("/nowhere/a.conf", kMiB).error().unreachable);
  EXPECT_EQ(read_whole_file("/", kMiB).error().text, "cannot read /: Is a directory");
  EXPECT_EQ(read_whole_file("/dev/zero", kMiB).error().text,
            "cannot read /dev/zero: it is longer than 1048576 bytes");
  EXPECT_EQ(read_whole_file("/dev/zero", 5'000'000).error().text,
            "cannot read /dev/zero: it is longer than 5000000 bytes");
  EXPECT_EQ(read_whole_file("/dev/null", kMiB), "");
}

TEST(WholeFileTest, APipeNobodyWritesToIsGivenUp) {
  const std::string pipe = test::own_path("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(read_whole_file(pipe, kMiB).error().text,
            "cannot read " + pipe.substr(0, 80) + ": it gives nothing for 2 s");
  std::filesystem::remove(pipe);
}

}  // namespace
}  // namespace palp
