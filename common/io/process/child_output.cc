#include "common/io/process/child_output.h"

#include <array>
#include <cerrno>

#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/core/printable.h"
#include "common/io/process/descriptor.h"
#include "common/io/process/system_text.h"

namespace palp::io {
namespace {

/// A file in memory: unlike a pipe it is never full, so nobody waits for the other.
Descriptor memory_file() { return Descriptor{memfd_create("palp", MFD_CLOEXEC)}; }

bool fill(const Descriptor& file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t done = ::write(file.number(), bytes.data(), bytes.size());
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(done));
  }
  return ::lseek(file.number(), 0, SEEK_SET) == 0;
}

std::string all_of(const Descriptor& file) {
  std::string text;
  std::array<char, 65536> part{};
  ::lseek(file.number(), 0, SEEK_SET);
  for (;;) {
    const ssize_t got = ::read(file.number(), part.data(), part.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return text;
    text.append(part.data(), static_cast<std::size_t>(got));
  }
}

std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

}  // namespace

Result<std::string> child_output(const std::vector<std::string>& command, std::string_view input) {
  const std::array files{memory_file(), memory_file(), memory_file()};
  const auto& [in, out, said] = files;
  if (!in.valid() || !out.valid() || !said.valid() || !fill(in, input)) {
    return fail(command.front() + " cannot be given its input: " + system_text(errno));
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (int number = 0; const Descriptor& file : files) {
    posix_spawn_file_actions_adddup2(&actions, file.number(), number++);
  }
  std::vector<std::string> words = command;
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int error =
      posix_spawnp(&child, arguments.front(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    return fail_to_reach(command.front() + " cannot be started: " + system_text(error));
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (status != 0) return fail(command.front() + ": " + harmless_line(last_line(all_of(said))));
  return all_of(out);
}

}  // namespace palp::io
