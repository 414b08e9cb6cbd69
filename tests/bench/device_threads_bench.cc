// Whether devices' threads touch the rt thread's time: device_threads_bench [ROUNDS [SECONDS]]
// Both sites tick on one thread at 1 kHz while the script palpates, first with all adapters beside
// them, each on its own thread, then with none; a round is so many SECONDS of each, in turn. With
// adapters, each tick also reads and commands all of them; that is timed apart. Their ports are in
// memory and block as long as their transactions take on a wire: 2 to 8 ms of Modbus, nothing for
// HID. Which of both comes first alternates. Prints lateness and time of ticks, and at the end the
// ratios of the rounds' p99: their medians, each with the 95 % interval that the order of so many
// rounds gives.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "common/core/histogram.h"
#include "common/io/realtime/periodic_thread.h"
#include "common/io/realtime/steady_clock.h"
#include "patient_site/devices/card_thread.h"
#include "patient_site/devices/register_stage.h"
#include "patient_site/settings_devices.h"
#include "surgeon_site/devices/firmware/paddle/paddle_report.h"
#include "surgeon_site/devices/hid_master.h"
#include "surgeon_site/devices/paddle.h"
#include "tests/bench/two_sites.h"

namespace palp::bench {
namespace {

constexpr int kPriority = 80;

/// Registers that take their time.
class SlowRegisters final : public io::RegisterPort {
 public:
  explicit SlowRegisters(Duration span) : span_{span} { words_[0x9005] = 0x3010; }
  io::PortFault open() override { return io::PortFault::None; }
  void close() override {}
  io::PortFault read(std::uint16_t address, std::span<std::uint16_t> out, bool) override {
    clock_.pass(span_);
    for (auto& word : out) word = words_[address++];
    // Loads that are quiet and not dead.
    words_[8] = words_[348] = static_cast<std::uint16_t>(1 + (++count_ & 1U));
    return io::PortFault::None;
  }
  io::PortFault write(std::uint16_t, std::span<const std::uint16_t>) override {
    clock_.pass(span_);
    return io::PortFault::None;
  }
  io::PortFault write_one(std::uint16_t, std::uint16_t) override { return io::PortFault::None; }
  io::PortFault write_coil(std::uint16_t, bool) override { return io::PortFault::None; }
  io::PortFault exchange(std::uint16_t,
                         std::span<const std::uint16_t>,
                         std::uint16_t address,
                         std::span<std::uint16_t> out) override {
    return read(address, out, false);
  }

 private:
  Duration span_;
  io::SteadyClock clock_;
  std::array<std::uint16_t, 65'536> words_{};
  std::uint32_t count_{};
};

/// A report at each cycle: of a paddle, or of a card's first interface of data.
class EagerReports final : public io::ReportPort {
 public:
  enum class Kind : std::uint8_t { Paddle, Packets, Nothing };
  explicit EagerReports(Kind kind) : kind_{kind} {}
  io::PortFault open() override { return io::PortFault::None; }
  void close() override {}
  io::PortFault read(std::span<std::uint8_t> report, std::size_t& length, Duration) override {
    length = 0;
    if (kind_ == Kind::Nothing || !(told_ = !told_)) return io::PortFault::None;
    length = palp_paddle::kReportBytes;
    std::fill_n(report.begin(), length, std::uint8_t{0});
    ++count_;
    if (kind_ == Kind::Paddle) {
      palp_paddle::State state{};
      state.flags = palp_paddle::kStateCalibrated;
      state.sequence = count_;
      palp_paddle::pack(state, report.data());
      return io::PortFault::None;
    }
    report[0] = static_cast<std::uint8_t>(16U * (count_ & 1U));
    report[62] = static_cast<std::uint8_t>(count_ & 0xFFU);
    report[63] = static_cast<std::uint8_t>(count_ >> 8U);
    return io::PortFault::None;
  }
  io::PortFault write(std::span<const std::uint8_t>) override { return io::PortFault::None; }
  io::PortFault set_feature(std::span<const std::uint8_t>) override { return io::PortFault::None; }
  io::PortFault get_feature(std::span<std::uint8_t>, std::size_t& length) override {
    length = 0;
    return io::PortFault::None;
  }

