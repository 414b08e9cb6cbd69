#pragma once

#include <string>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "common/io/endpoint.h"
#include "netem/relay_control.h"
#include "tests/netem/datagrams.h"

namespace palp::netem {

/// One line to a control socket at a loopback address, and the line that comes back.
inline std::string ask(const std::string& address,
                       const std::string& line,
                       RelayControl* serve = nullptr,
                       const RelayControl::Answer& answer = {}) {
  const auto to = io::resolve_endpoint(address);
  const int caller = ::socket(to->family(), SOCK_STREAM, 0);
  if (::connect(caller, to->address(), to->size()) != 0) return "cannot connect";
  const std::string text = line + '\n';
  EXPECT_EQ(::send(caller, text.data(), text.size(), 0), static_cast<ssize_t>(text.size()));
  std::string reply;
  const TimePoint until = monotonic_now() + kDeadline;
  while (reply.find('\n') == std::string::npos && monotonic_now() < until) {
    if (serve != nullptr) serve->serve(answer);
    char byte = 0;
    if (::recv(caller, &byte, 1, MSG_DONTWAIT) == 1) reply += byte;
  }
  ::close(caller);
  return reply;
}

}  // namespace palp::netem
