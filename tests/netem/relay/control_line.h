#pragma once

#include <cerrno>
#include <string>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "common/io/net/endpoint.h"
#include "netem/relay/relay_control.h"
#include "tests/netem/model/datagrams.h"

namespace palp::netem {

/// A caller of a control socket, by its `unix:PATH` or loopback address.
class Call {
 public:
  explicit Call(const std::string& address) {
    if (address.starts_with("unix:")) {
      sockaddr_un local{};
      local.sun_family = AF_UNIX;
      address.copy(local.sun_path, sizeof local.sun_path - 1, 5);
      caller_ = io::Descriptor{::socket(AF_UNIX, SOCK_STREAM, 0)};
      // The sockets API takes every family through this one type.
      const auto* to = reinterpret_cast<const sockaddr*>(&local);
      EXPECT_EQ(::connect(caller_.number(), to, sizeof local), 0) << address;
      return;
    }
    const auto to = io::resolve_endpoint(address);
    caller_ = io::Descriptor{::socket(to->family(), SOCK_STREAM, 0)};
    EXPECT_EQ(::connect(caller_.number(), to->address(), to->size()), 0) << address;
  }
  [[nodiscard]] int number() const noexcept { return caller_.number(); }
  /// `last`: nothing more will be said.
  void say(const std::string& text, bool last = false) const {
    EXPECT_EQ(::send(caller_.number(), text.data(), text.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(text.size()));
    if (last) ::shutdown(caller_.number(), SHUT_WR);
  }
  /// The next line that comes back; `turn` lets the other side work, if it needs this thread.
  template <class Turn>
  std::string hear_while(Turn&& turn) const {
    std::string reply;
    const TimePoint until = monotonic_now() + kDeadline;
    while (!reply.ends_with('\n') && monotonic_now() < until) {
      turn();
      char byte = 0;
      const ssize_t got = ::recv(caller_.number(), &byte, 1, MSG_DONTWAIT);
      if (got == 1) reply += byte;
      if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) break;  // it has hung up
    }
    return reply;
  }
  std::string hear() const {
    return hear_while([] {});
  }
  std::string hear(RelayControl& control, const RelayControl::Answer& answer) const {
    return hear_while([&] { control.serve(answer); });
  }

 private:
  io::Descriptor caller_;
};

/// One line, and the line that comes back.
inline std::string ask(const std::string& address,
                       const std::string& line,
                       RelayControl* serve = nullptr,
                       const RelayControl::Answer& answer = {}) {
  const Call call{address};
  call.say(line + '\n');
  return serve != nullptr ? call.hear(*serve, answer) : call.hear();
}

}  // namespace palp::netem
