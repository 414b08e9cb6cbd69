#include "tests/system/process.h"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace palp::system_test {
namespace {

/// Polling a child or its log: there is no event to wait for that covers both.
void rest() { ::usleep(5000); }

}  // namespace

Process::Process(const std::string& program, std::vector<std::string> arguments, std::string log)
    : log_{std::move(log)} {
  const std::string path = std::string{PALP_BINARY_FOLDER} + "/" + program;
  std::vector<char*> argv;
  std::string name = path;
  argv.push_back(name.data());
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, log_.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
  posix_spawn_file_actions_adddup2(&actions, 1, 2);
  const int error = posix_spawn(&pid_, path.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw std::runtime_error{"cannot start " + path};
}

Process::Process(Process&& other) noexcept
    : pid_{std::exchange(other.pid_, -1)},
      exit_code_{other.exit_code_},
      log_{std::move(other.log_)} {}

Process::~Process() {
  if (pid_ < 0 || exit_code_) return;
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

void Process::signal(int number) const {
  if (!exit_code_) ::kill(pid_, number);
}

std::optional<int> Process::wait(std::chrono::milliseconds limit) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (!exit_code_) {
    int status = 0;
    if (::waitpid(pid_, &status, WNOHANG) == pid_) {
      exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    } else if (std::chrono::steady_clock::now() > deadline) {
      return std::nullopt;
    } else {
      rest();
    }
  }
  return exit_code_;
}

std::string Process::output() const {
  std::ifstream file{log_};
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

bool Process::wait_for(const std::string& text, std::chrono::milliseconds limit) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (output().find(text) == std::string::npos) {
    if (wait(std::chrono::milliseconds{0}) || std::chrono::steady_clock::now() > deadline) {
      return output().find(text) != std::string::npos;
    }
    rest();
  }
  return true;
}

std::string Process::address() {
  static const std::string kMark = "listening on ";
  if (!wait_for(kMark, std::chrono::seconds{20})) return {};
  const std::string text = output();
  const std::size_t begin = text.find(kMark) + kMark.size();
  return text.substr(begin, text.find_first_of(" \n", begin) - begin);
}

std::string make_folder(const std::string& name) {
  const std::filesystem::path folder =
      std::filesystem::path{PALP_SCRATCH_FOLDER} / (name + "-" + std::to_string(::getpid()));
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder.string();
}

bool make_certificates(const std::string& folder) {
  Process program{"palp-surgeon", {"certificates", "--folder", folder}, folder + ".log"};
  return program.wait(std::chrono::seconds{20}) == 0;
}

}  // namespace palp::system_test
