#include "tests/monitor/raw_client.h"

#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace palp::monitor {

RawClient::RawClient(std::uint16_t port)
    : socket_{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)} {
  const timeval patience{5, 0};
  (void)::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  (void)::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): how sockets take addresses
  (void)::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to);
}

RawClient::RawClient(RawClient&& other) noexcept
    : socket_{std::exchange(other.socket_, -1)}, in_{std::move(other.in_)} {}

RawClient::~RawClient() {
  if (socket_ >= 0) ::close(socket_);
}

bool RawClient::say(const std::string& bytes) const {
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t now = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (now <= 0) return false;
    sent += static_cast<std::size_t>(now);
  }
  return true;
}

std::string RawClient::rest() const {
  std::string all = in_;
  char part[4096];
  for (ssize_t got = 0; (got = ::recv(socket_, part, sizeof part, 0)) > 0;) {
    all.append(part, static_cast<std::size_t>(got));
  }
  return all;
}

bool RawClient::fill(std::size_t bytes) {
  char part[4096];
  while (in_.size() < bytes) {
    const ssize_t got = ::recv(socket_, part, sizeof part, 0);
    if (got <= 0) return false;
    in_.append(part, static_cast<std::size_t>(got));
  }
  return true;
}

std::string RawClient::head() {
  std::size_t end = 0;
  while ((end = in_.find("\r\n\r\n")) == std::string::npos) {
    if (!fill(in_.size() + 1)) return {};
  }
  std::string head = in_.substr(0, end);
  in_.erase(0, end + 4);
  return head;
}

bool RawClient::say_frame(int opcode, const std::string& body) const {
  std::string frame(1, static_cast<char>(0x80 | opcode));
  const std::size_t size = body.size();
  if (size < 126) {
    frame += static_cast<char>(0x80 | size);
  } else {
    frame += static_cast<char>(0x80 | 127);
    for (int i = 7; i >= 0; --i) frame += static_cast<char>(size >> (8 * i) & 0xFF);
  }
  return say(frame + std::string(4, '\0') + body);  // masked with zeros
}

std::optional<RawClient::Frame> RawClient::frame() {
  if (!fill(2)) return std::nullopt;
  const auto byte = [this](std::size_t i) { return static_cast<unsigned char>(in_[i]); };
  std::size_t size = byte(1) & 0x7FU;
  std::size_t start = 2;
  if (size >= 126) {
    const std::size_t digits = size == 126 ? 2 : 8;
    if (!fill(2 + digits)) return std::nullopt;
    size = 0;
    for (std::size_t i = 0; i < digits; ++i) size = size << 8 | byte(2 + i);
    start += digits;
  }
  if (!fill(start + size)) return std::nullopt;
  Frame frame{byte(0) & 0xF, in_.substr(start, size)};
  in_.erase(0, start + size);
  return frame;
}

std::optional<RawClient::Frame> RawClient::message() {
  while (auto one = frame()) {
    if (one->opcode == 1 || one->opcode == 2) return one;
    if (one->opcode == 9) (void)say_frame(10, one->body);
    if (one->opcode == 8) return std::nullopt;
  }
  return std::nullopt;
}

std::string upgrade_request(std::uint16_t port,
                            const std::string& token,
                            const std::string& host,
                            const std::string& origin) {
  std::string text = "GET /?token=" + token + " HTTP/1.1\r\n";
  text += "Host: " + (host.empty() ? "127.0.0.1:" + std::to_string(port) : host) + "\r\n";
  if (!origin.empty()) text += "Origin: " + origin + "\r\n";
  return text +
         "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
         "Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n";
}

}  // namespace palp::monitor
