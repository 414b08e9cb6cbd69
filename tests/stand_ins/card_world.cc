// What stands behind hidapi in palp-patient-card, which is palp-patient but for that: an MCC
// USB-1608FS that samples a voltage without pause. The voltage is a number of 8 bytes in the file
// PALP_STAND_IN_VOLTS, which whoever plays the tissue writes; without it, 0 V.
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>

#include <fcntl.h>
#include <unistd.h>

#include "common/io/realtime/steady_clock.h"
#include "tests/common/io/device/fake_hidapi.h"

namespace palp {
namespace {

using fake_hid::Bytes;

constexpr int kInterfaces = 6;
constexpr Duration kPacketPeriod = std::chrono::nanoseconds{1'001'302};  // 31 at 30,959.75 Hz

class CardWorld {
 public:
  CardWorld() {
    const char* const named = std::getenv("PALP_STAND_IN_VOLTS");  // NOLINT(concurrency-mt-unsafe)
    if (named != nullptr) file_ = ::open(named, O_RDONLY | O_CLOEXEC);
    for (int i = 0; i <= kInterfaces; ++i) {
      fake_hid::Device made;
      made.path = "/dev/null#" + std::to_string(i);
      made.vendor = 0x09DB;
      made.product = 0x007D;
      made.interface_number = i;
      made.name = L"USB-1608FS of a stand-in";
      if (i > 0) made.before_read = [this] { sample(); };
      devices_.at(static_cast<std::size_t>(i)) = &fake_hid::plug(std::move(made));
    }
    remember(0x80, std::bit_cast<std::uint32_t>(5.0F), 4);
    remember(0xA0, std::bit_cast<std::uint32_t>(-5.0F), 4);
    for (int channel = 0; channel < 8; ++channel) {
      remember(0xB0 + 4 * channel, 0xC0008000, 4);
      remember(0x130 + 2 * channel, 0x4000, 2);
    }
    devices_[0]->on_write = [this](const Bytes& bytes) { obey(bytes); };
  }

 private:
  void remember(int address, std::uint32_t value, int count) {
    for (int i = 0; i < count; ++i) {
      memory_[address + i] = static_cast<std::uint8_t>(value >> static_cast<unsigned>(8 * i));
    }
  }
  void obey(const Bytes& bytes) {
    if (bytes[0] == 0x12) scans_ = false;
    if (bytes[0] == 0x11) {
      scans_ = true;
      index_ = 0;
      next_at_ = clock_.now() + kPacketPeriod;
    }
    if (bytes[0] != 0x30 || bytes.size() != 5) return;
    Bytes reply{0x30};
    for (int i = 0; i < bytes[4]; ++i) reply.push_back(memory_[bytes[1] + 256 * bytes[2] + i]);
    devices_[0]->input.push_back(std::move(reply));
  }
  [[nodiscard]] double volts() const {
    double value = 0;
    if (file_ < 0 || ::pread(file_, &value, sizeof value, 0) != sizeof value) return 0;
    return std::isfinite(value) ? value : 0;
  }
  void sample() {
    for (const TimePoint now = clock_.now(); scans_ && now >= next_at_; next_at_ += kPacketPeriod) {
      const long raw = std::lround(0x8000 + volts() / 10 * 0x7FFF);
      Bytes packet(64);
      for (std::size_t i = 0; i < 31; ++i) {
        const auto value = static_cast<unsigned>(raw + (i % 2 == 0 ? 2 : -2));
        packet[2 * i] = static_cast<std::uint8_t>(value & 0xFFU);
        packet[2 * i + 1] = static_cast<std::uint8_t>((value >> 8U) & 0xFFU);
      }
      packet[62] = static_cast<std::uint8_t>(index_ & 0xFFU);
      packet[63] = static_cast<std::uint8_t>(index_ >> 8U);
      devices_.at(1U + index_ % kInterfaces)->input.push_back(std::move(packet));
      ++index_;
    }
  }

  io::SteadyClock clock_;
  std::array<fake_hid::Device*, 1 + kInterfaces> devices_{};
  std::map<int, std::uint8_t> memory_;
  int file_{-1};
  bool scans_{};
  std::uint16_t index_{};
  TimePoint next_at_{};
};

/// There before main, as a device is before a program.
CardWorld world;

}  // namespace
}  // namespace palp
