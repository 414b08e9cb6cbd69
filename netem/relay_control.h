#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.h"
#include "common/io/descriptor.h"

namespace palp::netem {

/// Lines of text from whoever connects, and one line back for each: a stream socket on loopback
/// (`127.0.0.1:PORT`) or in the file system (`unix:PATH`). Never blocks. Thread: its owner's.
class RelayControl {
 public:
  using Answer = std::function<std::string(std::string_view line)>;

  /// @returns or the sentence that says why not: another address than loopback, or taken.
  [[nodiscard]] static Result<RelayControl> listen(const std::string& address);
  RelayControl(RelayControl&&) noexcept = default;
  RelayControl& operator=(RelayControl&&) = delete;
  ~RelayControl();

  /// Lets in who waits, reads what came, answers each whole line.
  void serve(const Answer& answer);
  /// Where it listens, port included.
  [[nodiscard]] const std::string& address() const noexcept { return address_; }

 private:
  struct Caller {
    io::Descriptor descriptor;
    std::string text;  ///< of a line that is not whole yet
  };
  RelayControl(io::Descriptor descriptor, std::string address, std::string path);
  [[nodiscard]] static bool serve(Caller& caller, const Answer& answer);

  io::Descriptor descriptor_;
  std::string address_;
  std::string path_;  ///< of the socket in the file system
  std::vector<Caller> callers_;
};

}  // namespace palp::netem
