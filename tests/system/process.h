#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace palp::system_test {

/// A real process of the product, its output kept in files. Killed when it goes out of scope.
class Process {
 public:
  /// Starts `program` (a name in the build's bin folder) with `arguments`; output goes to `log`.
  Process(const std::string& program, std::vector<std::string> arguments, std::string log);
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  Process(Process&& other) noexcept;
  Process& operator=(Process&&) = delete;
  ~Process();

  void signal(int number) const;
  /// Exit code (128 + number for a signal), or nullopt if it still runs at the deadline.
  [[nodiscard]] std::optional<int> wait(std::chrono::milliseconds limit);
  /// Everything printed so far.
  [[nodiscard]] std::string output() const;
  /// Waits until the output holds `text`; false at the deadline or when the process has ended.
  [[nodiscard]] bool wait_for(const std::string& text, std::chrono::milliseconds limit);
  /// The address behind "listening on ", or empty.
  [[nodiscard]] std::string address();

 private:
  pid_t pid_{-1};
  std::optional<int> exit_code_;
  std::string log_;
};

/// An authority and certificates for both sites in `folder`/surgeon and `folder`/patient.
[[nodiscard]] bool make_certificates(const std::string& folder);

/// An empty folder of its own below the build tree.
[[nodiscard]] std::string make_folder(const std::string& name);

}  // namespace palp::system_test
