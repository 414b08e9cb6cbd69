// What security costs and stands, with numbers:
//   security_bench cost               ns to seal and open a telegram; bytes it adds
//   security_bench handshakes N L R [SEED]   N handshakes, loss L (share), round trip R (ms)
//   security_bench flood S            each kind of junk for S seconds at 100,000/s, from the peer's
//                                     own address, beside a 1 kHz session of two sites and a raw
//                                     loop of the same rate and priority
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <sys/resource.h>
#include <unistd.h>

#include "common/core/random.h"
#include "common/io/process/process_time.h"
#include "common/io/realtime/steady_clock.h"
#include "common/io/secure/associations.h"
#include "common/link/aead_protection.h"
#include "tests/bench/raw_loop.h"
#include "tests/bench/secure_site.h"
#include "tests/common/io/net/loopback.h"
#include "tests/common/io/secure/keys_folder.h"
#include "tests/common/link/some_keys.h"
#include "tests/common/link/whole_open.h"

namespace palp::bench {
namespace {

using io::Endpoint;
using link::Role;
using std::chrono::milliseconds;

double ms(Duration span) { return seconds(span) * 1e3; }

long resident_kb() {
  std::ifstream file{"/proc/self/statm"};
  long total = 0;
  long resident = 0;
  file >> total >> resident;
  return resident * (sysconf(_SC_PAGESIZE) / 1024);
}

int cost() {
  link::AeadProtection surgeon{link::some_keys(1, Role::Surgeon).data};
  link::AeadProtection patient{link::some_keys(1, Role::Patient).data};
  link::PlainProtection plain_protection;
  const std::array<std::byte, 140> plain{};
  std::array<std::byte, link::kDatagramSizeMax> datagram{};
  std::array<std::byte, link::kDatagramSizeMax> room{};
  const io::SteadyClock clock;
  constexpr std::uint64_t kCount = 1'000'000;
  const auto per_packet = [&](TimePoint began) {
    return seconds(clock.now() - began) * 1e9 / static_cast<double>(kCount);
  };
  std::size_t size = 0;
  TimePoint began = clock.now();
  for (std::uint64_t n = 0; n < kCount; ++n) {
    size = surgeon.seal({.connection = 1, .number = n}, plain, datagram);
  }
  const double sealing = per_packet(began);
  began = clock.now();
  for (std::uint64_t n = 0; n < kCount; ++n)
    (void)link::whole_open(patient, std::span{datagram}.first(size), room);
  const double opening = per_packet(began);
  datagram[30] ^= std::byte{1};
  began = clock.now();
  for (std::uint64_t n = 0; n < kCount; ++n)
    (void)link::whole_open(patient, std::span{datagram}.first(size), room);
  const double refusing = per_packet(began);
  std::printf("seal %.0f ns, open %.0f ns, refuse a forged one %.0f ns (140 B); %zu B added\n",
              sealing,
              opening,
              refusing,
              size - plain.size());
  return 0;
}

/// What a stranger's first word costs the patient.
int hellos() {
  const io::test::KeysFolder keys{"hellos"};
  const auto surgeon_keys = keys.credentials(Role::Surgeon);
  const auto patient_keys = keys.credentials(Role::Patient);
  io::DtlsHandshake caller{*surgeon_keys};
  io::DtlsListener listener{*patient_keys};
  const io::DtlsDatagram hello = caller.take_datagrams().at(0);
  const Endpoint from = *io::resolve_endpoint("127.0.0.1:1000");
  const io::SteadyClock clock;
  constexpr int kCount = 100'000;
  const long memory = resident_kb();
  std::size_t bytes = 0;
  const TimePoint began = clock.now();
  for (int i = 0; i < kCount; ++i) {
    for (const auto& one : listener.hear(hello, from, began).datagrams) bytes += one.size();
  }
  std::printf("a ClientHello without cookie: %.2f us, %zu B answered by %zu B, RSS +%ld kB\n",
              seconds(clock.now() - began) * 1e6 / kCount,
              hello.size(),
              bytes / kCount,
              resident_kb() - memory);
  return 0;
}

struct HandshakePath {
  double loss{};  ///< [1]
  Duration round_trip{};
  Endpoint surgeon_at = *io::resolve_endpoint("127.0.0.1:1000");
  Endpoint patient_at = *io::resolve_endpoint("127.0.0.1:2000");
};

/// One surgeon and one patient with a network of their own between them.
struct Attempt {
  Attempt(const io::Credentials& surgeon_keys,
          const io::Credentials& patient_keys,
          std::uint64_t id,
          TimePoint begin)
      : surgeon{surgeon_keys}, patient{patient_keys}, seed{id}, begins_at{begin} {}
  void tick(TimePoint now, const HandshakePath& path) {
    surgeon.call(path.patient_at, now);  // does nothing while one is running
    surgeon.tick(now);
    patient.tick(now);
    post(surgeon.take_letters(), true, now, path);
    post(patient.take_letters(), false, now, path);
    while (!under_way.empty() && under_way.begin()->first <= now) {
      auto first = under_way.extract(under_way.begin());
      const auto& [up, bytes] = first.mapped();
      (up ? patient : surgeon).hear(bytes, up ? path.surgeon_at : path.patient_at, now);
    }
  }
  void post(std::vector<io::Letter> letters, bool up, TimePoint now, const HandshakePath& path) {
    for (io::Letter& letter : letters) {
      (up ? bytes_up : bytes_down) += letter.bytes.size();
      const double draw = static_cast<double>(random_bits(seed, 5, sent++) >> 11U) * 0x1p-53;
      if (draw < path.loss) continue;
      under_way.emplace(now + path.round_trip / 2, std::pair{up, std::move(letter.bytes)});
    }
  }
  io::Associations surgeon;
  io::Associations patient;
  std::uint64_t seed;
  TimePoint begins_at;
  std::uint64_t sent{};
  std::multimap<TimePoint, std::pair<bool, std::vector<std::byte>>> under_way;  ///< true: up
  std::optional<Duration> took;
  std::size_t bytes_up{};
  std::size_t bytes_down{};
};

int handshakes(int count, double loss, Duration round_trip, std::uint64_t seed) {
  const io::test::KeysFolder keys{"bench"};
  const auto surgeon_keys = keys.credentials(Role::Surgeon);
  const auto patient_keys = keys.credentials(Role::Patient);
  const HandshakePath path{.loss = loss, .round_trip = round_trip};
  const io::SteadyClock clock;
  std::vector<double> all;
  constexpr int kAtOnce = 20;
  // One after the other: together they would wait for each other's signatures, in this one thread,
  // which is no part of a handshake.
  constexpr Duration kApart = milliseconds{15};
  const double processor_before = seconds(io::process_time().cpu);
  for (int done = 0; done < count; done += kAtOnce) {
    std::vector<std::unique_ptr<Attempt>> attempts;
    const TimePoint began = clock.now();
    for (int i = done; i < std::min(count, done + kAtOnce); ++i) {
      attempts.push_back(
          std::make_unique<Attempt>(*surgeon_keys,
                                    *patient_keys,
                                    random_bits(seed, 1, static_cast<std::uint64_t>(i)),
                                    began + (i - done) * kApart));
    }
    int open = static_cast<int>(attempts.size());
    while (open > 0 && clock.now() - began < std::chrono::seconds{30}) {
      for (auto& attempt : attempts) {
        const TimePoint now = clock.now();
        if (attempt->took || now < attempt->begins_at) continue;
        attempt->tick(now, path);
        if (!attempt->surgeon.take_made().empty()) {
          attempt->took = now - attempt->begins_at;
          all.push_back(ms(*attempt->took));
          --open;
        }
      }
      std::this_thread::sleep_for(std::chrono::microseconds{200});
    }
  }
  std::sort(all.begin(), all.end());
  if (all.empty()) return 1;
  // Looking round every 200 us is in it.
  const double processor = 1e3 * (seconds(io::process_time().cpu) - processor_before) / count;
  const auto at = [&](double share) {
    return all[std::min(all.size() - 1,
                        static_cast<std::size_t>(share * static_cast<double>(all.size())))];
  };
  std::printf(
      "%zu of %d handshakes, loss %.0f %%, round trip %.0f ms: p50 %.0f ms, p90 %.0f ms, "
      "worst %.0f ms; %.1f ms of processor for both ends of each\n",
      all.size(),
      count,
      loss * 100,
      ms(round_trip),
      at(0.5),
      at(0.9),
      all.back(),
      processor);
  return all.size() == static_cast<std::size_t>(count) ? 0 : 1;
}

/// The way between the sites: passes all, keeps the newest telegram, and sends junk from the
/// address that the patient's socket is connected to.
class Road {
 public:
  explicit Road(const Endpoint& patient)
      : patient_{patient},
        thread_{[this](const auto& stop) { run(stop); }},
        stranger_{[this](const auto& stop) { make_junk(stop); }} {}
  [[nodiscard]] std::uint16_t port() const { return front_.local().port(); }
  void flood(int kind) { kind_ = kind; }
  [[nodiscard]] std::uint64_t junk() const { return junk_; }