 private:
  Kind kind_;
  bool told_{};
  std::uint16_t count_{};
};

/// A stage of three makers, a load cell, a force card and a paddle.
class Adapters {
 public:
  Adapters()
      : normal_{axis("orca", std::chrono::milliseconds{4})},
        x_{axis("iai", std::chrono::milliseconds{7})},
        y_{axis("az", std::chrono::milliseconds{5})},
        cell_{axis("tlb4", std::chrono::milliseconds{2})},
        stage_{{normal_.get(), x_.get(), y_.get()}, StageFacts{}},
        cell_force_{*cell_, ForceSensorFacts{}},
        card_{std::make_unique<patient::CardThread>(card(), card_ports(), kPriority - 1)},
        card_force_{*card_, ForceSensorFacts{}},
        paddle_{std::make_unique<surgeon::MasterThread>(
            "master",
            std::make_unique<surgeon::Paddle>(),
            hand(),
            std::make_unique<EagerReports>(EagerReports::Kind::Paddle),
            kPriority - 1)},
        master_{*paddle_, HandFacts{}} {}

  void tick(TimePoint now) noexcept {
    const auto hand = master_.read(now);
    const auto stage = stage_.read(now);
    const auto cell = cell_force_.sample(now);
    const auto card = card_force_.sample(now);
    stage_.move_to({.position = hand.position, .place = {}});
    master_.apply(1e-3 * (cell ? cell->force : 0) + 1e-3 * (card ? card->force : 0) +
                  1e-3 * stage.position);
  }
  [[nodiscard]] int ready() {
    int count = 0;
    for (auto* const one : {normal_.get(), x_.get(), y_.get(), cell_.get()}) {
      count += one->status().state == patient::DeviceState::Ready ? 1 : 0;
    }
    count += card_->status().state == patient::CardState::Ready ? 1 : 0;
    return count + (paddle_->status().state == surgeon::MasterState::Ready ? 1 : 0);
  }

 private:
  static std::unique_ptr<patient::DeviceThread> axis(const char* profile, Duration span) {
    patient::DeviceInstallation built_in;
    built_in.tare_time = std::chrono::milliseconds{100};
    return std::make_unique<patient::DeviceThread>(profile,
                                                   patient::find_profile(profile).value(),
                                                   built_in,
                                                   std::make_unique<SlowRegisters>(span),
                                                   kPriority - 1);
  }
  static patient::CardInstallation card() {
    patient::CardInstallation built_in;
    built_in.kind = patient::CardKind::Usb1208;
    built_in.newtons_per_volt = 5;
    built_in.load.tare_time = std::chrono::milliseconds{100};
    return built_in;
  }
  static patient::CardThread::Ports card_ports() {
    patient::CardThread::Ports ports;
    for (int i = 0; i < 4; ++i) {
      ports.push_back(std::make_unique<EagerReports>(i == 1 ? EagerReports::Kind::Packets
                                                            : EagerReports::Kind::Nothing));
    }
    return ports;
  }
  static surgeon::MasterInstallation hand() {
    surgeon::MasterInstallation built_in;
    built_in.position_unit = surgeon::Paddle::kPositionUnit;
    built_in.force_unit = surgeon::Paddle::kForceUnit;
    built_in.force_max = 3;
    return built_in;
  }

