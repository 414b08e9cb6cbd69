#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "common/core/mailbox.h"
#include "common/io/net/link_update_desk.h"
#include "common/io/realtime/periodic_thread.h"
#include "common/io/secure/session_server.h"
#include "common/link/codec_wire.h"
#include "common/link/link.h"

namespace palp::bench {

/// A site in real time under keys: what a program makes of it, without a node.
struct SecureSite {
  SecureSite(link::Role role, std::uint16_t port, const io::Credentials& credentials)
      : server{config_of(role, port, credentials), desk} {}
  static io::SessionServerConfig config_of(link::Role role,
                                           std::uint16_t port,
                                           const io::Credentials& credentials) {
    io::SessionServerConfig config;
    config.session = {.role = role, .settings_hash = 1, .coupling = "direct", .git = ""};
    config.address = {.host = "127.0.0.1", .port = port};
    config.priority = 70;
    config.credentials = &credentials;
    return config;
  }
  /// `exchange` receives from the link and sends by it.
  void start(std::function<void(TimePoint)> exchange) {
    const io::LoopConfig loop{.priority = 80, .lock_memory = true};
    rt = std::make_unique<io::PeriodicThread>(
        "bench-rt",
        loop,
        [this, exchange = std::move(exchange)](TimePoint now) {
          desk.serve(link, now);
          exchange(now);
          health.put(link.health(now));
        },
        [this] { link.warm_up(); });
  }

  io::LinkUpdateDesk desk;
  link::Link link{{}, std::make_unique<link::WireCodec>()};
  io::SessionServer server;
  Mailbox<LinkHealth> health;  ///< writer: rt, reader: main
  std::unique_ptr<io::PeriodicThread> rt;
};

}  // namespace palp::bench
