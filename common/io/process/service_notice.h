#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace palp::io {

/// What a service tells the manager that started it (sd_notify(3)): one datagram to the socket
/// named in NOTIFY_SOCKET. Without a manager nothing happens. Thread: its maker's, never rt.
class ServiceNotice {
 public:
  /// Reads the environment; before other threads.
  ServiceNotice();
  explicit ServiceNotice(std::string socket) : socket_{std::move(socket)} {}

  /// Works now; once.
  void ready();
  /// Often, with the number of finished ticks: the watchdog is fed only where there are new ones,
  /// so a control loop that stands still ends the service, whatever else goes on.
  void progress(std::uint64_t ticks);
  void stopping();

 private:
  void say(std::string_view text) const noexcept;

  std::string socket_;  ///< empty: nobody listens
  std::uint64_t ticks_{};
};

}  // namespace palp::io
