#include "common/io/process/child_program.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/support/own_path.h"

namespace palp::io {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

/// A log of the test's own.
struct Log {
  std::string path{palp::test::own_path("child.log")};
  ~Log() { std::filesystem::remove(path); }
  [[nodiscard]] std::string text() const {
    std::stringstream out;
    out << std::ifstream{path}.rdbuf();
    return out.str();
  }
};

TEST(ChildProgramTest, RunsBesideAndTellsHowItEnded) {
  const Log log;
  auto child = ChildProgram::start({"sh", "-c", "echo said; echo why >&2; exit 3"}, log.path);
  ASSERT_TRUE(child) << child.error().text;
  EXPECT_TRUE(child->ends_within(20s));
  EXPECT_FALSE(child->running());
  EXPECT_EQ(child->end_code(), 3);
  EXPECT_EQ(log.text(), "said\nwhy\n");
}

TEST(ChildProgramTest, IsAskedToEndAndThenEnded) {
  const Log log;
  auto willing = ChildProgram::start({"sleep", "600"}, log.path);
  ASSERT_TRUE(willing);
  EXPECT_TRUE(willing->running());
  willing->stop(20s);
  EXPECT_EQ(willing->end_code(), 128 + SIGTERM);
  auto stubborn = ChildProgram::start(
      {"sh", "-c", "trap '' TERM; echo up; while :; do sleep 0.1; done"}, log.path);
  ASSERT_TRUE(stubborn);
  while (log.text() != "up\n") (void)stubborn->ends_within(10ms);
  stubborn->stop(Duration{0});
  EXPECT_EQ(stubborn->end_code(), 128 + SIGKILL);
}

TEST(ChildProgramTest, HoldsItsEndOfAPipe) {
  const Log log;
  auto ends = MessagePipe::make();
  ASSERT_TRUE(ends);
  auto child = ChildProgram::start(
      {"sh", "-c", "printf heard >&3; dd bs=99 count=1 <&3 | grep -q go && exit 7"},
      log.path,
      &ends->second);
  ASSERT_TRUE(child);
  ends->first.wait(20s);
  EXPECT_EQ(ends->first.receive(), "heard");
  EXPECT_TRUE(ends->first.send("go\n"));
  EXPECT_TRUE(child->ends_within(20s));
  EXPECT_EQ(child->end_code(), 7) << log.text();
}

TEST(ChildProgramTest, AProgramThatIsNotThereEndsAtOnce) {
  const Log log;
  auto child = ChildProgram::start({"/no/such/program"}, log.path);
  ASSERT_TRUE(child);
  EXPECT_TRUE(child->ends_within(20s));
  EXPECT_EQ(child->end_code(), 127);
  EXPECT_FALSE(ChildProgram::start({"true"}, "/no/such/folder/log"));
}

}  // namespace
}  // namespace palp::io
