// What the relay costs beside the plainest relays, alternating in one run:
//   netem_relay_bench latency|rate|hold [ROUNDS [SECONDS]]
//   netem_relay_bench trace NAME...       replays traces at their own send times
// Times are the kernel's receive stamps against the sender's clock before its send call, less the
// median of the direct way. Rounds with over 0.5 % of the machine taken by others do not count.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <poll.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "common/io/realtime/realtime.h"
#include "netem/relay/relay.h"
#include "netem/syntax/data_files.h"
#include "netem/syntax/impairment_text.h"
#include "tests/bench/raw_relays.h"

namespace palp::bench {
namespace {

constexpr std::size_t kPayload = 100;  ///< [bytes]
constexpr int kSender = 70;            ///< SCHED_FIFO
constexpr int kRelay = 60;

Duration now_on(clockid_t clock) {
  timespec time{};
  ::clock_gettime(clock, &time);
  return std::chrono::seconds{time.tv_sec} + std::chrono::nanoseconds{time.tv_nsec};
}

void sleep_until(Duration at) {
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(at);
  const timespec when{whole.count(), (at - whole).count()};
  ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &when, nullptr);
}

/// A UDP socket on loopback with the kernel's stamps and a buffer for a flood.
class Socket {
 public:
  Socket() : number_{::socket(AF_INET, SOCK_DGRAM, 0)} {
    const int buffer = 8 << 20;
    const int on = 1;
    ::setsockopt(number_, SOL_SOCKET, SO_RCVBUFFORCE, &buffer, sizeof buffer);
    ::setsockopt(number_, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
    const io::Endpoint any = *io::resolve_endpoint("127.0.0.1:0");
    ::bind(number_, any.address(), any.size());
  }
  ~Socket() { ::close(number_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  void connect(const io::Endpoint& to) const { ::connect(number_, to.address(), to.size()); }
  [[nodiscard]] int number() const { return number_; }
  [[nodiscard]] io::Endpoint local() const {
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    ::getsockname(number_, reinterpret_cast<sockaddr*>(&address), &size);
    return {&address, size};
  }

 private:
  int number_;
};

/// What arrived, by the number in front: kernel stamp - send time [us].
struct Arrivals {
  std::vector<double> taken_us;
  std::vector<Duration> stamps;  ///< the kernel's, since 1970
  std::size_t sent{};
};

struct Message {
  std::uint64_t number;
  std::int64_t sent_ns;
};

void receive(const Socket& socket, const std::atomic<bool>& stop, Arrivals& into) {
  constexpr unsigned kBatch = 64;
  static std::array<std::array<char, 256>, kBatch> bytes;
  static std::array<std::array<char, 128>, kBatch> controls;
  std::array<mmsghdr, kBatch> headers{};
  std::array<iovec, kBatch> parts{};
  while (!stop) {
    pollfd ready{socket.number(), POLLIN, 0};
    if (::poll(&ready, 1, 50) <= 0) continue;
    for (unsigned i = 0; i < kBatch; ++i) {
      parts[i] = {bytes[i].data(), bytes[i].size()};
      headers[i] = {};
      headers[i].msg_hdr.msg_iov = &parts[i];
      headers[i].msg_hdr.msg_iovlen = 1;
      headers[i].msg_hdr.msg_control = controls[i].data();
      headers[i].msg_hdr.msg_controllen = controls[i].size();
    }
    const int got = ::recvmmsg(socket.number(), headers.data(), kBatch, MSG_DONTWAIT, nullptr);
    for (int k = 0; k < got; ++k) {
      const auto i = static_cast<std::size_t>(k);
      Message message{};
      timespec stamp{};
      std::memcpy(&message, bytes[i].data(), sizeof message);
      std::memcpy(&stamp, CMSG_DATA(CMSG_FIRSTHDR(&headers[i].msg_hdr)), sizeof stamp);
      const std::int64_t at = stamp.tv_sec * 1'000'000'000 + stamp.tv_nsec;
      into.taken_us.push_back(static_cast<double>(at - message.sent_ns) * 1e-3);
      into.stamps.emplace_back(at);
    }
  }
}

/// One at each of these times after the start of `zero`.
std::size_t send_at(const Socket& socket, const netem::DelayTrace& trace, Duration zero) {
  (void)io::request_realtime(kSender, false, io::read_realtime_limits()).priority;
  std::array<char, kPayload> bytes{};
  std::size_t sent = 0;
  for (const auto& point : trace.points) {
    sleep_until(zero + point.sent);
    const Message message{sent++, now_on(CLOCK_REALTIME).count()};
    std::memcpy(bytes.data(), &message, sizeof message);
    (void)!::send(socket.number(), bytes.data(), bytes.size(), 0);
  }
  return sent;
}

/// `rate` datagrams a second, in bunches where single ones cannot be slept for.
std::size_t send_paced(const Socket& socket, double rate, Duration span) {
  const auto grant = io::request_realtime(kSender, false, io::read_realtime_limits());
  (void)grant;
  std::array<char, kPayload> bytes{};
  const std::size_t bunch = rate > 5000 ? static_cast<std::size_t>(rate / 5000) : 1;
  const Duration step = from_seconds(static_cast<double>(bunch) / rate);
  std::size_t sent = 0;
  const Duration begin = now_on(CLOCK_MONOTONIC) + std::chrono::milliseconds{5};
  for (Duration at = begin; at < begin + span; at += step) {
    sleep_until(at);
    for (std::size_t i = 0; i < bunch; ++i, ++sent) {
      const Message message{sent, now_on(CLOCK_REALTIME).count()};
      std::memcpy(bytes.data(), &message, sizeof message);
      (void)!::send(socket.number(), bytes.data(), bytes.size(), 0);
    }
  }
  return sent;
}

using Relaying = std::function<void(const Socket& in, const Socket& out, const std::atomic<bool>&)>;

/// One round: sender, relay (none: the direct way), receiver.
Arrivals round(const Relaying& relaying,
               const netem::PathPlan* plan,
               double rate,
               Duration span,
               Duration tail) {
  Socket sender;
  Socket in;
  Socket out;
  Socket sink;
  std::atomic<bool> stop{false};
  Arrivals arrivals;
  arrivals.taken_us.reserve(static_cast<std::size_t>(rate * seconds(span)) + 1000);
  out.connect(sink.local());
  std::unique_ptr<netem::Relay> product;
  std::thread relay;
  if (plan != nullptr) {
    product = std::make_unique<netem::Relay>(
        netem::RelayConfig{.listen = *io::resolve_endpoint("127.0.0.1:0"),
                           .forward = sink.local(),
                           .up = *plan,
                           .priority = kRelay});
    sender.connect(product->listening_on());
    relay = std::thread{[&] {
      while (!stop) product->serve(std::chrono::milliseconds{50});
    }};
  } else if (relaying) {
    sender.connect(in.local());
    relay = std::thread{[&] {
      (void)io::request_realtime(kRelay, false, io::read_realtime_limits()).priority;
      relaying(in, out, stop);
    }};
  } else {
    sender.connect(sink.local());
  }
  std::thread receiver{[&] { receive(sink, stop, arrivals); }};
  std::thread sending{[&] { arrivals.sent = send_paced(sender, rate, span); }};
  sending.join();
  std::this_thread::sleep_for(tail);
  stop = true;
  receiver.join();
  if (relay.joinable()) relay.join();
  return arrivals;
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

double median(const std::vector<double>& values) { return quantile(values, 0.5); }

/// Ticks of 10 ms that other guests had, and all.
std::array<double, 2> steal() {
  std::ifstream stat{"/proc/stat"};
  std::string cpu;
  stat >> cpu;
  double all = 0;
  double stolen = 0;
  for (int i = 0; i < 8; ++i) {
    double ticks = 0;
    stat >> ticks;
    all += ticks;
    if (i == 7) stolen = ticks;
  }
  return {stolen, all};
}

/// Runs `work` and says whether the round counts.
template <class Work>
bool kept(Work&& work) {
  const auto before = steal();
  work();
  const auto after = steal();
  const double share = (after[0] - before[0]) / std::max(after[1] - before[1], 1.0);
  if (share > 0.005) std::printf("  (discarded: %.1f %% stolen)\n", 100 * share);
  return share <= 0.005;
}

const Relaying kEpoll = [](const Socket& in, const Socket& out, const std::atomic<bool>& stop) {
  relay_with_epoll(in.number(), out.number(), stop);
};
const Relaying kBatches = [](const Socket& in, const Socket& out, const std::atomic<bool>& stop) {
  relay_with_batches(in.number(), out.number(), stop);
};

constexpr Duration kTail = std::chrono::milliseconds{100};

void latency(int rounds, Duration span) {
  const netem::PathPlan none;
  std::vector<double> ratios;
  for (int i = 0; i < rounds; ++i) {
    double direct = 0;
    double raw = 0;
    double ours = 0;
    double ours99 = 0;
    double raw99 = 0;
    const bool counts = kept([&] {
      direct = median(round({}, nullptr, 1000, span, kTail).taken_us);
      const auto plain = round(kEpoll, nullptr, 1000, span, kTail).taken_us;
      const auto product = round({}, &none, 1000, span, kTail).taken_us;
      raw = median(plain) - direct;
      ours = median(product) - direct;
      raw99 = quantile(plain, 0.99) - direct;
      ours99 = quantile(product, 0.99) - direct;
    });
    std::printf(
        "added by a raw epoll relay p50 %.1f p99 %.1f us, by palp-netem p50 %.1f p99 %.1f us, "
        "ratio %.2f\n",
        raw,
        raw99,
        ours,
        ours99,
        ours / raw);
    if (counts) ratios.push_back(ours / raw);
  }
  std::printf("ratio of the medians: %.2f (target 1.3), %zu of %d rounds kept\n",
              median(ratios),
              ratios.size(),
              rounds);
}

/// The highest rate of the sweep with less than 0.1 % lost.
double lossless_rate(const Relaying& relaying, const netem::PathPlan* plan, Duration span) {
  double best = 0;
  for (const double rate : {20e3, 50e3, 75e3, 100e3, 125e3, 150e3, 175e3, 200e3, 250e3, 300e3}) {
    const Arrivals arrivals = round(relaying, plan, rate, span, kTail);
    const double lost = 1 - static_cast<double>(arrivals.taken_us.size()) /
                                static_cast<double>(std::max<std::size_t>(arrivals.sent, 1));
    if (lost < 0.001) best = rate;
    if (lost > 0.05) break;
  }
  return best;
}

void rate(int rounds, Duration span) {
  const netem::PathPlan none;
  std::vector<double> ratios;
  std::vector<double> ours;
  for (int i = 0; i < rounds; ++i) {
    double plain = 0;
    double product = 0;
    const bool counts = kept([&] {
      plain = lossless_rate(kBatches, nullptr, span);
      product = lossless_rate({}, &none, span);
    });
    std::printf("without loss: raw recvmmsg relay %.0f/s, palp-netem %.0f/s, ratio %.2f\n",
                plain,
                product,
                product / plain);
    if (counts) {
      ratios.push_back(product / plain);
      ours.push_back(product);
    }
  }
  std::printf("ratio %.2f (target 0.7), palp-netem %.0f/s (target 50000), %zu of %d rounds kept\n",
              median(ratios),
              median(ours),
              ratios.size(),
              rounds);
}

std::array<double, 3> errors(const Arrivals& arrivals, double direct, double asked_us) {
  std::vector<double> off;
  for (const double taken : arrivals.taken_us) off.push_back(std::abs(taken - direct - asked_us));
  return {quantile(off, 0.5), quantile(off, 0.99), quantile(off, 0.999)};
}

void hold(int rounds, Duration span) {
  const netem::PathPlan plan{.impairment = *netem::parse_impairment("delay 50ms")};
  const Relaying timer = [](const Socket& in, const Socket& out, const std::atomic<bool>& stop) {
    hold_with_timerfd(in.number(), out.number(), std::chrono::milliseconds{50}, stop);
  };
  for (const double rate : {1000.0, 4000.0}) {
    std::array<std::vector<double>, 3> ours;
    for (int i = 0; i < rounds; ++i) {
      std::array<double, 3> product{};
      std::array<double, 3> raw{};
      const bool counts = kept([&] {
        const double direct =
            median(round({}, nullptr, rate, std::chrono::seconds{1}, kTail).taken_us);
        raw = errors(round(timer, nullptr, rate, span, kTail), direct, 50e3);
        product = errors(round({}, &plan, rate, span, kTail), direct, 50e3);
      });
      std::printf(
          "%.0f/s held for 50 ms, error p50 p99 p99.9 us: timerfd relay %.1f %.1f %.1f, "
          "palp-netem %.1f %.1f %.1f\n",
          rate,
          raw[0],
          raw[1],
          raw[2],
          product[0],
          product[1],
          product[2]);
      for (std::size_t k = 0; counts && k < 3; ++k) ours[k].push_back(product[k]);
    }
    std::printf(
        "%.0f/s: medians p50 %.1f (target 15), p99 %.1f (60), p99.9 %.1f us (500), "
        "%zu of %d rounds kept\n",
        rate,
        median(ours[0]),
        median(ours[1]),
        median(ours[2]),
        ours[0].size(),
        rounds);
  }
}

/// What the relay has decided since the last call; `epoch`: of its clock, since 1970.
void take_decisions(netem::Relay& relay, Duration epoch, std::vector<Duration>& decided) {
  netem::RecordedDecision told;
  while (relay.recording.decisions.try_dequeue(told)) {
    if (told.copies > 0) decided.push_back(told.decision.released_at.time_since_epoch() + epoch);
  }
  netem::CapturedDatagram seen;
  while (relay.recording.datagrams.try_dequeue(seen)) continue;
}

/// Whether each message of a trace comes when the trace says: from the kernel's stamp at the relay,
/// which is what its decision counts from, to the kernel's stamp at the receiver.
void replay(const std::string& name) {
  const auto text = netem::read_data_file(name);
  if (!text) return static_cast<void>(std::printf("%s\n", text.error().text.c_str()));
  const netem::DelayTrace trace = *netem::parse_delay_trace(name, *text);
  const netem::PathPlan plan{.impairment = *netem::parse_impairment("trace " + name)};
  Socket sender;
  Socket sink;
  std::atomic<bool> stop{false};
  Arrivals arrivals;
  arrivals.stamps.reserve(trace.points.size());
  netem::Relay relay{{.listen = *io::resolve_endpoint("127.0.0.1:0"),
                      .forward = sink.local(),
                      .up = plan,
                      .priority = kRelay}};
  relay.recording.wanted = true;
  std::vector<Duration> decided;  // since 1970
  decided.reserve(trace.points.size());
  const Duration epoch = now_on(CLOCK_REALTIME) - now_on(CLOCK_MONOTONIC);
  sender.connect(relay.listening_on());
  std::thread relaying{[&] {
    while (!stop) relay.serve(std::chrono::milliseconds{50});
  }};
  std::thread receiver{[&] { receive(sink, stop, arrivals); }};
  std::atomic<bool> sent{false};
  std::thread sending{[&] {
    arrivals.sent = send_at(sender, trace, relay.start().time_since_epoch());
    sent = true;
  }};
  while (!sent) {
    take_decisions(relay, epoch, decided);
    std::this_thread::sleep_for(std::chrono::seconds{1});
  }
  sending.join();
  std::this_thread::sleep_for(std::chrono::seconds{3});
  stop = true;
  receiver.join();
  relaying.join();
  take_decisions(relay, epoch, decided);
  std::vector<double> off;
  for (std::size_t i = 0; i < std::min(arrivals.stamps.size(), decided.size()); ++i)
    off.push_back(std::abs(seconds(arrivals.stamps[i] - decided[i])) * 1e6);
  std::printf(
      "%s: sent %zu, decided %zu, arrived %zu; error p50 %.1f, p99 %.1f, p99.9 "
      "%.1f us (target of p99: 60)\n",
      name.c_str(),
      arrivals.sent,
      decided.size(),
      arrivals.stamps.size(),
      quantile(off, 0.5),
      quantile(off, 0.99),
      quantile(off, 0.999));
}

}  // namespace
}  // namespace palp::bench

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 5;
  const palp::Duration span = palp::from_seconds(argc > 3 ? std::atof(argv[3]) : 3);
  if (what == "latency")
    palp::bench::latency(rounds, span);
  else if (what == "rate")
    palp::bench::rate(rounds, span);
  else if (what == "hold")
    palp::bench::hold(rounds, span);
  else if (what == "trace") {
    for (int i = 2; i < argc; ++i) palp::bench::replay(argv[i]);
  } else {
    std::fputs("netem_relay_bench latency|rate|hold [ROUNDS [SECONDS]] | trace FILE...\n", stderr);
    return 2;
  }
  return 0;
}
