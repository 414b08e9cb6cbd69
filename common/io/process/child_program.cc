#include "common/io/process/child_program.h"

#include <cerrno>
#include <csignal>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/io/process/descriptor.h"
#include "common/io/process/system_text.h"

namespace palp::io {
namespace {

constexpr int kStepMs = 10;
constexpr int kNotStarted = 127;

/// Between fork and exec: nothing but system calls.
[[noreturn]] void become(char* const* arguments, int log, int pipe, pid_t parent) {
  // A parent that has ended meanwhile asks nobody to end.
  if (::prctl(PR_SET_PDEATHSIG, SIGTERM) != 0 || ::getppid() != parent) ::_exit(kNotStarted);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (::dup2(nothing, STDIN_FILENO) < 0 || ::dup2(log, STDOUT_FILENO) < 0 ||
      ::dup2(log, STDERR_FILENO) < 0) {
    ::_exit(kNotStarted);
  }
  if (pipe == ChildProgram::kPipeNumber) {
    (void)::fcntl(pipe, F_SETFD, 0);
  } else if (pipe >= 0 && ::dup2(pipe, ChildProgram::kPipeNumber) < 0) {
    ::_exit(kNotStarted);
  }
  ::execvp(arguments[0], arguments);
  ::_exit(kNotStarted);
}

}  // namespace

Result<ChildProgram> ChildProgram::start(const std::vector<std::string>& command,
                                         const std::string& log,
                                         const MessagePipe* pipe) {
  const Descriptor file{::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600)};
  if (!file.valid()) return fail_to_reach("cannot write " + log + ": " + system_text(errno));
  std::vector<std::string> words = command;
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) {
    become(arguments.data(), file.number(), pipe != nullptr ? pipe->number() : -1, parent);
  }
  if (child < 0) {
    return fail_to_reach(command.front() + " cannot be started: " + system_text(errno));
  }
  return ChildProgram{child};
}

ChildProgram::ChildProgram(ChildProgram&& other) noexcept
    : process_{std::exchange(other.process_, 0)}, end_code_{other.end_code_} {}

ChildProgram& ChildProgram::operator=(ChildProgram&& other) noexcept {
  if (this != &other) {
    stop(Duration{0});
    process_ = std::exchange(other.process_, 0);
    end_code_ = other.end_code_;
  }
  return *this;
}

ChildProgram::~ChildProgram() { stop(Duration{0}); }

void ChildProgram::note_end(int status) noexcept {
  end_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool ChildProgram::running() noexcept {
  if (process_ == 0 || end_code_) return false;
  int status = 0;
  if (::waitpid(process_, &status, WNOHANG) != process_) return true;
  note_end(status);
  return false;
}

bool ChildProgram::ends_within(Duration span) noexcept {
  for (Duration waited{}; waited < span && running();
       waited += std::chrono::milliseconds{kStepMs}) {
    (void)::poll(nullptr, 0, kStepMs);
  }
  return !running();
}

void ChildProgram::stop(Duration patience) noexcept {
  if (!running()) return;
  (void)::kill(process_, SIGTERM);
  if (ends_within(patience)) return;
  (void)::kill(process_, SIGKILL);
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  note_end(status);
}

}  // namespace palp::io
