#pragma once

#include <cstdint>
#include <optional>

#include "common/core/site_state.h"
#include "common/core/time.h"
#include "common/message/enumerators.h"
#include "common/message/field.h"

/// How the link is.
namespace palp {

/// What the peer's line of time is to ours. Only the sum of the two ways can be measured: where one
/// takes longer than the other, the offset is wrong by half the difference, at most half the least
/// round trip. So it is told and logged, and nothing that protects anybody rests on it.
struct ClockOffset {
  Duration offset{};       ///< peer's time - ours at `at`, each since its begin of the session
  double skew{};           ///< [s/s], the peer's clock gains so much on ours
  Duration uncertainty{};  ///< of the offset: half the least round trip, what no exchange can see
  TimePoint at{};

  [[nodiscard]] Duration offset_at(TimePoint now) const noexcept {
    return offset + from_seconds(skew * seconds(now - at));
  }
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

namespace message {

template <std::same_as<ClockOffset> S>
inline constexpr auto fields<S> = list({},
                                       field<1, &S::offset>("offset_ns", always),
                                       field<2, &S::skew>("skew"),
                                       field<3, &S::uncertainty>("uncertainty_ns"),
                                       field<4, &S::at>("at_ns"));

template <std::same_as<LinkHealth> S>
inline constexpr auto fields<S> = list({},
                                       aside<&S::session_id>("session_id"),
                                       aside<&S::newest_number>("newest_number"),
                                       aside<&S::key>("key"),
                                       field<1, &S::state>("state"),
                                       field<2, &S::gap>("gap_ns"),
                                       field<3, &S::round_trip>("round_trip_ns"),
                                       field<4, &S::round_trip_min>("round_trip_min_ns"),
                                       field<5, &S::jitter>("jitter_ns"),
                                       field<6, &S::sent>("sent", counts),
                                       field<7, &S::accepted>("accepted", counts),
                                       field<8, &S::late>("late", counts),
                                       field<9, &S::repaired>("repaired", counts),
                                       field<10, &S::lost>("lost", counts),
                                       field<11, &S::reordered>("reordered", counts),
                                       field<12, &S::stale>("stale", counts),
                                       field<13, &S::old_epoch>("old_epoch", counts),
                                       field<14, &S::unsent>("unsent", counts),
                                       field<15, &S::malformed>("malformed", counts_refusals),
                                       field<16, &S::foreign>("foreign", counts_refusals),
                                       field<17, &S::replayed>("replayed", counts_refusals),
                                       field<18, &S::too_old>("too_old", counts_refusals),
                                       field<19, &S::forged>("forged", counts_refusals),
                                       spread<20, &S::peer_clock>("clock_"),
                                       field<25, &S::delay_out>("delay_out_ns"),
                                       field<26, &S::delay_in>("delay_in_ns"));

}  // namespace message
}  // namespace palp
