#include "common/io/terminal.h"

#include <csignal>

#include <gtest/gtest.h>

namespace palp::io {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(TerminalTest, NothingHappensUntilSomebodyStops) {
  Terminal terminal;
  EXPECT_EQ(terminal.wait_for_stop(milliseconds{1}), std::nullopt);
}

TEST(TerminalTest, SignalStopsAndStaysStopped) {
  Terminal terminal;
  ASSERT_EQ(kill(getpid(), SIGTERM), 0);
  EXPECT_EQ(terminal.wait_for_stop(seconds{10}), StopCause::Signal);
  EXPECT_EQ(terminal.wait_for_stop(seconds{10}), StopCause::Signal);
}

TEST(TerminalDeathTest, SecondSignalEndsTheProgram) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        Terminal terminal;
        kill(getpid(), SIGINT);
        (void)terminal.wait_for_stop(seconds{10});
        kill(getpid(), SIGINT);
        (void)terminal.wait_for_stop(seconds{10});
        _exit(0);
      },
      testing::KilledBySignal(SIGINT),
      "");
}

}  // namespace
}  // namespace palp::io
