#include "netem/relay/relay_control.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "common/io/net/endpoint.h"
#include "common/io/process/system_text.h"
#include "netem/relay/control_token.h"

namespace palp::netem {
namespace {

constexpr std::size_t kCallersMax = 64;
constexpr std::size_t kLineMax = std::size_t{1} << 20U;  ///< [bytes]
constexpr std::size_t kStrangersLineMax = 4096;          ///< [bytes]
constexpr std::string_view kUnix = "unix:";

Result<io::Descriptor> listening(int family, const sockaddr* address, socklen_t size) {
  io::Descriptor descriptor{::socket(family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)};
  const int on = 1;
  if (family != AF_UNIX) {
    ::setsockopt(descriptor.number(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  }
  // Before it has a name, so that there is no moment when others may connect.
  if (family == AF_UNIX) ::fchmod(descriptor.number(), 0600);
  if (!descriptor.valid() || ::bind(descriptor.number(), address, size) != 0 ||
      ::listen(descriptor.number(), kCallersMax) != 0) {
    return fail_to_reach(io::system_text(errno));
  }
  return descriptor;
}

/// Whether a socket lies at `local` that nobody listens on any more: a killed program's.
bool abandoned(const sockaddr_un& local) {
  struct stat there {};
  if (::lstat(local.sun_path, &there) != 0 || !S_ISSOCK(there.st_mode)) return false;
  const io::Descriptor caller{::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)};
  return ::connect(caller.number(), reinterpret_cast<const sockaddr*>(&local), sizeof local) != 0 &&
         errno == ECONNREFUSED;
}

/// Whether who called is this program's user, or root.
bool is_owner(const io::Descriptor& caller) {
  ucred who{};
  socklen_t size = sizeof who;
  return ::getsockopt(caller.number(), SOL_SOCKET, SO_PEERCRED, &who, &size) == 0 &&
         (who.uid == ::geteuid() || who.uid == 0);
}

/// Whether a line may yet become a command.
bool may_be_command(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  return begin == std::string_view::npos || text[begin] == '{';
}

bool has_gone(const io::Descriptor& caller) {
  pollfd state{caller.number(), 0, 0};
  return ::poll(&state, 1, 0) > 0 && (state.revents & (POLLHUP | POLLERR)) != 0;
}

/// A caller that does not read loses its answers, not our time.
void tell(const io::Descriptor& caller, std::string text) {
  text += '\n';
  (void)!::send(caller.number(), text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
}

}  // namespace

RelayControl::RelayControl(io::Descriptor descriptor,
                           std::string address,
                           std::string path,
                           std::string token)
    : descriptor_{std::move(descriptor)},
      address_{std::move(address)},
      path_{std::move(path)},
      token_{std::move(token)} {
  struct stat there {};
  if (!path_.empty() && ::lstat(path_.c_str(), &there) == 0) {
    device_ = there.st_dev;
    inode_ = there.st_ino;
  }
}

RelayControl::~RelayControl() {
  if (!descriptor_.valid() || path_.empty()) return;
  // Somebody may have put a socket of his own in the place of this one.
  struct stat there {};
  if (::lstat(path_.c_str(), &there) == 0 && there.st_dev == device_ && there.st_ino == inode_) {
    ::unlink(path_.c_str());
  }
}

Result<RelayControl> RelayControl::listen(const std::string& address, std::string token) {
  if (address.starts_with(kUnix)) {
    sockaddr_un local{};
    const std::string path = address.substr(kUnix.size());
    local.sun_family = AF_UNIX;
    if (path.empty() || path.size() >= sizeof local.sun_path) {
      return fail("'" + address + "': expected unix:PATH of at most 107 characters");
    }
    std::copy(path.begin(), path.end(), local.sun_path);
    if (abandoned(local)) ::unlink(local.sun_path);
    // The sockets API takes every family through this one type.
    auto descriptor = listening(AF_UNIX, reinterpret_cast<const sockaddr*>(&local), sizeof local);
    if (!descriptor) return fail("'" + address + "'", descriptor.error());
    return RelayControl{*std::move(descriptor), address, path, {}};
  }
  const auto local = io::resolve_endpoint(address);
  if (!local) return tl::unexpected<Error>(local.error());
  if (!local->loopback()) return fail("'" + address + "' is not a loopback address");
  if (token.empty()) {
    return fail("'" + address + "' is open to every user of this machine: expected unix:PATH, or " +
                "a token beside it (--control-token FILE)");
  }
  auto descriptor = listening(local->family(), local->address(), local->size());
  if (!descriptor) return fail("'" + address + "'", descriptor.error());
  sockaddr_storage bound{};
  socklen_t size = sizeof bound;
  ::getsockname(descriptor->number(), reinterpret_cast<sockaddr*>(&bound), &size);
  return RelayControl{
      *std::move(descriptor), io::Endpoint{&bound, size}.to_string(), {}, std::move(token)};
}

void RelayControl::let_in() {
  for (std::size_t i = 0; i < kCallersMax; ++i) {
    io::Descriptor caller{
        ::accept4(descriptor_.number(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC)};
    if (!caller.valid()) return;
    if (!path_.empty() && !is_owner(caller)) continue;
    if (callers_.size() >= kCallersMax) {
      // Who has shown nothing yet makes room, the oldest first: silence keeps nobody out.
      const auto stranger = std::ranges::find(callers_, false, &Caller::known);
      if (stranger == callers_.end()) continue;
      callers_.erase(stranger);
    }
    callers_.push_back({.descriptor = std::move(caller), .text = {}, .known = !path_.empty()});
  }
}

void RelayControl::serve(const Answer& answer) {
  let_in();
  std::erase_if(callers_, [&](Caller& caller) { return !serve(caller, answer); });
}

/// @returns false: it is gone.
bool RelayControl::serve(Caller& caller, const Answer& answer) {
  std::array<char, 4096> bytes{};
  while (!caller.silent) {
    const ssize_t got =
        ::recv(caller.descriptor.number(), bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (got < 0) return errno == EAGAIN || errno == EINTR;
    caller.text.append(bytes.data(), static_cast<std::size_t>(got));
    caller.silent = got == 0;
    if (caller.silent) caller.text += '\n';
    if (!take_lines(caller, answer)) return false;
    if (caller.text.size() > (caller.known ? kLineMax : kStrangersLineMax)) return false;
  }
  return !caller.owed.empty() && !has_gone(caller.descriptor);
}

/// @returns false: what it says is no command, or it may not give any.
bool RelayControl::take_lines(Caller& caller, const Answer& answer) {
  std::size_t begin = 0;
  for (std::size_t end = caller.text.find('\n'); end != std::string::npos;
       end = caller.text.find('\n', begin)) {
    const std::string line = caller.text.substr(begin, end - begin);
    begin = end + 1;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    if (!may_be_command(line)) {
      tell(caller.descriptor, R"({"error":"a line that is no JSON object ends the connection"})");
      return false;
    }
    if (!caller.known) {
      caller.known = shows_token(line, token_);
      if (!caller.known) return false;
      tell(caller.descriptor, R"({"token":true})");
      continue;
    }
    const std::uint64_t number = ++lines_;
    if (const auto reply = answer(line, number)) {
      tell(caller.descriptor, *reply);
    } else {
      caller.owed.push_back(number);
    }
  }
  caller.text.erase(0, begin);
  return may_be_command(caller.text);
}

void RelayControl::reply(std::uint64_t number, const std::string& text) {
  for (Caller& caller : callers_) {
    if (std::erase(caller.owed, number) > 0) return tell(caller.descriptor, text);
  }
}

}  // namespace palp::netem
