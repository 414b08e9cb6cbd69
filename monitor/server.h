#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "monitor/access.h"
#include "monitor/controls.h"
#include "monitor/desk.h"
#include "monitor/feed.h"

namespace palp::io {
class BackgroundLoop;
}  // namespace palp::io

namespace palp::monitor {

struct ServerConfig {
  DeskConfig desk;
  Tokens tokens;
  std::uint16_t port{};              ///< 0: any free one
  std::vector<std::string> origins;  ///< pages from elsewhere that may ask too
};

/// Serves the page and the live protocol to browsers and tools of this machine: it listens on
/// 127.0.0.1 and ::1 and nowhere else. A thread of its own, of ordinary priority. Thread: its
/// maker's.
class Server {
 public:
  /// @throws std::runtime_error with one sentence where the port cannot be had. All outlive it.
  Server(const ServerConfig& config, Controls controls, Feed& feed);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  [[nodiscard]] std::uint16_t port() const noexcept;
  /// A picture has come: it does not wait for the next round. Thread: any.
  void wake();
  /// What ended its thread; nullopt: it serves.
  [[nodiscard]] std::optional<std::string> failure() const;

 private:
  class Io;

  std::unique_ptr<Io> io_;
  std::unique_ptr<io::BackgroundLoop> loop_;
};

}  // namespace palp::monitor
