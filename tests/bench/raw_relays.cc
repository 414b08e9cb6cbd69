#include "tests/bench/raw_relays.h"

#include <array>
#include <cstring>
#include <deque>
#include <string>

#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/timerfd.h>
#include <time.h>
#include <unistd.h>

namespace palp::bench {
namespace {

constexpr int kWaitMs = 50;  ///< how often `stop` is looked at
constexpr unsigned kBatch = 64;

int watching(int descriptor, int other = -1) {
  const int watch = ::epoll_create1(0);
  for (const int one : {descriptor, other}) {
    if (one < 0) continue;
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.fd = one;
    ::epoll_ctl(watch, EPOLL_CTL_ADD, one, &event);
  }
  return watch;
}

}  // namespace

void relay_with_epoll(int in, int out, const std::atomic<bool>& stop) {
  const int watch = watching(in);
  std::array<char, 2048> bytes{};
  epoll_event event{};
  while (!stop) {
    if (::epoll_wait(watch, &event, 1, kWaitMs) <= 0) continue;
    for (;;) {
      const ssize_t got = ::recv(in, bytes.data(), bytes.size(), MSG_DONTWAIT);
      if (got < 0) break;
      (void)!::send(out, bytes.data(), static_cast<std::size_t>(got), MSG_DONTWAIT);
    }
  }
  ::close(watch);
}

void relay_with_batches(int in, int out, const std::atomic<bool>& stop) {
  const int watch = watching(in);
  static std::array<std::array<char, 2048>, kBatch> bytes;
  std::array<mmsghdr, kBatch> headers{};
  std::array<iovec, kBatch> parts{};
  epoll_event event{};
  while (!stop) {
    if (::epoll_wait(watch, &event, 1, kWaitMs) <= 0) continue;
    for (;;) {
      for (unsigned i = 0; i < kBatch; ++i) {
        parts[i] = {bytes[i].data(), bytes[i].size()};
        headers[i] = {};
        headers[i].msg_hdr.msg_iov = &parts[i];
        headers[i].msg_hdr.msg_iovlen = 1;
      }
      const int got = ::recvmmsg(in, headers.data(), kBatch, MSG_DONTWAIT, nullptr);
      if (got <= 0) break;
      for (int i = 0; i < got; ++i) {
        const auto at = static_cast<std::size_t>(i);
        parts[at].iov_len = headers[at].msg_len;
      }
      (void)!::sendmmsg(out, headers.data(), static_cast<unsigned>(got), MSG_DONTWAIT);
    }
  }
  ::close(watch);
}

void hold_with_timerfd(int in, int out, Duration delay, const std::atomic<bool>& stop) {
  struct Held {
    Duration due;
    std::string bytes;
  };
  const int timer = ::timerfd_create(CLOCK_REALTIME, TFD_NONBLOCK);
  const int watch = watching(in, timer);
  std::deque<Held> line;
  std::array<char, 2048> bytes{};
  alignas(cmsghdr) std::array<char, 128> control{};
  const auto arm = [&] {
    const auto whole = std::chrono::duration_cast<std::chrono::seconds>(line.front().due);
    itimerspec when{};
    when.it_value = {whole.count(), (line.front().due - whole).count()};
    ::timerfd_settime(timer, TFD_TIMER_ABSTIME, &when, nullptr);
  };
  epoll_event event{};
  while (!stop) {
    if (::epoll_wait(watch, &event, 1, kWaitMs) <= 0) continue;
    if (event.data.fd == in) {
      iovec part{bytes.data(), bytes.size()};
      msghdr header{};
      header.msg_iov = &part;
      header.msg_iovlen = 1;
      header.msg_control = control.data();
      header.msg_controllen = control.size();
      const ssize_t got = ::recvmsg(in, &header, MSG_DONTWAIT);
      if (got < 0) continue;
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(CMSG_FIRSTHDR(&header)), sizeof stamp);
      const Duration at =
          std::chrono::seconds{stamp.tv_sec} + std::chrono::nanoseconds{stamp.tv_nsec};
      line.push_back({at + delay, std::string{bytes.data(), static_cast<std::size_t>(got)}});
      if (line.size() == 1) arm();
      continue;
    }
    timespec clock{};
    ::clock_gettime(CLOCK_REALTIME, &clock);
    const Duration now =
        std::chrono::seconds{clock.tv_sec} + std::chrono::nanoseconds{clock.tv_nsec};
    std::uint64_t rung = 0;
    (void)!::read(timer, &rung, sizeof rung);
    while (!line.empty() && line.front().due <= now) {
      (void)!::send(out, line.front().bytes.data(), line.front().bytes.size(), MSG_DONTWAIT);
      line.pop_front();
    }
    if (!line.empty()) arm();
  }
  ::close(timer);
  ::close(watch);
}

}  // namespace palp::bench
