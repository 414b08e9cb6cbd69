#pragma once

#include <sys/socket.h>

namespace palp::io {

/// With this flag a send call walks the kernel's way to the network and sends nothing: what comes
/// next finds that way in the caches. Linux names the bit MSG_PROBE, glibc MSG_PROXY.
inline constexpr int kSendProbe = MSG_PROXY;

}  // namespace palp::io