  std::unique_ptr<patient::DeviceThread> normal_;
  std::unique_ptr<patient::DeviceThread> x_;
  std::unique_ptr<patient::DeviceThread> y_;
  std::unique_ptr<patient::DeviceThread> cell_;
  patient::RegisterStage stage_;
  patient::RegisterForce cell_force_;
  std::unique_ptr<patient::CardThread> card_;
  patient::CardForce card_force_;
  std::unique_ptr<surgeon::MasterThread> paddle_;
  surgeon::HidMaster master_;
};

struct Account {
  io::LoopStats loop;
  Duration tick_p50{};
  Duration tick_p99{};
  Duration calls_p50{};  ///< of the adapters' own calls
  Duration calls_p99{};
  int ready{};
};

Account run_loop(bool with, Duration span) {
  const io::SteadyClock clock;
  TwoSites sites{standard_scenario("mmt"), clock.now()};
  std::unique_ptr<Adapters> adapters = with ? std::make_unique<Adapters>() : nullptr;
  clock.pass(std::chrono::milliseconds{500});  // their starts and tares
  Histogram ticks;
  Histogram calls;
  io::PeriodicThread loop{"bench-rt", {.priority = kPriority}, [&](TimePoint now) {
                            const TimePoint began = clock.now();
                            sites.tick_surgeon(now);
                            sites.tick_patient(now);
                            const TimePoint ended = clock.now();
                            ticks.record(elapsed(began, ended));
                            if (adapters) {
                              adapters->tick(now);
                              calls.record(elapsed(ended, clock.now()));
                            }
                            sites.drop_records();
                            sites.drop_contact();
                          }};
  clock.pass(span);
  Account account;
  account.loop = loop.stop();
  account.tick_p50 = ticks.quantile(0.5);
  account.tick_p99 = ticks.quantile(0.99);
  account.calls_p50 = calls.quantile(0.5);
  account.calls_p99 = calls.quantile(0.99);
  account.ready = adapters ? adapters->ready() : 0;
  return account;
}

double us(Duration span) { return 1e6 * seconds(span); }

void print(const char* name, const Account& one) {
  std::printf(
      "%-16s %d ready  late p50 %6.1f us  p99 %7.1f  tick p50 %6.1f us  p99 %7.1f  "
      "missed %llu of %llu\n",
      name,
      one.ready,
      us(one.loop.lateness_p50),
      us(one.loop.lateness_p99),
      us(one.tick_p50),
      us(one.tick_p99),
      static_cast<unsigned long long>(one.loop.missed),
      static_cast<unsigned long long>(one.loop.ticks));
  std::fflush(stdout);
}

/// [us], p99; below 1 us none is told from none.
double lateness(const Account& one) { return std::max(1.0, us(one.loop.lateness_p99)); }

struct Median {
  double value{};
  double low{};  ///< of its interval; the least and greatest of few values
  double high{};
};

/// Whatever the values' law: of n, the k-th from either end hold the median between them 95 times
/// in 100 for k = n/2 - 0.98 sqrt(n).
Median median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto count = static_cast<double>(values.size());
  const auto ends = static_cast<std::size_t>(std::max(0.0, 0.5 * count - 0.98 * std::sqrt(count)));
  return {values[values.size() / 2], values[ends], values[values.size() - 1 - ends]};
}

void print(const char* name, const Median& one) {
  std::printf(", %s %.2f (%.2f to %.2f)", name, one.value, one.low, one.high);
}

}  // namespace
}  // namespace palp::bench

int main(int argc, char** argv) {
  using palp::bench::us;
  const int rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 5;
  const std::chrono::seconds span{argc > 2 ? std::max(1, std::atoi(argv[2])) : 10};
  std::vector<double> late;
  std::vector<double> ticks;
  for (int round = 0; round < rounds; ++round) {
    const bool with_first = round % 2 == 0;
    auto with = palp::bench::run_loop(with_first, span);
    auto without = palp::bench::run_loop(!with_first, span);
    if (!with_first) std::swap(with, without);
    palp::bench::print("all adapters", with);
    palp::bench::print("none", without);
    late.push_back(palp::bench::lateness(with) / palp::bench::lateness(without));
    ticks.push_back(us(with.tick_p99) / us(without.tick_p99));
  }
  std::printf("p99, all adapters to none, median of %d rounds", rounds);
  palp::bench::print("lateness", palp::bench::median(late));
  palp::bench::print("tick", palp::bench::median(ticks));
  std::printf("\n");
  return 0;
}
