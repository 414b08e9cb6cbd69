#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "common/core/site_state.h"
#include "common/link/clock_offset.h"
#include "common/message/depth.h"
#include "common/message/port_sample.h"

/// What sites say to each other, before bytes.
namespace palp::link {

enum class Role : std::uint8_t { Surgeon, Patient };

/// The latest result of the depth estimator; repeated in every telegram until replaced.
struct DepthReport {
  std::uint32_t number{};  ///< of the estimate, 0: none yet
  DepthVerdict verdict{};
  DepthReason reason{};
  double depth{};         ///< [m], top of the inclusion below the undeformed surface
  double depth_stddev{};  ///< [m]
  double depth_low{};     ///< [m]
  double depth_high{};    ///< [m]
  double hash{};          ///< [N]
};

/// Newest wins.
struct SiteReport {
  SiteState state{};
  std::uint32_t epoch{};  ///< +1 at every engagement; samples of older epochs are dropped
  double lateral{};       ///< [m]
  DepthReport depth;      ///< patient to surgeon only
};

/// What a node says. The link adds stamps, acknowledgements and two older samples (WIRE.md).
struct Telegram {
  SiteReport site;
  PortSample port;
};

/// Sorted by number: fresh, late and repaired samples, each once. Valid until the next receive().
struct Arrivals {
  std::span<const Incoming> samples;
  SiteReport peer;
  bool peer_heard{};         ///< something was accepted in this session; else `peer` says nothing
  std::uint32_t accepted{};  ///< telegrams newer than all before, in this call
};

/// Running state of a link; counters never fall, except that a new session does not reset them.
struct LinkHealth {
  LinkState state{};
  std::uint64_t session_id{};  ///< as handed over; 0: none, or ended by a gap of 30 s
  Duration gap{};  ///< since the newest accepted datagram arrived; first since the link update
  Duration round_trip{};  ///< smoothed (1/8); 0: not measured yet
  Duration round_trip_min{};
  Duration jitter{};                        ///< smoothed mean deviation of the round trip (1/4)
  std::optional<ClockOffset> peer_clock{};  ///< from the second second on
  Duration delay_out{};  ///< smoothed (1/8), if the least both ways are equal; 0: not known yet
  Duration delay_in{};
  std::uint64_t newest_number{};  ///< highest authentic number of the session
  std::uint8_t key{};             ///< id of the keys under which the newest telegram came
  std::uint64_t sent{};
  std::uint64_t accepted{};  ///< telegrams newer than all before
  std::uint64_t late{};      ///< authentic, but older than the newest accepted
  std::uint64_t repaired{};  ///< samples recovered from a later telegram
  std::uint64_t lost{};      ///< numbers below the highest never seen, so far; late ones leave it
  std::uint64_t
      reordered{};        ///< telegrams with a number below the highest, whatever became of them
  std::uint64_t stale{};  ///< newer than all, but refused as too long on the way
  std::uint64_t old_epoch{};  ///< samples of an older epoch, dropped
  std::uint64_t unsent{};     ///< the transport refused
  std::uint64_t malformed{};
  std::uint64_t foreign{};
  std::uint64_t replayed{};  ///< number already seen: a duplicate of the path, or an attack
  std::uint64_t too_old{};
  std::uint64_t forged{};
};

}  // namespace palp::link
