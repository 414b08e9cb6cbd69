#pragma once

#include <cstddef>
#include <deque>

#include "common/core/time.h"
#include "common/io/net/endpoint.h"

namespace palp::io {

/// How many handshakes may begin. One that has begun costs a millisecond of signing before its peer
/// has proven anything but an address, on a thread that may keep others off their processor; and a
/// cookie can be shown as often as one likes. A value. Thread: io.
class Admission {
 public:
  static constexpr std::size_t kOfOneHost = 8;  ///< within a second; a surgeon begins one
  static constexpr std::size_t kOfAll = 32;     ///< within a second

  [[nodiscard]] bool open_to(const Endpoint& from, TimePoint now);
  /// It has begun one.
  void note(const Endpoint& from, TimePoint now);

 private:
  struct Begun {
    Endpoint from;
    TimePoint at{};
  };
  std::deque<Begun> begun_;  ///< within the last second, oldest first
};

}  // namespace palp::io
