#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/io/device/report_port.h"

namespace palp::io {

/// A HID interface of this machine. Texts are the device's own words, made printable.
struct HidFound {
  std::string path;  ///< /dev/hidraw3
  std::uint16_t vendor{};
  std::uint16_t product{};
  std::uint16_t release{};  ///< binary-coded decimal, as the device says
  int interface_number{};
  std::uint16_t usage_page{};
  std::string serial;
  std::string name;
};

/// All of them, by path; needs no permission. Thread: any. Blocks.
[[nodiscard]] std::vector<HidFound> list_hid();
[[nodiscard]] bool agrees(const HidFound& found, const HidAddress& address);
/// Opens and closes it. nullopt: it can be opened; else why not, and what to do. Blocks.
[[nodiscard]] std::optional<std::string> why_not_opened(const HidFound& found);

/// HID through hidapi on the kernel's hidraw nodes. Each open() looks for the device anew, so that
/// one that was plugged in again is found under whatever path.
/// Thread: its device's; moves to none other once open() was called.
class HidPort final : public ReportPort {
 public:
  explicit HidPort(HidAddress address);
  ~HidPort() override;
  HidPort(const HidPort&) = delete;
  HidPort& operator=(const HidPort&) = delete;

  PortFault open() override;
  void close() override;
  PortFault read(std::span<std::uint8_t> report, std::size_t& length, Duration wait) override;
  PortFault write(std::span<const std::uint8_t> report) override;
  PortFault set_feature(std::span<const std::uint8_t> report) override;
  PortFault get_feature(std::span<std::uint8_t> report, std::size_t& length) override;

 private:
  struct Handle;
  HidAddress address_;
  std::unique_ptr<Handle> handle_;
};

}  // namespace palp::io
