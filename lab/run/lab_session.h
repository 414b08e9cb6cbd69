#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "common/link/link.h"
#include "common/link/session.h"
#include "common/link/transport.h"
#include "lab/run/local_clock.h"

namespace palp::lab {

/// What a site's process does about its session, as the io thread does in real time: shares one
/// end of the path between link and session, runs the handshake, hands sessions over to the link.
/// Plain, as with --insecure. Dies with the process. Thread: the lab's. Refers to all it is given.
class LabSession {
 public:
  LabSession(const link::SessionConfig& config,
             std::uint64_t entropy,
             link::Transport& end,
             const LocalClock& clock,
             link::Link& link);
  LabSession(const LabSession&) = delete;
  LabSession& operator=(const LabSession&) = delete;

  /// Once a tick, after the node's. `now`: the lab's time.
  void step(TimePoint now);

 private:
  struct Waiting {
    std::vector<std::byte> bytes;
    TimePoint arrived_at{};  ///< local
  };
  /// The link's way through this session; outlived by it.
  class DataWay final : public link::Transport {
   public:
    explicit DataWay(LabSession& owner) noexcept : owner_{owner} {}
    bool send(std::span<const std::byte> datagram, TimePoint now) noexcept override;
    std::optional<link::Datagram> receive(std::span<std::byte, link::kDatagramSizeMax> buffer,
                                          TimePoint now) noexcept override;

   private:
    LabSession& owner_;
  };

  void drain(TimePoint now);
  void carry_out(const link::SessionOutput& output, TimePoint now);

  link::Session session_;
  link::Transport& end_;
  const LocalClock& clock_;
  link::Link& link_;
  std::deque<Waiting> data_;
  std::deque<Waiting> control_;
};

}  // namespace palp::lab
