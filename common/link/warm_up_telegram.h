#pragma once

#include "common/link/telegram.h"

namespace palp::link {

/// With all that a node can say, and nothing in it 0: a codec that is warmed up on it goes every
/// way that it may have to go.
inline const Telegram kWarmUpTelegram{
    .site = {.state = SiteState::Engaged,
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
                                     .relaxing = {1, 1}}}};

}  // namespace palp::link
