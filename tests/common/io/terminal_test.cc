#include "common/io/terminal.h"

#include <array>
#include <csignal>

#include <gtest/gtest.h>
#include <unistd.h>

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

TEST(TerminalDeathTest, ATerminalThatIsClosedAsksToStop) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        Terminal terminal;
        kill(getpid(), SIGHUP);
        _exit(terminal.wait_for_stop(seconds{10}) == StopCause::Signal ? 0 : 1);
      },
      testing::ExitedWithCode(0),
      "");
}

TEST(TerminalDeathTest, AHangUpThatIsIgnoredStaysIgnored) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        std::signal(SIGHUP, SIG_IGN);
        Terminal terminal;
        kill(getpid(), SIGHUP);
        _exit(terminal.wait_for_stop(milliseconds{1}) ? 1 : 0);
      },
      testing::ExitedWithCode(0),
      "");
}

void write_to_a_pipe_without_reader() {
  std::array<int, 2> ends{};
  const Terminal terminal;
  const bool made = pipe(ends.data()) == 0 && close(ends[0]) == 0;
  _exit(made && write(ends[1], "x", 1) == -1 ? 0 : 1);
}

TEST(TerminalDeathTest, OutputThatNobodyReadsEndsNoProgram) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(write_to_a_pipe_without_reader(), testing::ExitedWithCode(0), "");
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
