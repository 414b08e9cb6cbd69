#include "common/io/process/terminal.h"

#include <array>
#include <csignal>
#include <cstdlib>

#include <fcntl.h>
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

/// Standard input becomes a terminal of its own. @returns the end that types, or -1.
int sit_down_at_a_terminal() {
  if (setsid() == -1) return -1;
  const int keyboard = posix_openpt(O_RDWR | O_NOCTTY);
  if (keyboard == -1 || grantpt(keyboard) != 0 || unlockpt(keyboard) != 0) return -1;
  const int screen = open(ptsname(keyboard), O_RDWR);  // the first one is the session's
  return screen != -1 && dup2(screen, STDIN_FILENO) == STDIN_FILENO ? keyboard : -1;
}

/// Exits with the number of the first thing that is wrong.
void press_keys() {
  const int keyboard = sit_down_at_a_terminal();
  if (keyboard == -1) _exit(1);
  Terminal terminal;
  if (!terminal.reads_keys()) _exit(2);
  if (write(keyboard, "r", 1) != 1 || terminal.wait_for_stop(seconds{10})) _exit(3);
  if (terminal.resets() != 1) _exit(4);
  if (write(keyboard, "m", 1) != 1 || terminal.wait_for_stop(seconds{10})) _exit(5);
  if (terminal.marks() != 1 || terminal.resets() != 1) _exit(6);
  if (write(keyboard, "t", 1) != 1 || terminal.wait_for_stop(seconds{10})) _exit(10);
  if (terminal.tares() != 1 || terminal.marks() != 1) _exit(11);
  if (write(keyboard, "rmq", 3) != 3) _exit(7);
  if (terminal.wait_for_stop(seconds{10}) != StopCause::Key) _exit(8);
  _exit(terminal.resets() == 2 && terminal.marks() == 2 ? 0 : 9);
}

TEST(TerminalDeathTest, TheKeysForAResetAndAMarkDoNotStop) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(press_keys(), testing::ExitedWithCode(0), "");
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

TEST(TerminalDeathTest, OneSignalDoesNotCostTheReportOfWhatEndsByItself) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        {
          const Terminal terminal;
          kill(getpid(), SIGINT);
        }
        _exit(0);
      },
      testing::ExitedWithCode(0),
      "");
}

TEST(TerminalDeathTest, AFurtherSignalEndsAlsoWhatEndsByItself) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        {
          const Terminal terminal;
          kill(getpid(), SIGTERM);
        }
        kill(getpid(), SIGTERM);
        _exit(0);
      },
      testing::KilledBySignal(SIGTERM),
      "");
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
