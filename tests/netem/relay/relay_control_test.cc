#include "netem/relay/relay_control.h"

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "netem/relay/relay_program.h"
#include "tests/netem/relay/control_line.h"
#include "tests/support/own_path.h"

namespace palp::netem {
namespace {

const std::string kToken = "0123456789abcdef";

/// A name for a socket of this process.
std::string socket_name(const std::string& name) { return "unix:" + test::own_path(name); }

std::optional<std::string> heard(std::string_view line, std::uint64_t) {
  return "heard " + std::string{line};
}

TEST(RelayControlTest, ASocketInTheFileSystemIsItsOwnersOnly) {
  const ::mode_t before = ::umask(0);
  const auto control = RelayControl::listen(socket_name("mode"));
  ::umask(before);
  ASSERT_TRUE(control) << control.error().text;
  struct stat about {};
  ASSERT_EQ(::stat(control->address().substr(5).c_str(), &about), 0);
  EXPECT_EQ(about.st_mode & 0777U, 0600U);
}

TEST(RelayControlTest, AnotherUserIsNotHeard) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can become somebody else";
  const std::string name = socket_name("other");
  // Also where the file's rights would let it in.
  auto control = RelayControl::listen(name);
  ASSERT_TRUE(control);
  ::chmod(name.substr(5).c_str(), 0777);
  ASSERT_EQ(::seteuid(65534), 0);
  const Call call{name};
  ASSERT_EQ(::seteuid(0), 0);
  ::send(call.number(), "{\"quit\":true}\n", 14, MSG_NOSIGNAL);
  EXPECT_EQ(call.hear(*control, heard), "");
}

TEST(RelayControlTest, APortWithoutATokenIsRefused) {
  const auto control = RelayControl::listen("127.0.0.1:0");
  ASSERT_FALSE(control);
  EXPECT_FALSE(control.error().unreachable) << "bad input";
}

TEST(RelayControlTest, OnAPortTheFirstLineShowsTheToken) {
  auto control = RelayControl::listen("127.0.0.1:0", kToken);
  ASSERT_TRUE(control);
  EXPECT_EQ(ask(control->address(), "{}", &*control, heard), "") << "hung up";
  EXPECT_EQ(ask(control->address(), R"({"token":"0123456789abcdeF"})", &*control, heard), "");
  const Call call{control->address()};
  call.say(R"({"token":"0123456789abcdef"})"
           "\n{}\n");
  EXPECT_EQ(call.hear(*control, heard), "{\"token\":true}\n");
  EXPECT_EQ(call.hear(*control, heard), "heard {}\n");
}

TEST(RelayControlTest, ALineThatIsNoCommandEndsTheConnection) {
  auto control = RelayControl::listen(socket_name("line"));
  ASSERT_TRUE(control);
  std::uint64_t answered = 0;
  const auto answer = [&](std::string_view, std::uint64_t) {
    ++answered;
    return std::optional<std::string>{"yes"};
  };
  for (const std::string& request :
       {std::string{"POST / HTTP/1.1\r\nHost: localhost\r\nOrigin: http://a.example\r\n\r\n{}\n"},
        std::string{"GET / HTTP/1.1\r\n\r\n"},
        std::string{"OPTIONS"}}) {
    const Call call{control->address()};
    call.say(request);
    const std::string first = call.hear(*control, answer);
    EXPECT_TRUE(first.empty() || first.starts_with("{\"error\"")) << first;
    EXPECT_EQ(call.hear(*control, answer), "") << "hung up";
  }
  EXPECT_EQ(answered, 0U);
}

TEST(RelayControlTest, StrangersThatSayNothingKeepNobodyOut) {
  auto control = RelayControl::listen("127.0.0.1:0", kToken);
  ASSERT_TRUE(control);
  std::vector<Call> silent;
  silent.reserve(200);
  for (int i = 0; i < 200; ++i) {
    silent.emplace_back(control->address());
    control->serve(heard);
  }
  const Call call{control->address()};
  call.say("{\"token\":\"" + kToken + "\"}\n");
  EXPECT_EQ(call.hear(*control, heard), "{\"token\":true}\n");
}

TEST(RelayControlTest, AnswersEachLine) {
  auto control = RelayControl::listen(socket_name("each"));
  ASSERT_TRUE(control) << control.error().text;
  EXPECT_EQ(ask(control->address(), "{1}", &*control, heard), "heard {1}\n");
  EXPECT_EQ(ask(control->address(), "{2}", &*control, heard), "heard {2}\n");
}

TEST(RelayControlTest, ALineWithoutABreakAtTheEndIsAnsweredTooAndMayBeLater) {
  auto control = RelayControl::listen(socket_name("later"));
  ASSERT_TRUE(control);
  std::vector<std::uint64_t> owed;
  const auto answer = [&](std::string_view line, std::uint64_t number) {
    owed.push_back(number);
    return line == "{now}" ? std::optional<std::string>{"here"} : std::nullopt;
  };
  Call call{control->address()};
  call.say("{later}\n{now}", true);
  EXPECT_EQ(call.hear(*control, answer), "here\n");
  ASSERT_EQ(owed.size(), 2U);
  control->reply(owed.at(0), "done");
  EXPECT_EQ(call.hear(*control, answer), "done\n") << "although it says no more";
}

TEST(RelayControlTest, TakesThePlaceOfASocketThatNobodyAnswersOn) {
  const std::string path = test::own_path("left");
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

TEST(RelayControlTest, LeavesWhatTookThePlaceOfItsSocketAlone) {
  const std::string path = test::own_path("taken");
  {
    const auto control = RelayControl::listen("unix:" + path);
    ASSERT_TRUE(control) << control.error().text;
    ::unlink(path.c_str());
    std::ofstream{path} << "mine";
  }
  EXPECT_EQ(::access(path.c_str(), F_OK), 0);
  ::unlink(path.c_str());
}

TEST(RelayControlTest, LeavesAFileThatIsNoSocketAlone) {
  const std::string path = test::own_path("file");
  std::ofstream{path} << "mine";
  EXPECT_FALSE(RelayControl::listen("unix:" + path));
  EXPECT_EQ(::access(path.c_str(), F_OK), 0);
  ::unlink(path.c_str());
}

TEST(RelayControlTest, ListensOnLoopbackOrInTheFileSystemOnly) {
  EXPECT_FALSE(RelayControl::listen("0.0.0.0:0"));
  EXPECT_FALSE(RelayControl::listen("unix:"));
  EXPECT_FALSE(RelayControl::listen("unix:/no/such/folder/socket"));
  const std::string path = test::own_path("control");
  {
    const auto control = RelayControl::listen("unix:" + path);
    ASSERT_TRUE(control) << control.error().text;
    EXPECT_EQ(::access(path.c_str(), F_OK), 0);
  }
  EXPECT_NE(::access(path.c_str(), F_OK), 0) << "the socket's file goes with it";
}

}  // namespace
}  // namespace palp::netem
