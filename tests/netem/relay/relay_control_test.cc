#include "netem/relay/relay_control.h"

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/un.h>
#include <unistd.h>

#include "netem/relay/relay_program.h"
#include "tests/netem/relay/control_line.h"

namespace palp::netem {
namespace {

TEST(RelayControlTest, AnswersEachLine) {
  auto control = RelayControl::listen("127.0.0.1:0");
  ASSERT_TRUE(control) << control.error().text;
  const auto answer = [](std::string_view line, std::uint64_t) {
    return std::optional{"heard " + std::string{line}};
  };
  EXPECT_EQ(ask(control->address(), "one", &*control, answer), "heard one\n");
  EXPECT_EQ(ask(control->address(), "two", &*control, answer), "heard two\n");
}

TEST(RelayControlTest, ALineWithoutABreakAtTheEndIsAnsweredTooAndMayBeLater) {
  auto control = RelayControl::listen("127.0.0.1:0");
  ASSERT_TRUE(control);
  std::vector<std::uint64_t> owed;
  const auto answer = [&](std::string_view line, std::uint64_t number) {
    owed.push_back(number);
    return line == "now" ? std::optional<std::string>{"here"} : std::nullopt;
  };
  Call call{control->address()};
  call.say("later\nnow", true);
  EXPECT_EQ(call.hear(*control, answer), "here\n");
  ASSERT_EQ(owed.size(), 2U);
  control->reply(owed.at(0), "done");
  EXPECT_EQ(call.hear(*control, answer), "done\n") << "although it says no more";
}

TEST(RelayControlTest, TakesThePlaceOfASocketThatNobodyAnswersOn) {
  const std::string path = ::testing::TempDir() + "palp-left-" + std::to_string(::getpid());
  {
    sockaddr_un local{};
    local.sun_family = AF_UNIX;
    path.copy(local.sun_path, sizeof local.sun_path - 1);
    const io::Descriptor left{::socket(AF_UNIX, SOCK_STREAM, 0)};
    ASSERT_EQ(::bind(left.number(), reinterpret_cast<const sockaddr*>(&local), sizeof local), 0);
  }
  const auto control = RelayControl::listen("unix:" + path);
  ASSERT_TRUE(control) << control.error().text;
  const auto second = RelayControl::listen("unix:" + path);
  ASSERT_FALSE(second) << "the first one listens";
  EXPECT_TRUE(second.error().unreachable);
}

TEST(RelayControlTest, LeavesAFileThatIsNoSocketAlone) {
  const std::string path = ::testing::TempDir() + "palp-file-" + std::to_string(::getpid());
  std::ofstream{path} << "mine";
  EXPECT_FALSE(RelayControl::listen("unix:" + path));
  EXPECT_EQ(::access(path.c_str(), F_OK), 0);
  ::unlink(path.c_str());
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
