// What stands behind hidapi in palp-surgeon-paddle, which is palp-surgeon but for that: a paddle
// with the firmware's reports, held by the scripted hand of the simulated device. It taps; that the
// session is engaged it sees from the paddle's lamp alone. PALP_STAND_IN_SCRIPT: what it does.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "common/io/realtime/steady_clock.h"
#include "surgeon_site/devices/firmware/paddle/paddle_report.h"
#include "surgeon_site/script_source.h"
#include "surgeon_site/simulated_hand.h"
#include "tests/common/io/device/fake_hidapi.h"

namespace palp {
namespace {

using fake_hid::Bytes;

constexpr Duration kReportPeriod = std::chrono::milliseconds{1};
constexpr Duration kSessionComesUp = std::chrono::seconds{3};  // after the site's first word
constexpr double kTipAtFirst = -10e-3;                         // [m], of the other site's stage

surgeon::GestureScript script() {
  const char* const named = std::getenv("PALP_STAND_IN_SCRIPT");  // NOLINT(concurrency-mt-unsafe)
  const surgeon::SimulatedHandConfig hand;
  auto read = surgeon::load_script(named != nullptr ? named : "script:standard",
                                   {hand.plant.grip.stiffness, {}});
  if (read) return *read;
  std::fprintf(stderr, "palp-surgeon-paddle: %s\n", read.error().text.c_str());
  std::exit(3);  // NOLINT(concurrency-mt-unsafe): before any thread
}

class PaddleWorld {
 public:
  PaddleWorld() : hand_{{}, script()}, device_{plugged()} {
    device_.before_read = [this] { live(); };
    device_.on_write = [this](const Bytes& bytes) { obey(bytes); };
  }

 private:
  static fake_hid::Device& plugged() {
    fake_hid::Device made;
    made.path = "/dev/null";  // it is there, and may be opened
    made.vendor = palp_paddle::kVendor;
    made.product = palp_paddle::kProduct;
    made.usage_page = palp_paddle::kUsagePage;
    made.name = L"Paddle of a stand-in";
    return fake_hid::plug(std::move(made));
  }
  void obey(const Bytes& bytes) {
    palp_paddle::Command command{};
    if (!palp_paddle::unpack(bytes.data() + 1, bytes.size() - 1, command)) return;
    const TimePoint now = clock_.now();
    if (!heard_) begins_at_ = now + kSessionComesUp;
    heard_ = true;
    lamp_ = (command.flags & palp_paddle::kCommandLamp) != 0;
    const bool on = (command.flags & palp_paddle::kCommandEnable) != 0;
    hand_.apply(on ? command.force_un * 1e-6 : 0);
    expires_at_ = now + std::chrono::milliseconds{command.valid_for_ms};
  }
  void live() {
    const TimePoint now = clock_.now();
    if (now < next_at_) return;
    next_at_ = std::max(next_at_ + kReportPeriod, now - kReportPeriod);
    if (now > expires_at_) hand_.apply(0);
    surgeon::OperatorView view;
    view.state = view.peer_state = lamp_ ? SiteState::Engaged : SiteState::Clutched;
    view.link = heard_ && now > begins_at_ ? LinkState::Live : LinkState{};
    view.tip_position = kTipAtFirst;
    view.tip_known = true;
    hand_.show(view);
    const surgeon::HandState state = hand_.read(now);
    palp_paddle::State report{};
    report.sequence = ++sequence_;
    report.flags = static_cast<std::uint16_t>(
        palp_paddle::kStateCalibrated | (state.pedal_held ? palp_paddle::kStatePedalHeld : 0));
    report.position_nm = static_cast<std::int32_t>(std::lround(state.position * 1e9));
    report.velocity_um_per_s = static_cast<std::int32_t>(std::lround(state.velocity * 1e6));
    Bytes bytes(palp_paddle::kReportBytes);
    palp_paddle::pack(report, bytes.data());
    device_.input.push_back(std::move(bytes));
  }

  io::SteadyClock clock_;
  surgeon::SimulatedHand hand_;
  fake_hid::Device& device_;
  bool heard_{};
  bool lamp_{};
  TimePoint begins_at_{};
  TimePoint expires_at_{};
  TimePoint next_at_{};
  std::uint16_t sequence_{};
};

/// There before main, as a device is before a program.
const PaddleWorld world;

}  // namespace
}  // namespace palp
