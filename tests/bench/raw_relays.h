#pragma once

#include <atomic>

#include "common/core/time.h"
#include "common/io/net/endpoint.h"

/// The plainest relays there are, one way, for comparison: plain sockets, nothing of ours. Each
/// reads from `in` and sends to the connected `out` until `stop` is set.
namespace palp::bench {

/// epoll, recv, send: one datagram after the other.
void relay_with_epoll(int in, int out, const std::atomic<bool>& stop);
/// recvmmsg and sendmmsg of 64.
void relay_with_batches(int in, int out, const std::atomic<bool>& stop);
/// Holds each for `delay` after the kernel's stamp with a timerfd.
void hold_with_timerfd(int in, int out, Duration delay, const std::atomic<bool>& stop);

}  // namespace palp::bench
