#include "study/real_sites/relay_line.h"

#include <array>
#include <cstring>
#include <utility>

#include <sys/socket.h>
#include <sys/un.h>

#include "common/config/json.h"
#include "common/core/formatted.h"

namespace palp::study {
namespace {

using config::Json;

constexpr double kRamp = 1;  // [s]: a step would be a gap in what arrives

}  // namespace

Result<RelayLine> RelayLine::connect(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) return fail_to_reach(path + " is too long a name");
  std::memcpy(static_cast<char*>(address.sun_path), path.c_str(), path.size());
  io::Descriptor socket{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)};
  const auto* const to = reinterpret_cast<const sockaddr*>(&address);
  if (::connect(socket.number(), to, sizeof address) != 0) {
    return fail_to_reach("the relay's control " + path + " does not answer");
  }
  return RelayLine{std::move(socket)};
}

bool RelayLine::delay(double milliseconds) {
  const Json ramp{{"over_s", kRamp}, {"set", formatted("delay %.6gms", milliseconds)}};
  const std::string line = Json{{"dir", "DOWN"}, {"ramp", ramp}}.dump() + "\n";
  // What it answered before is not needed, but would fill the way.
  std::array<char, 4096> answers{};
  while (::recv(socket_.number(), answers.data(), answers.size(), 0) > 0) {
  }
  return ::send(socket_.number(), line.data(), line.size(), MSG_NOSIGNAL) ==
         static_cast<ssize_t>(line.size());
}

}  // namespace palp::study
