#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace palp::monitor {

/// A TCP connection to a port of this machine that says what it is told to, also what no browser
/// would. Waits a few seconds for answers.
class RawClient {
 public:
  explicit RawClient(std::uint16_t port);
  RawClient(RawClient&& other) noexcept;
  RawClient& operator=(RawClient&&) = delete;
  ~RawClient();

  /// false: the other side has closed.
  [[nodiscard]] bool say(const std::string& bytes) const;
  /// All until the other side closes.
  [[nodiscard]] std::string rest() const;
  /// The head of an HTTP answer.
  [[nodiscard]] std::string head();

  /// A frame as a client sends it. `opcode`: 1 text, 2 bytes.
  [[nodiscard]] bool say_frame(int opcode, const std::string& body) const;
  struct Frame {
    int opcode{};
    std::string body;
  };
  /// nullopt: closed, or nothing came.
  [[nodiscard]] std::optional<Frame> frame();
  /// The next that is a text or bytes; answers pings.
  [[nodiscard]] std::optional<Frame> message();

 private:
  bool fill(std::size_t bytes);

  int socket_;
  std::string in_;
};

/// A request for the live protocol as a browser makes it; `host` "": the right one.
[[nodiscard]] std::string upgrade_request(std::uint16_t port,
                                          const std::string& token,
                                          const std::string& host = "",
                                          const std::string& origin = "");

}  // namespace palp::monitor
