#pragma once

#include "common/link/codec.h"

namespace palp::link {

/// With all that a telegram can hold, and nothing in it 0: a codec that is rehearsed on it goes
/// every way that it may have to go.
inline const WireTelegram kRehearsed{
    .sent_at_ns = kSentAtMaxNs,
    .echo_ns = kSentAtMaxNs,
    .newest_number = 1,
    .before_newest = 1,
    .hold_us = 1000,
    .telegram = {.site = {.state = SiteState::Engaged,
                          .epoch = 1,
                          .lateral = 1,
                          .depth = {.number = 1, .depth = 1, .depth_low = 1, .depth_high = 1}},
                 .port = {.position = 1,
                          .velocity = 1,
                          .force = 1,
                          .payload = ModelPayload{.version = 1,
                                                  .c = {1, 1, 1, 1, 1},
                                                  .surface = 1,
                                                  .depth_max = 1,
                                                  .residual = 1,
                                                  .swing = 1,
                                                  .swing_quadrature = 1,
                                                  .swing_rate = 1,
                                                  .relaxing = {1, 1}}}},
    .older = {PortSample{.position = 1, .velocity = 1, .force = 1, .payload = {}},
              PortSample{.position = 1, .velocity = 1, .force = 1, .payload = {}}},
    .older_count = 2};

}  // namespace palp::link
