#include "common/io/process/service_notice.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>

#include <sys/socket.h>
#include <sys/un.h>

#include "common/io/process/descriptor.h"

namespace palp::io {

ServiceNotice::ServiceNotice() {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): before other threads
  const char* const named = std::getenv("NOTIFY_SOCKET");
  if (named != nullptr) socket_ = named;
}

void ServiceNotice::ready() { say("READY=1"); }

void ServiceNotice::progress(std::uint64_t ticks) {
  if (ticks == ticks_) return;
  ticks_ = ticks;
  say("WATCHDOG=1");
}

void ServiceNotice::stopping() { say("STOPPING=1"); }

void ServiceNotice::say(std::string_view text) const noexcept {
  sockaddr_un to{};
  if (socket_.empty() || socket_.size() >= sizeof to.sun_path) return;
  to.sun_family = AF_UNIX;
  std::ranges::copy(socket_, std::begin(to.sun_path));
  if (to.sun_path[0] == '@') to.sun_path[0] = '\0';  // a name without a file
  const Descriptor socket{::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  const std::size_t size = offsetof(sockaddr_un, sun_path) + socket_.size();
  // A manager that does not listen is no reason to do anything else.
  (void)::sendto(socket.number(),
                 text.data(),
                 text.size(),
                 MSG_NOSIGNAL | MSG_DONTWAIT,
                 reinterpret_cast<const sockaddr*>(&to),
                 static_cast<socklen_t>(size));
}

}  // namespace palp::io
