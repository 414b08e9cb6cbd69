#include "common/io/process/message_pipe.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>

#include "common/io/process/system_text.h"

namespace palp::io {

Result<std::pair<MessagePipe, MessagePipe>> MessagePipe::make() {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return fail_to_reach("no pipe for messages: " + system_text(errno));
  }
  return std::pair{MessagePipe{Descriptor{ends[0]}}, MessagePipe{Descriptor{ends[1]}}};
}

Result<MessagePipe> MessagePipe::adopt(int number) {
  int type = 0;
  socklen_t size = sizeof type;
  if (::getsockopt(number, SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type != SOCK_SEQPACKET) {
    return fail("descriptor " + std::to_string(number) + " is no pipe for messages");
  }
  (void)::fcntl(number, F_SETFD, FD_CLOEXEC);
  return MessagePipe{Descriptor{number}};
}

bool MessagePipe::send(std::string_view message) noexcept {
  if (message.empty()) return false;  // it would arrive like an end that is gone
  const ssize_t sent =
      ::send(descriptor_.number(), message.data(), message.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  return sent == static_cast<ssize_t>(message.size());
}

std::optional<std::string> MessagePipe::receive() {
  std::array<char, kMessageMax> bytes{};
  const ssize_t got = ::recv(descriptor_.number(), bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (got > 0) return std::string{bytes.data(), static_cast<std::size_t>(got)};
  if (got == 0 || (errno != EAGAIN && errno != EINTR)) open_ = false;
  return std::nullopt;
}

void MessagePipe::wait(Duration span) const noexcept {
  pollfd waiting{.fd = descriptor_.number(), .events = POLLIN, .revents = 0};
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(span).count();
  (void)::poll(&waiting, 1, static_cast<int>(std::clamp<std::int64_t>(ms, 0, 60'000)));
}

}  // namespace palp::io
