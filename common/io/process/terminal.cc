#include "common/io/process/terminal.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <stdexcept>

#include <poll.h>
#include <pthread.h>
#include <sys/ioctl.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include "common/io/process/system_text.h"

namespace palp::io {
namespace {

/// Whether somebody asked that this program outlive its terminal, as nohup(1) does.
bool hang_up_ignored() noexcept {
  struct sigaction action {};
  return sigaction(SIGHUP, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

sigset_t stop_signals() noexcept {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  if (!hang_up_ignored()) {
    sigaddset(&set, SIGHUP);
  }
  return set;
}

void heed_no_signal(int /*signal*/) {}

/// From now on `heed` takes a signal once; a further one has its usual effect.
void heed_once(int signal, void (*heed)(int)) noexcept {
  struct sigaction action {};
  action.sa_handler = heed;
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
  (void)sigaction(signal, &action, nullptr);
}

}  // namespace

Terminal::Terminal() {
  const sigset_t set = stop_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  // Who reads what we print may leave; the session goes on.
  std::signal(SIGPIPE, SIG_IGN);
  // A file that may not grow any further is an error of the write, not an end of the session.
  std::signal(SIGXFSZ, SIG_IGN);
  signals_ = Descriptor{signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC)};
  if (!signals_.valid()) {
    throw std::runtime_error{"cannot watch for signals: " + system_text(errno)};
  }
  // A background job that touched the terminal would be stopped by it.
  if (isatty(STDIN_FILENO) == 1 && tcgetpgrp(STDIN_FILENO) == getpgrp()) {
    read_keys_raw();
  }
}

Terminal::~Terminal() { restore(); }

void Terminal::read_keys_raw() {
  if (tcgetattr(STDIN_FILENO, &before_) != 0) {
    return;
  }
  termios raw = before_;
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  raw.c_cc[VMIN] = 0;
  raw.c_cc[VTIME] = 0;
  keys_ = tcsetattr(STDIN_FILENO, TCSANOW, &raw) == 0;
}

void Terminal::restore() noexcept {
  if (restored_) {
    return;
  }
  restored_ = true;
  if (keys_) {
    tcsetattr(STDIN_FILENO, TCSANOW, &before_);
    keys_ = false;
  }
  const sigset_t set = stop_signals();
  // Also where they were ignored, as a shell does for its background jobs. Who asks a program to
  // end that is ending by itself shall not cost its report.
  const auto next = cause_ ? SIG_DFL : heed_no_signal;
  heed_once(SIGINT, next);
  heed_once(SIGTERM, next);
  if (sigismember(&set, SIGHUP) == 1) heed_once(SIGHUP, next);
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

std::optional<StopCause> Terminal::wait_for_stop(Duration span) {
  if (cause_) {
    return cause_;
  }
  std::array<pollfd, 2> watched{
      {{.fd = signals_.number(), .events = POLLIN, .revents = 0},
       {.fd = keys_ ? STDIN_FILENO : -1, .events = POLLIN, .revents = 0}}};
  const auto timeout = std::chrono::ceil<std::chrono::milliseconds>(span).count();
  if (::poll(watched.data(), watched.size(), static_cast<int>(timeout)) <= 0) {
    return std::nullopt;
  }
  signalfd_siginfo signal{};
  if (watched[0].revents != 0 && read(signals_.number(), &signal, sizeof signal) > 0) {
    cause_ = StopCause::Signal;
  }
  std::array<char, 64> typed{};
  if (!cause_ && watched[1].revents != 0) {
    const ssize_t count = ::read(STDIN_FILENO, typed.data(), typed.size());
    if (count > 0) {
      const auto resets = std::count(typed.begin(), typed.begin() + count, 'r');
      const auto marks = std::count(typed.begin(), typed.begin() + count, 'm');
      const auto tares = std::count(typed.begin(), typed.begin() + count, 't');
      resets_ += static_cast<std::uint32_t>(resets);
      marks_ += static_cast<std::uint32_t>(marks);
      tares_ += static_cast<std::uint32_t>(tares);
      if (resets + marks + tares < count) cause_ = StopCause::Key;
    } else {
      keys_ = false;  // the terminal went away
    }
  }
  if (cause_) {
    restore();
  }
  return cause_;
}

bool Terminal::output_is_terminal() noexcept { return isatty(STDOUT_FILENO) == 1; }

std::size_t Terminal::output_columns() noexcept {
  winsize size{};
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

}  // namespace palp::io
