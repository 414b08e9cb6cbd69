#pragma once

#include <array>
#include <cstdint>

#include "common/core/place.h"
#include "common/core/site_state.h"
#include "common/message/depth.h"
#include "common/message/enumerators.h"
#include "common/message/field.h"
#include "common/message/limits.h"
#include "common/message/map_report.h"
#include "common/message/port_sample.h"

/// What sites say to each other, before bytes.
namespace palp {

/// Newest wins.
struct SiteReport {
  SiteState state{};
  std::uint32_t epoch{};  ///< +1 at every engagement; samples of older epochs are dropped
  Place place;
  DepthReport depth;   ///< patient to surgeon only
  MapReport map{};     ///< likewise, at times; number 0: not this time
  MapCell map_cell{};  ///< likewise: one of its cells
};

/// What a node says. The link adds stamps, acknowledgements and two older samples (WIRE.md).
struct Telegram {
  SiteReport site;
  PortSample port;
};

/// What crosses: the node's Telegram and what the link adds. Plain numbers with the unit in the
/// name, because this is a border.
struct WireTelegram {
  std::uint64_t sent_at_ns{};                     ///< since the sender's session start
  std::uint64_t echo_ns{message::kNothingHeard};  ///< newest sent_at_ns received
  std::uint64_t newest_number{};  ///< this and the next two: 0 while nothing was heard
  std::uint32_t before_newest{};  ///< bit k: number newest_number - 1 - k was received
  std::uint32_t hold_us{};        ///< arrival of the echoed telegram to this departure
  std::uint8_t older_count{};     ///< 0 to 2
  Telegram telegram;
  std::array<PortSample, 2> older{};  ///< of 5 and 10 ms before; payload: wave or none
};

namespace message {

template <std::same_as<SiteReport> S>
inline constexpr auto fields<S> =
    list({.wire = "Site"},
         field<1, &S::state>("state"),
         field<2, &S::epoch>("epoch"),
         field<3, &S::place, &Place::x>("x_m", wire<float>, limit(kLengthMax)),
         field<4, &S::depth>("depth", nothing_if_zero<&DepthReport::number>),
         field<5, &S::place, &Place::y>("y_m", wire<float>, limit(kLengthMax)),
         field<6, &S::map>("map", nothing_if_zero<&MapReport::number>),
         field<7, &S::map_cell>("map_cell", nothing_if_zero<&MapCell::number>));

template <std::same_as<WireTelegram> S>
inline constexpr auto fields<S> =
    list({.wire = "Telegram"},
         field<1, &S::sent_at_ns>("sent_at_ns", limit(kSentAtMaxNs)),
         field<2, &S::echo_ns>("echo_ns", none_is(kNothingHeard), limit(kSentAtMaxNs)),
         field<3, &S::hold_us>("hold_us", limit(kHoldMaxUs)),
         field<4, &S::newest_number>("newest_number", limit(kNumberMax)),
         field<5, &S::before_newest>("before_newest", fixed_width),
         field<6, &S::telegram, &Telegram::site>("site"),
         field<7, &S::telegram, &Telegram::port>("sample"),
         field<8, &S::older, 0>("sample_first_earlier", counted<&S::older_count, 0>),
         field<9, &S::older, 1>("sample_second_earlier", counted<&S::older_count, 1>),
         aside<&S::older_count>("older_count"));

}  // namespace message
}  // namespace palp
