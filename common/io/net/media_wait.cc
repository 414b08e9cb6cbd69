#include "common/io/net/media_wait.h"

#include <algorithm>

#include <poll.h>
#include <time.h>

namespace palp::io {

void wait_for_datagram(int socket, Duration span) noexcept {
  const Duration rest = std::max(span, Duration{0});
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(rest);
  const timespec limit{.tv_sec = whole.count(), .tv_nsec = (rest - whole).count()};
  pollfd watched{.fd = socket, .events = POLLIN, .revents = 0};  // below 0 is left out
  (void)::ppoll(&watched, 1, &limit, nullptr);
}

}  // namespace palp::io
