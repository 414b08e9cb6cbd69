#include "common/io/process/service_notice.h"

#include <array>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "common/io/process/descriptor.h"

namespace palp::io {
namespace {

/// What a manager hears on a socket without a file.
class Manager {
 public:
  Manager() {
    sockaddr_un own{};
    own.sun_family = AF_UNIX;
    std::copy(name_.begin() + 1, name_.end(), own.sun_path + 1);
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name_.size());
    EXPECT_EQ(::bind(socket_.number(), reinterpret_cast<const sockaddr*>(&own), size), 0);
  }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::string heard() const {
    std::array<char, 64> bytes{};
    const ssize_t size = ::recv(socket_.number(), bytes.data(), bytes.size(), MSG_DONTWAIT);
    return size < 0 ? "" : std::string(bytes.data(), static_cast<std::size_t>(size));
  }

 private:
  std::string name_{"@palp-notice-test-" + std::to_string(::getpid())};
  Descriptor socket_{::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
};

TEST(ServiceNoticeTest, TheWatchdogIsFedByTicksAlone) {
  const Manager manager;
  ServiceNotice notice{manager.name()};
  notice.ready();
  EXPECT_EQ(manager.heard(), "READY=1");
  notice.progress(5);
  EXPECT_EQ(manager.heard(), "WATCHDOG=1");
  notice.progress(5);
  EXPECT_EQ(manager.heard(), "") << "the loop stood still";
  notice.progress(6);
  EXPECT_EQ(manager.heard(), "WATCHDOG=1");
  notice.stopping();
  EXPECT_EQ(manager.heard(), "STOPPING=1");
}

TEST(ServiceNoticeTest, WithoutAManagerNothingHappens) {
  ServiceNotice nobody{std::string{}};
  nobody.ready();
  ServiceNotice gone{"/nowhere/at/all"};
  gone.progress(1);
  ServiceNotice too_long{std::string(300, 'x')};
  too_long.stopping();
}

}  // namespace
}  // namespace palp::io
