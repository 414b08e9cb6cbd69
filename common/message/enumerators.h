#pragma once

#include "common/core/depth_verdict.h"
#include "common/core/site_state.h"
#include "common/message/field.h"

/// The enums of messages, as proto/ names what they hold.
namespace palp::message {

template <std::same_as<SiteState> E>
inline constexpr auto enumerators<E> =
    enumeration("SiteState", "", "PARKED", "CLUTCHED", "ENGAGED", "HOLD", "RETRACT", "STOPPED");

template <std::same_as<LinkState> E>
inline constexpr auto enumerators<E> =
    enumeration("LinkState", "", "LINK_DOWN", "LINK_LIVE", "LINK_HOLD", "LINK_LOST");

template <std::same_as<DepthVerdict> E>
inline constexpr auto enumerators<E> = enumeration("DepthVerdict", "", "NONE", "FOUND", "INVALID");

template <std::same_as<DepthReason> E>
inline constexpr auto enumerators<E> = enumeration("DepthReason",
                                                   "",
                                                   "OK",
                                                   "STROKE_TOO_SHORT",
                                                   "STROKE_TOO_FEW_SAMPLES",
                                                   "STROKE_NOT_MONOTONE",
                                                   "NO_CONTACT",
                                                   "FORCE_SATURATED",
                                                   "HASH_OUT_OF_RANGE",
                                                   "TOO_NOISY");

}  // namespace palp::message
