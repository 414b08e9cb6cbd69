// What palp-relay adds beside the plainest relay of two addresses, alternating in one run:
//   relay_bench PALP_RELAY [ROUNDS [SECONDS]]
// Times are the kernel's receive stamps against the sender's clock before its send call, less the
// median of the direct way. Both relays are processes that wait with poll, without real-time
// priority.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "common/io/net/endpoint.h"
#include "common/io/secure/relay_member.h"

namespace palp::bench {
namespace {

using io::Endpoint;

constexpr std::size_t kPayload = 140;  ///< [bytes]
constexpr int kRate = 1000;            ///< [1/s]
constexpr int kWaitMs = 20;            ///< [ms] of one look

std::int64_t real_now_ns() {
  timespec time{};
  ::clock_gettime(CLOCK_REALTIME, &time);
  return time.tv_sec * 1'000'000'000 + time.tv_nsec;
}

/// A UDP socket on loopback with the kernel's stamps.
class Port {
 public:
  Port() : number_{::socket(AF_INET, SOCK_DGRAM, 0)} {
    const int on = 1;
    ::setsockopt(number_, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
    const Endpoint any = *io::resolve_endpoint("127.0.0.1:0");
    if (::bind(number_, any.address(), any.size()) != 0) std::abort();
  }
  ~Port() { ::close(number_); }
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  [[nodiscard]] Endpoint local() const {
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    ::getsockname(number_, reinterpret_cast<sockaddr*>(&address), &size);
    return {&address, size};
  }
  void send(std::span<const std::byte> bytes, const Endpoint& to) const {
    (void)!::sendto(number_, bytes.data(), bytes.size(), 0, to.address(), to.size());
  }
  struct Heard {
    std::vector<std::byte> bytes;
    std::int64_t at_ns{};
    Endpoint from;
  };
  [[nodiscard]] std::optional<Heard> receive() const {
    pollfd ready{number_, POLLIN, 0};
    if (::poll(&ready, 1, kWaitMs) <= 0) return std::nullopt;
    Heard heard{std::vector<std::byte>(2048), 0, {}};
    std::array<char, 128> control{};
    sockaddr_storage from{};
    iovec part{heard.bytes.data(), heard.bytes.size()};
    msghdr header{};
    header.msg_name = &from;
    header.msg_namelen = sizeof from;
    header.msg_iov = &part;
    header.msg_iovlen = 1;
    header.msg_control = control.data();
    header.msg_controllen = control.size();
    const ssize_t got = ::recvmsg(number_, &header, MSG_DONTWAIT);
    const cmsghdr* told = CMSG_FIRSTHDR(&header);
    if (got < 0 || told == nullptr) return std::nullopt;
    heard.bytes.resize(static_cast<std::size_t>(got));
    timespec stamp{};
    std::memcpy(&stamp, CMSG_DATA(told), sizeof stamp);
    heard.at_ns = stamp.tv_sec * 1'000'000'000 + stamp.tv_nsec;
    heard.from = {&from, header.msg_namelen};
    return heard;
  }
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

/// A process, as palp-relay is one: what comes from one of two addresses goes to the other, until
/// it is killed.
pid_t relay_plainly(int port, const Endpoint& one, const Endpoint& other) {
  const pid_t process = ::fork();
  if (process != 0) return process;
  std::array<char, 2048> bytes{};
  while (true) {
    pollfd ready{port, POLLIN, 0};
    if (::poll(&ready, 1, kWaitMs) <= 0) continue;
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    const ssize_t got = ::recvfrom(port,
                                   bytes.data(),
                                   bytes.size(),
                                   MSG_DONTWAIT,
                                   reinterpret_cast<sockaddr*>(&address),
                                   &size);
    if (got < 0) continue;
    const Endpoint& to = Endpoint{&address, size} == one ? other : one;
    (void)!::sendto(
        port, bytes.data(), static_cast<std::size_t>(got), MSG_DONTWAIT, to.address(), to.size());
  }
}

/// palp-relay as a process; stopped at the end.
class Product {
 public:
  explicit Product(const char* program) {
    std::array<int, 2> pipe{};
    if (::pipe(pipe.data()) != 0) std::abort();
    process_ = ::fork();
    if (process_ == 0) {
      ::dup2(pipe[1], STDOUT_FILENO);
      ::execl(program, "palp-relay", "--listen", "127.0.0.1:0", static_cast<char*>(nullptr));
      std::_Exit(3);
    }
    ::close(pipe[1]);
    std::FILE* said = ::fdopen(pipe[0], "r");
    std::array<char, 128> where{};
    if (std::fscanf(said, "listening on %127s", where.data()) != 1) {
      std::fputs("relay_bench: the relay does not listen\n", stderr);
      std::exit(3);
    }
    address_ = *io::resolve_endpoint(where.data());
  }
  ~Product() {
    ::kill(process_, SIGINT);
    ::waitpid(process_, nullptr, 0);
  }
  Product(const Product&) = delete;
  Product& operator=(const Product&) = delete;
  [[nodiscard]] const Endpoint& address() const { return address_; }

 private:
  pid_t process_{};
  Endpoint address_;
};

void enter(const Port& port, link::Role role, const Endpoint& relay) {
  io::RelayMember member{io::RoomKey::from_name("K7Q2-of-a-bench-only").value(),
                         role,
                         relay,
                         static_cast<std::uint64_t>(real_now_ns())};
  const TimePoint now{std::chrono::seconds{1}};
  port.send(*member.tick(now, io::RelayMember::SessionIs::Silent), relay);
  for (int answers = 0; answers < 2;) {  // a cookie, and that the seat is taken
    const auto heard = port.receive();
    if (!heard) continue;
    ++answers;
    if (const auto reply = member.hear(heard->bytes, relay, now)) port.send(*reply, relay);
  }
}

/// What each datagram took from one port to the other by way of `to` [us], sorted.
std::vector<double> round(const Port& from, const Port& sink, const Endpoint& to, Duration span) {
  std::atomic<bool> stop{false};
  std::vector<double> taken_us;
  std::thread receiver{[&] {
    while (!stop) {
      const auto heard = sink.receive();
      if (!heard || heard->bytes.size() != kPayload) continue;
      std::int64_t sent_ns = 0;
      std::memcpy(&sent_ns, heard->bytes.data() + 8, sizeof sent_ns);
      taken_us.push_back(static_cast<double>(heard->at_ns - sent_ns) * 1e-3);
    }
  }};
  std::array<std::byte, kPayload> bytes{};
  bytes[0] = std::byte{0x80};
  const auto count = static_cast<int>(seconds(span) * kRate);
  for (int i = 0; i < count; ++i) {
    std::this_thread::sleep_for(std::chrono::microseconds{1'000'000 / kRate});
    const std::int64_t now_ns = real_now_ns();
    std::memcpy(bytes.data() + 8, &now_ns, sizeof now_ns);
    from.send(bytes, to);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds{50});
  stop = true;
  receiver.join();
  std::ranges::sort(taken_us);
  return taken_us;
}

double quantile(const std::vector<double>& sorted, double q) {
  if (sorted.empty()) return 0;
  return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
}

void compare(const char* program, int rounds, Duration span) {
  std::vector<double> ratios;
  for (int i = 0; i < rounds; ++i) {
    const Port surgeon;
    const Port patient;
    const Port between;
    const Product product{program};
    enter(surgeon, link::Role::Surgeon, product.address());
    enter(patient, link::Role::Patient, product.address());
    const double direct = quantile(round(surgeon, patient, patient.local(), span), 0.5);
    const pid_t plain = relay_plainly(between.number(), surgeon.local(), patient.local());
    const auto raw = round(surgeon, patient, between.local(), span);
    ::kill(plain, SIGKILL);
    ::waitpid(plain, nullptr, 0);
    const auto ours = round(surgeon, patient, product.address(), span);
    ratios.push_back((quantile(ours, 0.5) - direct) / (quantile(raw, 0.5) - direct));
    std::printf(
        "added by a plain relay p50 %.1f p99 %.1f us, by palp-relay p50 %.1f p99 %.1f us, "
        "ratio %.2f\n",
        quantile(raw, 0.5) - direct,
        quantile(raw, 0.99) - direct,
        quantile(ours, 0.5) - direct,
        quantile(ours, 0.99) - direct,
        ratios.back());
  }
  std::ranges::sort(ratios);
  std::printf(
      "ratio of the medians: %.2f (target 1.3), %d rounds\n", quantile(ratios, 0.5), rounds);
}

}  // namespace
}  // namespace palp::bench

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("relay_bench PALP_RELAY [ROUNDS [SECONDS]]\n", stderr);
    return 2;
  }
  palp::bench::compare(argv[1],
                       argc > 2 ? std::atoi(argv[2]) : 5,
                       palp::from_seconds(argc > 3 ? std::atof(argv[3]) : 2));
  return 0;
}
