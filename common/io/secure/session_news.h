#pragma once

#include <cstdint>
#include <string>

#include "common/core/time.h"
#include "common/io/net/endpoint.h"
#include "common/link/session.h"

namespace palp::io {

/// What people are told of sessions.
struct SessionNews {
  enum class Kind : std::uint8_t { Established, Refused, Closed, Moved };
  Kind kind{};
  bool final{};  ///< refused, and there will never be a session with these settings
  TimePoint at{};
  Endpoint peer;
  std::string sentence;
};

/// Of an Established one, told by a site of that role: with whom, and what that was proven by.
[[nodiscard]] std::string session_sentence(link::Role role,
                                           const Endpoint& peer,
                                           const link::Established& session,
                                           const std::string& proof);

}  // namespace palp::io