 private:
  void run(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      while (auto taken = front_.take()) {
        surgeon_ = taken->from;
        if (kind_ == 0 && !taken->bytes.empty()) {  // nobody reads them then
          if (taken->bytes[0] == std::byte{0x80}) telegram_ = taken->bytes;
          if (taken->bytes[0] == std::byte{22} && hello_.empty()) hello_ = taken->bytes;
        }
        back_.send_to(patient_, taken->bytes);
      }
      while (auto taken = back_.take()) {
        if (surgeon_.valid()) front_.send_to(surgeon_, taken->bytes);
      }
      std::this_thread::sleep_for(std::chrono::microseconds{50});
    }
  }
  /// A stranger with little priority, as one on another machine would be.
  void make_junk(const std::stop_token& stop) {
    (void)setpriority(PRIO_PROCESS, 0, 10);
    const io::SteadyClock clock;
    TimePoint next = clock.now();
    while (!stop.stop_requested()) {
      if (kind_ == 0) {
        std::this_thread::sleep_for(milliseconds{1});
        next = clock.now();
      } else if (clock.now() >= next) {
        next += std::chrono::microseconds{200};
        for (int i = 0; i < 20; ++i) send_junk();
      } else {
        std::this_thread::sleep_until(std::chrono::steady_clock::now() +
                                      std::chrono::microseconds{50});
      }
    }
  }
  void send_junk() {
    std::vector<std::byte> bytes = kind_ == 5 ? hello_ : telegram_;
    const std::uint64_t n = junk_++;
    if (bytes.size() < 60) return;
    if (kind_ == 1) {  // random
      for (std::size_t i = 0; i < bytes.size(); ++i) {
        bytes[i] = static_cast<std::byte>(random_bits(n, 1, i / 8) >> (i % 8 * 8));
      }
    } else if (kind_ == 2) {  // right header, far number, random content
      bytes[12] = std::byte{1};
      for (std::size_t i = 16; i < bytes.size(); ++i) {
        bytes[i] = static_cast<std::byte>(random_bits(n, 1, i / 8) >> (i % 8 * 8));
      }
    } else if (kind_ == 4) {  // a bit flipped in a telegram of the future
      bytes[12] = std::byte{1};
      const std::size_t bit = random_bits(n, 2, 0) % (8 * (bytes.size() - 16));
      bytes[16 + bit / 8] ^= static_cast<std::byte>(1U << bit % 8);
    }  // 3: replayed, 5: ClientHello, as they are
    back_.send_to(patient_, bytes);
  }
  io::test::PlainSocket front_;
  io::test::PlainSocket back_;
  Endpoint patient_;
  Endpoint surgeon_;
  std::vector<std::byte> telegram_;
  std::vector<std::byte> hello_;
  std::atomic<int> kind_{};
  std::atomic<std::uint64_t> junk_{};
  std::jthread thread_;
  std::jthread stranger_;
};

/// One kind of junk beside the session, and beside a raw loop that talks to itself. @returns
/// whether all targets were kept.
bool flood_with(int kind, Duration span, Road& road, SecureSite& surgeon, SecureSite& patient) {
  constexpr std::array<const char*, 6> kNames{
      "none", "random", "right header", "replayed", "bit flipped", "ClientHello"};
  const io::SteadyClock clock;
  const int socket = make_raw_socket();
  const StolenTime stolen;
  RawLoop raw{
      socket, clock.now() + milliseconds{10}, static_cast<std::size_t>(span / milliseconds{1})};
  const LinkHealth before = patient.health.get();
  const LinkHealth sent_before = surgeon.health.get();
  const io::LoopProgress loop_before = patient.rt->progress();
  const long memory = resident_kb();
  const std::uint64_t junk = road.junk();
  road.flood(kind);
  clock.sleep_until(clock.now() + span);
  road.flood(0);
  clock.sleep_until(clock.now() + milliseconds{200});
  const LinkHealth after = patient.health.get();
  const io::LoopProgress loop = patient.rt->progress();
  const RawAccount reference = raw.stop();
  ::close(socket);
  const auto per_thousand = [](std::uint64_t missed, std::uint64_t ticks) {
    return 1e3 * static_cast<double>(missed) /
           static_cast<double>(std::max<std::uint64_t>(1, missed + ticks));
  };
  const auto sent = static_cast<double>(surgeon.health.get().sent - sent_before.sent);
  const auto taken =
      static_cast<double>(after.accepted + after.late - before.accepted - before.late);
  const double missed =
      per_thousand(loop.missed - loop_before.missed, loop.ticks - loop_before.ticks);
  const double raw_missed = per_thousand(reference.missed, reference.ticks);
  const long grown = resident_kb() - memory;
  const bool good = taken >= 0.999 * sent && after.state == LinkState::Live &&
                    missed <= raw_missed + 0.5 && grown < 1024;
  std::printf("%-13s %7.0f %6.0f %9.0f  %.5f %8.2f %8.2f %7ld %5.2f %%  %s\n",
              kNames[static_cast<std::size_t>(kind)],
              static_cast<double>(road.junk() - junk) / seconds(span),
              sent,
              taken,
              taken / sent,
              missed,
              raw_missed,
              grown,
              100 * stolen.share(),
              good ? "kept" : "MISSED");
  std::fflush(stdout);
  return good;
}

int flood(int span_s) {
  const io::test::KeysFolder keys{"flood"};
  const auto surgeon_keys = keys.credentials(Role::Surgeon);
  const auto patient_keys = keys.credentials(Role::Patient);
  SecureSite patient{Role::Patient, 0, *patient_keys};
  Road road{patient.server.local()};
  SecureSite surgeon{Role::Surgeon, road.port(), *surgeon_keys};
  for (SecureSite* site : {&patient, &surgeon}) {
    site->start([site](TimePoint now) {
      (void)site->link.receive(now);
      site->link.send({}, now);
    });
  }
  while (patient.health.get().state != LinkState::Live) std::this_thread::yield();
  int failures = 0;
  std::printf(
      "kind           junk/s   sent  accepted  share  missed/1000   raw   RSS +kB stolen\n");
  for (int kind = 0; kind <= 5; ++kind) {
    failures += flood_with(kind, std::chrono::seconds{span_s}, road, surgeon, patient) ? 0 : 1;
  }
  surgeon.server.close("done");
  patient.server.close("done");
  patient.rt->stop();
  surgeon.rt->stop();
  return failures == 0 ? 0 : 1;
}

}  // namespace
}  // namespace palp::bench

int main(int argc, char** argv) {
  const std::string_view what = argc > 1 ? argv[1] : "cost";
  if (what == "handshakes" && (argc == 5 || argc == 6)) {
    return palp::bench::handshakes(std::atoi(argv[2]),
                                   std::atof(argv[3]),
                                   std::chrono::milliseconds{std::atoi(argv[4])},
                                   argc == 6 ? std::strtoull(argv[5], nullptr, 10) : 1);
  }
  if (what == "flood" && argc == 3) return palp::bench::flood(std::atoi(argv[2]));
  return palp::bench::cost() + palp::bench::hellos();
}
