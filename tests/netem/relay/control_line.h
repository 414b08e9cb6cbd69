#pragma once

#include <string>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "common/io/net/endpoint.h"
#include "netem/relay/relay_control.h"
#include "tests/netem/model/datagrams.h"

namespace palp::netem {

/// A caller of a control socket at a loopback address.
class Call {
 public:
  explicit Call(const std::string& address) {
    const auto to = io::resolve_endpoint(address);
    caller_ = io::Descriptor{::socket(to->family(), SOCK_STREAM, 0)};
    EXPECT_EQ(::connect(caller_.number(), to->address(), to->size()), 0) << address;
  }
  /// `last`: nothing more will be said.
  void say(const std::string& text, bool last = false) const {
    EXPECT_EQ(::send(caller_.number(), text.data(), text.size(), 0),
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
      if (::recv(caller_.number(), &byte, 1, MSG_DONTWAIT) == 1) reply += byte;
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
