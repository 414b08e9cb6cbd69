// Far ends of HID devices, of a kernel that has none plugged in:
//   virtual_device paddle uhid            a paddle that a hand pushes, made of /dev/uhid
//   virtual_device paddle /dev/hidg0      the same behind a USB gadget
//   virtual_device card /dev/hidg0 ...    a USB-1208FS: commands, then three interfaces of data
// The paddle is a mass that a hand pushes into a wall with 0.8 N; the force that it is sent pushes
// it out, until that word's time is over. The card's sensor feels 2 V, 0.5 s after its scan began.
// Ends with its input; "out" and "in" on it unplug the paddle of /dev/uhid and plug it in again.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <linux/uhid.h>
#include <unistd.h>

#include "common/io/process/descriptor.h"
#include "common/io/realtime/periodic_loop.h"
#include "surgeon_site/devices/firmware/paddle/paddle_report.h"

namespace palp {
namespace {

using Report = std::array<std::uint8_t, palp_paddle::kReportBytes>;

/// Vendor page, 64 bytes in and 64 out, no report id.
constexpr std::array<std::uint8_t, 29> kDescriptor{
    0x06, 0xAB, 0xFF, 0x0A, 0x00, 0x02, 0xA1, 0x01, 0x75, 0x08, 0x15, 0x00, 0x26, 0xFF, 0x00,
    0x95, 0x40, 0x09, 0x01, 0x81, 0x02, 0x95, 0x40, 0x09, 0x02, 0x91, 0x02, 0xC0, 0x00};
constexpr std::size_t kDescriptorBytes = kDescriptor.size() - 1;

/// Where reports go and come from: a node of the kernel that never blocks.
class Wire {
 public:
  explicit Wire(std::string path) : uhid_{path == "uhid"}, path_{uhid_ ? "/dev/uhid" : path} {
    plug_in();
  }
  void plug_in() {
    node_ = io::Descriptor{::open(path_.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)};
    if (!node_.valid()) return;
    if (!uhid_) return;
    uhid_event made{};
    made.type = UHID_CREATE2;
    uhid_create2_req& ask = made.u.create2;
    std::snprintf(reinterpret_cast<char*>(ask.name), sizeof ask.name, "Paddle of a test");
    std::copy_n(kDescriptor.begin(), kDescriptorBytes, ask.rd_data);
    ask.rd_size = kDescriptorBytes;
    ask.bus = 3;  // USB
    ask.vendor = palp_paddle::kVendor;
    ask.product = palp_paddle::kProduct;
    (void)!::write(node_.number(), &made, sizeof made);
  }
  void unplug() { node_.close(); }

  void send(const Report& report) {
    if (!node_.valid()) return;
    if (!uhid_) {
      (void)!::write(node_.number(), report.data(), report.size());
      return;
    }
    uhid_event event{};
    event.type = UHID_INPUT2;
    event.u.input2.size = static_cast<__u16>(report.size());
    std::copy(report.begin(), report.end(), event.u.input2.data);
    (void)!::write(node_.number(), &event, sizeof event);
  }
  /// The next report from the host; false: there is none.
  bool receive(std::vector<std::uint8_t>& report) {
    if (!node_.valid()) return false;
    if (!uhid_) {
      report.resize(palp_paddle::kReportBytes);
      const ssize_t count = ::read(node_.number(), report.data(), report.size());
      report.resize(static_cast<std::size_t>(std::max<ssize_t>(0, count)));
      return count > 0;
    }
    uhid_event event{};
    while (::read(node_.number(), &event, sizeof event) > 0) {
      if (event.type != UHID_OUTPUT) continue;
      const auto* const begin = event.u.output.data;
      report.assign(begin + 1, begin + event.u.output.size);  // the first: no id
      return true;
    }
    return false;
  }

