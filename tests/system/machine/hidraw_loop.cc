// What a site makes of a HID device behind the kernel's real hidraw:
//   hidraw_loop paddle SECONDS    a wall of 400 N/m at 0, at 1 kHz, felt by who pushes the paddle
//   hidraw_loop card SECONDS      readings of a USB-1208FS at 5 N/V
// Prints a line with what was found after SECONDS, then, for 6 s more, each change of the device's
// state and, once it is ready again, the line anew. Exit code 1: not as it shall be.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>

#include "common/io/device/hid_port.h"
#include "common/io/realtime/periodic_thread.h"
#include "common/io/realtime/steady_clock.h"
#include "patient_site/devices/card_thread.h"
#include "surgeon_site/devices/hid_master.h"
#include "surgeon_site/devices/paddle.h"

namespace palp {
namespace {

constexpr double kWall = 400;    // [N/m]
constexpr double kPushed = 0.8;  // [N], by the far end
constexpr double kSpan = 1;      // [s], the newest, that is judged
constexpr Duration kAfterwards = std::chrono::seconds{6};

/// Of the newest second.
struct Found {
  double mean{};
  double least{};
  double most{};
};

/// What a tick saw, for a second; the thread that looks reads it after the ticks have ended.
class LastSecond {
 public:
  void add(double value) noexcept { values_[count_++ % values_.size()] = value; }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] Found found() const noexcept {
    const std::size_t most = std::min(count_, values_.size());
    Found all{.mean = 0, .least = 1e9, .most = -1e9};
    for (std::size_t i = 0; i < most; ++i) {
      all.mean += values_[i] / static_cast<double>(most);
      all.least = std::min(all.least, values_[i]);
      all.most = std::max(all.most, values_[i]);
    }
    return all;
  }

 private:
  std::array<double, static_cast<std::size_t>(1000 * kSpan)> values_{};
  std::size_t count_{};
};

/// For so long, or until `done`.
template <typename Done>
void pass(Duration span, Done done) {
  const io::SteadyClock clock;
  const TimePoint end = clock.now() + span;
  while (clock.now() < end && !done()) std::this_thread::sleep_for(std::chrono::milliseconds{5});
}

/// One stretch of the loop; false: not as it shall be.
bool feel(surgeon::MasterThread& thread, surgeon::HidMaster& master, Duration span) {
  LastSecond place;
  const surgeon::MasterReading before = thread.status();
  io::PeriodicThread loop{
      "palp-rt", {.period = std::chrono::milliseconds{1}, .spin = Duration{0}}, [&](TimePoint now) {
        const surgeon::HandState hand = master.read(now);
        const double force = std::max(0.0, kWall * hand.position);
        master.apply(hand.faulted ? 0 : force);
        place.add(hand.position);
      }};
  pass(span, [] { return false; });
  const io::LoopStats stats = loop.stop();
  const surgeon::MasterReading after = thread.status();
  const Found found = place.found();
  const double rate = static_cast<double>(after.number - before.number) / seconds(span);
  std::printf(
      "paddle: %llu ticks, %llu missed; %.0f reports/s, %llu skipped, %llu lost, %llu "
      "broken; place %.3f mm (%.3f to %.3f), expected %.3f; force %.2f N\n",
      static_cast<unsigned long long>(stats.ticks),
      static_cast<unsigned long long>(stats.missed),
      rate,
      static_cast<unsigned long long>(after.skipped - before.skipped),
      static_cast<unsigned long long>(after.lost - before.lost),
      static_cast<unsigned long long>(after.broken),
      found.mean * 1e3,
      found.least * 1e3,
      found.most * 1e3,
      kPushed / kWall * 1e3,
      after.force);
  std::fflush(stdout);
  const bool there = std::abs(found.mean * kWall - kPushed) < 0.02 * kPushed;
  return there && found.most - found.least < 0.1e-3 && rate > 900 && after.lost == before.lost;
}

template <typename Thread>
bool ready(Thread& thread) {
  return to_string(thread.status().state) == "ready";
}

/// It is pulled out and put in again meanwhile, by somebody else.
template <typename Thread>
bool comes_back(Thread& thread) {
  const io::SteadyClock clock;
  pass(kAfterwards, [&] { return !ready(thread); });
  const bool gone = !ready(thread);
  const TimePoint out = clock.now();
  const std::string why{thread.status().why};
  pass(kAfterwards, [&] { return ready(thread); });
  std::printf("%s: %s; ready again after %.0f ms, %u starts\n",
              gone ? "unplugged" : "never unplugged",
              why.c_str(),
              seconds(clock.now() - out) * 1e3,
              thread.status().starts);
  std::fflush(stdout);
  return gone && ready(thread);
}

bool try_paddle(Duration span) {
  surgeon::MasterInstallation built_in;
  built_in.position_unit = surgeon::Paddle::kPositionUnit;
  built_in.force_unit = surgeon::Paddle::kForceUnit;
  built_in.force_max = 3;
  built_in.silence = std::chrono::milliseconds{100};  // a machine that is emulated
  surgeon::MasterThread thread{"master",
                               std::make_unique<surgeon::Paddle>(),
                               built_in,
                               std::make_unique<io::HidPort>(surgeon::Paddle::address()),
                               0};
  surgeon::HidMaster master{thread, HandFacts{}};
  pass(std::chrono::seconds{5}, [&] { return ready(thread); });
  const bool first = ready(thread) && feel(thread, master, span);
  return first && comes_back(thread) && feel(thread, master, std::chrono::seconds{2});
}

bool try_card(Duration span) {
  patient::CardInstallation built_in;
  built_in.kind = patient::CardKind::Usb1208;
  built_in.newtons_per_volt = 5;
  built_in.load.tare_time = std::chrono::milliseconds{200};
  built_in.silence = std::chrono::milliseconds{200};  // a machine that is emulated
  const patient::CardModel& model = patient::card_model(built_in.kind);
  patient::CardThread::Ports ports;
  for (int i = 0; i <= static_cast<int>(model.interfaces); ++i) {
    ports.push_back(std::make_unique<io::HidPort>(patient::ScanCard::address(model, i)));
  }
  patient::CardThread thread{built_in, std::move(ports), 0};
  pass(std::chrono::seconds{5}, [&] { return ready(thread); });
  const auto pressed = [&] {
    pass(span, [] { return false; });
    const patient::CardReading& card = thread.status();
    std::printf("card: %s %s; %llu packets, %llu lost, %llu broken; %.2f N, expected 10\n",
                std::string{to_string(card.state)}.c_str(),
                std::string{card.why}.c_str(),
                static_cast<unsigned long long>(card.packets),
                static_cast<unsigned long long>(card.lost),
                static_cast<unsigned long long>(card.broken),
                card.force);
    std::fflush(stdout);
    return ready(thread) && std::abs(card.force - 10) < 0.2;
  };
  return pressed() && comes_back(thread) && pressed();
}

}  // namespace
}  // namespace palp

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const palp::Duration span = std::chrono::seconds{std::stol(argv[2])};
  for (const palp::io::HidFound& one : palp::io::list_hid()) {
    std::printf("listed: %04X:%04X interface %d usage page %04X '%s' %s\n",
                one.vendor,
                one.product,
                one.interface_number,
                one.usage_page,
                one.name.c_str(),
                palp::io::why_not_opened(one).value_or("can be opened").c_str());
  }
  return std::string{argv[1]} == "card" ? !palp::try_card(span) : !palp::try_paddle(span);
}
