#include "netem/relay_control.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "common/io/endpoint.h"
#include "common/io/system_text.h"

namespace palp::netem {
namespace {

constexpr std::size_t kCallersMax = 8;
constexpr std::size_t kLineMax = std::size_t{1} << 20U;  ///< [bytes]
constexpr std::string_view kUnix = "unix:";

Result<io::Descriptor> listening(int family, const sockaddr* address, socklen_t size) {
  io::Descriptor descriptor{::socket(family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)};
  const int on = 1;
  if (family != AF_UNIX) {
    ::setsockopt(descriptor.number(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  }
  if (!descriptor.valid() || ::bind(descriptor.number(), address, size) != 0 ||
      ::listen(descriptor.number(), kCallersMax) != 0) {
    return fail(io::system_text(errno));
  }
  return descriptor;
}

}  // namespace

RelayControl::RelayControl(io::Descriptor descriptor, std::string address, std::string path)
    : descriptor_{std::move(descriptor)}, address_{std::move(address)}, path_{std::move(path)} {}

RelayControl::~RelayControl() {
  if (descriptor_.valid() && !path_.empty()) ::unlink(path_.c_str());
}

Result<RelayControl> RelayControl::listen(const std::string& address) {
  if (address.starts_with(kUnix)) {
    sockaddr_un local{};
    const std::string path = address.substr(kUnix.size());
    local.sun_family = AF_UNIX;
    if (path.empty() || path.size() >= sizeof local.sun_path) {
      return fail("'" + address + "': expected unix:PATH of at most 107 characters");
    }
    std::copy(path.begin(), path.end(), local.sun_path);
    // The sockets API takes every family through this one type.
    auto descriptor = listening(AF_UNIX, reinterpret_cast<const sockaddr*>(&local), sizeof local);
    if (!descriptor) return fail("'" + address + "': " + descriptor.error().text);
    return RelayControl{*std::move(descriptor), address, path};
  }
  const auto local = io::resolve_endpoint(address);
  if (!local) return tl::unexpected<Error>(local.error());
  if (!local->loopback()) return fail("'" + address + "' is not a loopback address");
  auto descriptor = listening(local->family(), local->address(), local->size());
  if (!descriptor) return fail("'" + address + "': " + descriptor.error().text);
  sockaddr_storage bound{};
  socklen_t size = sizeof bound;
  ::getsockname(descriptor->number(), reinterpret_cast<sockaddr*>(&bound), &size);
  return RelayControl{*std::move(descriptor), io::Endpoint{&bound, size}.to_string(), {}};
}

void RelayControl::serve(const Answer& answer) {
  while (callers_.size() < kCallersMax) {
    io::Descriptor caller{
        ::accept4(descriptor_.number(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC)};
    if (!caller.valid()) break;
    callers_.push_back({std::move(caller), {}});
  }
  std::erase_if(callers_, [&](Caller& caller) { return !serve(caller, answer); });
}

/// @returns false: it is gone.
bool RelayControl::serve(Caller& caller, const Answer& answer) {
  std::array<char, 4096> bytes{};
  for (;;) {
    const ssize_t got =
        ::recv(caller.descriptor.number(), bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (got < 0) return errno == EAGAIN || errno == EINTR;
    caller.text.append(bytes.data(), static_cast<std::size_t>(got));
    for (std::size_t end = caller.text.find('\n'); end != std::string::npos;
         end = caller.text.find('\n')) {
      std::string line = caller.text.substr(0, end);
      caller.text.erase(0, end + 1);
      if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
      const std::string reply = answer(line) + '\n';
      // A caller that does not read loses its answers, not our time.
      (void)!::send(
          caller.descriptor.number(), reply.data(), reply.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    }
    if (got == 0 || caller.text.size() > kLineMax) return false;
  }
}

}  // namespace palp::netem