 private:
  bool uhid_;
  std::string path_;
  io::Descriptor node_;
};

class VirtualPaddle {
 public:
  explicit VirtualPaddle(const std::string& path) : wire_{path} {}
  void tick(TimePoint now) {
    std::vector<std::uint8_t> bytes;
    while (wire_.receive(bytes)) {
      palp_paddle::Command command{};
      if (!palp_paddle::unpack(bytes.data(), bytes.size(), command)) continue;
      force_ = command.force_un * 1e-6;
      valid_until_ = now + std::chrono::milliseconds{command.valid_for_ms};
    }
    if (now > valid_until_) force_ = 0;
    constexpr double kMass = 0.2;    // [kg]
    constexpr double kDamping = 5;   // [N s/m]
    constexpr double kPush = 0.8;    // [N]
    constexpr double kStop = 15e-3;  // [m], its mechanical end
    velocity_ += (kPush - force_ - kDamping * velocity_) / kMass * 1e-3;
    position_ += velocity_ * 1e-3;
    if (position_ > kStop) {
      position_ = kStop;
      velocity_ = 0;
    }
    palp_paddle::State state{};
    state.sequence = ++sequence_;
    state.flags = palp_paddle::kStateCalibrated | palp_paddle::kStatePedalHeld;
    state.position_nm = static_cast<std::int32_t>(position_ * 1e9);
    state.velocity_um_per_s = static_cast<std::int32_t>(velocity_ * 1e6);
    Report report{};
    palp_paddle::pack(state, report.data());
    wire_.send(report);
  }
  void obey(const std::string& word) {
    if (word == "out\n") wire_.unplug();
    if (word == "in\n") wire_.plug_in();
  }

 private:
  Wire wire_;
  double position_{-5e-3};  // [m]
  double velocity_{};       // [m/s]
  double force_{};          // [N]
  TimePoint valid_until_{};
  std::uint16_t sequence_{};
};

class VirtualCard {
 public:
  explicit VirtualCard(const std::vector<std::string>& paths) {
    for (const std::string& path : paths) wires_.emplace_back(path);
  }
  void tick(TimePoint now) {
    std::vector<std::uint8_t> bytes;
    while (wires_[0].receive(bytes)) {
      if (bytes[0] == 0x12) scans_ = false;
      if (bytes[0] != 0x11) continue;
      scans_ = true;
      index_ = 0;
      began_ = now;
    }
    if (!scans_) return;
    const bool pressed = now - began_ > std::chrono::milliseconds{500};
    const int counts = pressed ? 2 * 0x7FF / 20 : 0;  // 2 V of 20
    Report packet{};
    for (std::size_t i = 0; i < 31; ++i) {
      const auto sample = static_cast<std::uint16_t>(16 * (counts + (i % 2 == 0 ? 1 : -1)));
      packet[2 * i] = static_cast<std::uint8_t>(sample & 0xFFU);
      packet[2 * i + 1] = static_cast<std::uint8_t>(sample >> 8U);
    }
    packet[62] = static_cast<std::uint8_t>(index_ & 0xFFU);
    packet[63] = static_cast<std::uint8_t>(index_ >> 8U);
    wires_[1 + index_ % 3U].send(packet);
    ++index_;
  }

 private:
  std::vector<Wire> wires_;
  bool scans_{};
  std::uint16_t index_{};
  TimePoint began_{};
};

template <typename Device>
void serve(Device& device, std::stop_source& stop) {
  std::jthread ticks{[&] {
    (void)io::run_periodic(
        {.period = std::chrono::milliseconds{1}, .spin = Duration{0}},
        [&](TimePoint now) { device.tick(now); },
        stop.get_token());
  }};
  std::array<char, 32> line{};
  while (std::fgets(line.data(), line.size(), stdin) != nullptr) {
    if constexpr (requires { device.obey(line.data()); }) device.obey(line.data());
  }
  stop.request_stop();
}

}  // namespace
}  // namespace palp

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() < 2) return 2;
  std::stop_source stop;
  if (words[0] == "paddle") {
    palp::VirtualPaddle paddle{words[1]};
    palp::serve(paddle, stop);
  } else {
    palp::VirtualCard card{{words.begin() + 1, words.end()}};
    palp::serve(card, stop);
  }
  return 0;
}
