#pragma once

#include <optional>

#include "common/core/time.h"
#include "common/io/net/endpoint.h"

namespace palp::io {

/// The address from which this machine would send to `peer` now, with any port; None: there is no
/// way to it. Asks the kernel, sends nothing.
[[nodiscard]] Endpoint source_towards(const Endpoint& peer);

/// Notices that the machine's address changes: a connected socket keeps the one it began with, and
/// once that is gone nothing it sends leaves. Asking the kernel for its choice answers for all that
/// may have happened: addresses, interfaces, routes. A value. Thread: io.
class SourceWatch {
 public:
  static constexpr Duration kPause = std::chrono::milliseconds{20};  ///< between two looks

  /// A socket is connected from `own` to `peer`.
  void begin(const Endpoint& own, const Endpoint& peer) {
    own_ = own;
    peer_ = peer;
  }
  /// Often. Whether a socket that is connected now would send from another address.
  [[nodiscard]] bool has_changed(TimePoint now);

 private:
  Endpoint own_;
  Endpoint peer_;
  std::optional<TimePoint> looked_at_;
};

}  // namespace palp::io
