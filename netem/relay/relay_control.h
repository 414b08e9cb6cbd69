#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.h"
#include "common/io/process/descriptor.h"

namespace palp::netem {

/// Lines of text from whoever connects, and one line back for each: a stream socket in the file
/// system (`unix:PATH`), for its owner and root only, or on loopback (`127.0.0.1:PORT`), for who
/// shows a token in the first line. A line that is no JSON object ends the connection: a browser's
/// request begins with one. Never blocks. Thread: its owner's.
class RelayControl {
 public:
  /// @returns the answer, or nullopt: reply() will give it, under this number of the line.
  using Answer =
      std::function<std::optional<std::string>(std::string_view line, std::uint64_t number)>;

  /// Takes the place of a socket in the file system that nobody answers on.
  /// `token`: what callers of a port show; for a port there must be one.
  /// @returns or the sentence that says why not: another address than loopback (bad input), or
  /// taken (unreachable).
  [[nodiscard]] static Result<RelayControl> listen(const std::string& address,
                                                   std::string token = {});
  RelayControl(RelayControl&&) noexcept = default;
  RelayControl& operator=(RelayControl&&) = delete;
  ~RelayControl();

  /// Lets in who waits, reads what came, answers each line; one without a break at the end counts
  /// once the caller says no more.
  void serve(const Answer& answer);
  /// The answer to an earlier line. Who asked and has gone is left out.
  void reply(std::uint64_t number, const std::string& text);
  /// Where it listens, port included.
  [[nodiscard]] const std::string& address() const noexcept { return address_; }

 private:
  struct Caller {
    io::Descriptor descriptor;
    std::string text;                   ///< of a line that is not whole yet
    std::vector<std::uint64_t> owed{};  ///< lines without an answer yet
    bool silent{};                      ///< says no more, but may listen
    bool known{};                       ///< may say something
  };
  RelayControl(io::Descriptor descriptor, std::string address, std::string path, std::string token);
  [[nodiscard]] bool serve(Caller& caller, const Answer& answer);
  [[nodiscard]] bool take_lines(Caller& caller, const Answer& answer);
  void let_in();

  io::Descriptor descriptor_;
  std::string address_;
  std::string path_;        ///< of the socket in the file system
  std::uint64_t device_{};  ///< where that socket lies, as its inode
  std::uint64_t inode_{};
  std::string token_;  ///< of a port
  std::vector<Caller> callers_;
  std::uint64_t lines_{};
};

}  // namespace palp::netem
