#include "tests/bench/raw_loop.h"

#include <cstring>
#include <fstream>
#include <string>

#include <netinet/in.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <time.h>

namespace palp::bench {
namespace {

constexpr std::int64_t kPeriodNs = 1'000'000;
constexpr std::int64_t kSpinNs = 50'000;
constexpr std::int64_t kSecondNs = 1'000'000'000;

std::int64_t clock_ns(clockid_t which) {
  timespec time{};
  ::clock_gettime(which, &time);
  return time.tv_sec * kSecondNs + time.tv_nsec;
}

std::int64_t now_ns() { return clock_ns(CLOCK_MONOTONIC); }

/// As large as a telegram of the product from the patient, sealed.
struct RawTelegram {
  std::int64_t written_ns{};
  std::array<std::byte, 192> content{};
};

/// Reads all that waits.
void drain(int socket, RawTelegram& newest, RawAccount& account) {
  const std::int64_t began = now_ns();
  std::array<std::byte, 2048> bytes{};
  alignas(cmsghdr) std::array<std::byte, 128> control{};
  for (;;) {
    iovec part{bytes.data(), bytes.size()};
    msghdr header{};
    header.msg_iov = &part;
    header.msg_iovlen = 1;
    header.msg_control = control.data();
    header.msg_controllen = control.size();
    if (::recvmsg(socket, &header, MSG_DONTWAIT) < 0) return;
    std::memcpy(&newest, bytes.data(), sizeof newest);
    const std::int64_t read = now_ns();
    timespec stamp{};
    std::memcpy(&stamp, CMSG_DATA(CMSG_FIRSTHDR(&header)), sizeof stamp);
    const std::int64_t age = clock_ns(CLOCK_REALTIME) - (stamp.tv_sec * kSecondNs + stamp.tv_nsec);
    const std::int64_t arrived = now_ns() - age;
    account.latency.emplace_back(arrived - newest.written_ns + read - began);
    account.reading.emplace_back(read - began);
  }
}

}  // namespace

RawLoop::RawLoop(int socket, TimePoint first, std::size_t ticks_max) {
  account_.lateness.reserve(ticks_max);
  account_.latency.reserve(2 * ticks_max);
  account_.reading.reserve(2 * ticks_max);
  thread_ = std::jthread{
      [this, socket, first](const std::stop_token& stop) { run(stop, socket, first); }};
}

void RawLoop::run(const std::stop_token& stop, int socket, TimePoint first) {
  (void)::mlockall(MCL_CURRENT | MCL_FUTURE);
  const sched_param fifo{.sched_priority = 80};
  (void)::sched_setscheduler(0, SCHED_FIFO, &fifo);
  RawTelegram received;
  std::int64_t deadline = first.time_since_epoch().count();
  while (!stop.stop_requested() && account_.lateness.size() < account_.lateness.capacity()) {
    const std::int64_t wake = deadline - kSpinNs;
    const timespec until{wake / kSecondNs, wake % kSecondNs};
    ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
    std::int64_t now = now_ns();
    while (now < deadline) now = now_ns();
    account_.lateness.emplace_back(now - deadline);
    drain(socket, received, account_);
    RawTelegram telegram;
    telegram.written_ns = now_ns();
    std::array<std::byte, sizeof telegram> bytes{};
    std::memcpy(bytes.data(), &telegram, sizeof telegram);
    (void)::send(socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
    ++account_.ticks;
    deadline += kPeriodNs;
    for (const std::int64_t end = now_ns(); end > deadline; deadline += kPeriodNs) {
      ++account_.missed;
    }
  }
}

RawAccount RawLoop::stop() {
  thread_.request_stop();
  thread_.join();
  return std::move(account_);
}

int make_raw_socket() {
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const int on = 1;
  (void)::setsockopt(socket, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  (void)::bind(socket, reinterpret_cast<const sockaddr*>(&place), sizeof place);
  join_raw_sockets(socket, socket);
  return socket;
}

void join_raw_sockets(int one, int other) {
  for (const auto& [from, to] : {std::pair{one, other}, std::pair{other, one}}) {
    sockaddr_in place{};
    socklen_t size = sizeof place;
    (void)::getsockname(to, reinterpret_cast<sockaddr*>(&place), &size);
    (void)::connect(from, reinterpret_cast<const sockaddr*>(&place), size);
  }
}

StolenTime::Ticks StolenTime::read() {
  std::ifstream file{"/proc/stat"};
  std::string word;
  file >> word;  // "cpu": of all processors
  Ticks ticks;
  constexpr int kSteal = 7;
  for (int column = 0; column <= kSteal; ++column) {
    double count = 0;
    file >> count;
    ticks.all += count;
    if (column == kSteal) ticks.stolen = count;
  }
  return ticks;
}

double StolenTime::share() const {
  const Ticks now = read();
  const double all = now.all - before_.all;
  return all > 0 ? (now.stolen - before_.stolen) / all : 0;
}

}  // namespace palp::bench
