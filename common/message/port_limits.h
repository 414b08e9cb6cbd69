#pragma once

#include "common/message/port_sample.h"

namespace palp::message {

/// Brings each number of a sample that leaves its limits on the wire back to the nearest within; of
/// what is no number, 0. A telegram with such a number would not be sent at all, and the peer would
/// hear nothing, not even that this site stops. Thread: rt.
/// @returns true: there was one.
bool keep_limits(PortSample& sample) noexcept;

}  // namespace palp::message
