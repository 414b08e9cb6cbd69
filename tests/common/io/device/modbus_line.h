#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <stdlib.h>  // NOLINT(modernize-deprecated-headers): of the system's own
#include <unistd.h>

#include "common/io/device/modbus_port.h"

namespace palp::io {

using Bytes = std::vector<std::uint8_t>;

inline Bytes bytes_of(std::string_view hex) {
  Bytes bytes;
  std::string digits;
  for (const char c : hex) {
    if (c == ' ') continue;
    digits += c;
    if (digits.size() == 2) {
      bytes.push_back(static_cast<std::uint8_t>(std::stoul(digits, nullptr, 16)));
      digits.clear();
    }
  }
  return bytes;
}

/// The far end of a pseudo-terminal: hears one request of a known length and answers as told.
class Line {
 public:
  Line() : master_{::posix_openpt(O_RDWR | O_NOCTTY)} {
    EXPECT_GE(master_, 0);
    EXPECT_EQ(::grantpt(master_), 0);
    EXPECT_EQ(::unlockpt(master_), 0);
    std::array<char, 64> name{};
    EXPECT_EQ(::ptsname_r(master_, name.data(), name.size()), 0);
    address_.line = name.data();
  }
  ~Line() { hang_up(); }
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;

  [[nodiscard]] const ModbusAddress& address() const { return address_; }
  void hang_up() {
    if (master_ >= 0) ::close(master_);
    master_ = -1;
  }
  void say(const Bytes& bytes) const {
    EXPECT_EQ(::write(master_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  /// What was asked while `call` ran; answered with `reply`.
  Bytes hear(std::size_t length, const Bytes& reply, const std::function<void()>& call) const {
    Bytes heard;
    std::jthread far_end{[&] {
      while (heard.size() < length) {
        pollfd one{.fd = master_, .events = POLLIN, .revents = 0};
        if (::poll(&one, 1, 5000) <= 0) return;
        std::array<std::uint8_t, 256> buffer{};
        const auto count = ::read(master_, buffer.data(), length - heard.size());
        if (count <= 0) return;
        heard.insert(heard.end(), buffer.begin(), buffer.begin() + count);
      }
      EXPECT_EQ(::write(master_, reply.data(), reply.size()), static_cast<ssize_t>(reply.size()));
    }};
    call();
    far_end.join();
    return heard;
  }

 private:
  int master_;
  ModbusAddress address_;
};

}  // namespace palp::io
