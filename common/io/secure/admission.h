#pragma once

#include <cstddef>
#include <deque>

#include "common/core/time.h"
#include "common/io/net/endpoint.h"

namespace palp::io {

/// How many handshakes may begin. One that has begun costs a millisecond of signing before its peer
/// has proven anything but an address, on a thread that may keep others off their processor; and a
/// cookie can be shown as often as one likes. Whoever begins handshakes and does not finish them
/// comes behind those who have not begun any. A value. Thread: io.
class Admission {
 public:
  static constexpr std::size_t kOfOneHost = 8;  ///< within a second; a surgeon begins one
  static constexpr std::size_t kOfDebtors = 8;  ///< of all with an unfinished one, within a second
  static constexpr std::size_t kOfAll = 32;     ///< within a second
  /// Between two of a host that has not finished one; a surgeon tries again after as long.
  static constexpr Duration kPause = std::chrono::seconds{1};
  static constexpr Duration kMemory = std::chrono::seconds{10};  ///< of an unfinished one

  [[nodiscard]] bool open_to(const Endpoint& from, TimePoint now);
  /// It has begun one.
  void note(const Endpoint& from, TimePoint now);
  /// It has finished one, so that none of its earlier ones counts as unfinished.
  void finished(const Endpoint& from);
  /// Unfinished handshakes of its host.
  [[nodiscard]] std::size_t debt(const Endpoint& from) const;

 private:
  struct Begun {
    Endpoint from;
    TimePoint at{};
    bool by_debtor{};
    bool finished{};
  };
  void forget(TimePoint now);

  std::deque<Begun> begun_;  ///< oldest first
};

}  // namespace palp::io
