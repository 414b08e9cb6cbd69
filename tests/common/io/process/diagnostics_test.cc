#include "common/io/process/diagnostics.h"

#include <array>
#include <cstdlib>
#include <string>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace palp::io {
namespace {

TEST(DiagnosticsTest, SentenceGoesToStandardErrorAsItStands) {
  testing::internal::CaptureStderr();
  start_diagnostics("palp-test");
  warn("the budget of {} is 5 N, 100 % used");
  const std::string printed = testing::internal::GetCapturedStderr();
  EXPECT_THAT(printed,
              testing::HasSubstr("palp-test warning: the budget of {} is 5 N, 100 % used"));
  EXPECT_EQ(printed.back(), '\n');
}

TEST(DiagnosticsTest, NoColorIsHeededOnATerminal) {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
  ASSERT_EQ(::grantpt(terminal) + ::unlockpt(terminal), 0);
  const int other = ::open(::ptsname(terminal), O_RDWR | O_NOCTTY);
  const int kept = ::dup(STDERR_FILENO);
  const auto said_with = [&](const char* no_color) {
    ::setenv("NO_COLOR", no_color, 1);
    ::setenv("TERM", "xterm-256color", 1);
    ::dup2(other, STDERR_FILENO);
    start_diagnostics("palp-test");
    warn("mind the step");
    ::dup2(kept, STDERR_FILENO);
    // A terminal hands out what was written in pieces.
    std::string said;
    std::array<char, 512> bytes{};
    while (said.find('\n') == std::string::npos) {
      const ssize_t size = ::read(terminal, bytes.data(), bytes.size());
      if (size <= 0) break;
      said.append(bytes.data(), static_cast<std::size_t>(size));
    }
    return said;
  };
  EXPECT_THAT(said_with(""), testing::HasSubstr("\x1b["));
  EXPECT_THAT(said_with("1"), testing::Not(testing::HasSubstr("\x1b[")));
  ::unsetenv("NO_COLOR");
  ::close(kept);
  ::close(other);
  ::close(terminal);
}

}  // namespace
}  // namespace palp::io
