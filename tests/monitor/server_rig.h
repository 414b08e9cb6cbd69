#pragma once

#include <string>

#include "monitor/server.h"
#include "tests/monitor/raw_client.h"

namespace palp::monitor {

/// A server on a free port, and what its clients did with it.
struct ServerRig {
  const std::string view = std::string(32, 'a');
  const std::string control = std::string(32, 'b');
  SpscQueue<Request> requests{256};
  Mailbox<std::uint32_t> stops;
  Mailbox<PointerReport> pointer;
  Feed feed{link::Role::Surgeon, {}, std::chrono::milliseconds{1}};
  Server server{{.desk = {.site = link::Role::Surgeon, .program = "palp-surgeon", .run = "r"},
                 .tokens = {.view = view, .control = control},
                 .port = 0,
                 .origins = {}},
                {.requests = &requests, .stops = &stops, .pointer = &pointer},
                feed};

  [[nodiscard]] std::uint16_t port() const { return server.port(); }
  /// Greeted already.
  [[nodiscard]] RawClient client(const std::string& token) const {
    RawClient client{port()};
    (void)client.say(upgrade_request(port(), token));
    (void)client.head();
    return client;
  }
  [[nodiscard]] std::string get(const std::string& path, const std::string& more = "") const {
    const RawClient client{port()};
    (void)client.say("GET " + path + " HTTP/1.1\r\nHost: localhost:" + std::to_string(port()) +
                     "\r\n" + more + "\r\n");
    return client.rest();
  }
};

}  // namespace palp::monitor
