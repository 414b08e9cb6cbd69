#pragma once

#include <cstdint>
#include <string>

#include "monitor/desk.h"

namespace palp::monitor {

/// The body of the oldest frame that waits for a client, taken from its outbox; empty: none waits.
inline std::string next_frame(Desk& desk, std::uint32_t client) {
  Outbox& box = desk.outbox(client);
  if (box.empty()) return {};
  const std::string body = box.begin_first().body;
  box.pop();
  return body;
}

}  // namespace palp::monitor
