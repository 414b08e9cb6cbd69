#include "netem/relay_control.h"

#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "netem/relay_program.h"
#include "tests/netem/control_line.h"

namespace palp::netem {
namespace {

TEST(RelayControlTest, AnswersEachLine) {
  auto control = RelayControl::listen("127.0.0.1:0");
  ASSERT_TRUE(control) << control.error().text;
  const auto answer = [](std::string_view line) { return "heard " + std::string{line}; };
  EXPECT_EQ(ask(control->address(), "one", &*control, answer), "heard one\n");
  EXPECT_EQ(ask(control->address(), "two", &*control, answer), "heard two\n");
}

TEST(RelayControlTest, ListensOnLoopbackOrInTheFileSystemOnly) {
  EXPECT_FALSE(RelayControl::listen("0.0.0.0:0"));
  EXPECT_FALSE(RelayControl::listen("unix:"));
  EXPECT_FALSE(RelayControl::listen("unix:/no/such/folder/socket"));
  const std::string path = ::testing::TempDir() + "palp-control-" + std::to_string(::getpid());
  {
    const auto control = RelayControl::listen("unix:" + path);
    ASSERT_TRUE(control) << control.error().text;
    EXPECT_EQ(::access(path.c_str(), F_OK), 0);
  }
  EXPECT_NE(::access(path.c_str(), F_OK), 0) << "the socket's file goes with it";
}

}  // namespace
}  // namespace palp::netem
