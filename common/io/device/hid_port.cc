#include "common/io/device/hid_port.h"

#include <algorithm>
#include <cerrno>
#include <mutex>
#include <string_view>
#include <utility>

#include <hidapi/hidapi.h>
#include <unistd.h>

namespace palp::io {
namespace {

constexpr std::size_t kTextMax = 64;  // [bytes], of what a device says of itself

/// The library's lists and its global error are shared by all devices' threads.
std::mutex& hid_library_lock() {
  static std::mutex lock;
  return lock;
}

/// A device may say anything; a terminal shall not obey it.
std::string printable(const wchar_t* text) {
  std::string out;
  for (; text != nullptr && *text != 0 && out.size() < kTextMax; ++text) {
    out += *text >= L' ' && *text <= L'~' ? static_cast<char>(*text) : '?';
  }
  return out;
}

std::vector<HidFound> list_unlocked(std::uint16_t vendor, std::uint16_t product) {
  std::vector<HidFound> all;
  hid_device_info* const first = hid_enumerate(vendor, product);
  for (const hid_device_info* one = first; one != nullptr; one = one->next) {
    if (one->path == nullptr) continue;
    const bool known = std::ranges::any_of(
        all, [&](const HidFound& other) { return other.path == std::string_view{one->path}; });
    if (known) continue;  // one node is listed once for each of its usages
    all.push_back({.path = one->path,
                   .vendor = one->vendor_id,
                   .product = one->product_id,
                   .release = one->release_number,
                   .interface_number = one->interface_number,
                   .usage_page = one->usage_page,
                   .serial = printable(one->serial_number),
                   .name = printable(one->product_string)});
  }
  hid_free_enumeration(first);
  std::ranges::sort(all, {}, &HidFound::path);
  return all;
}

/// Whether the first usage that is listed, or another of the same node, is the one asked for. A
/// device has each of its interfaces once: the same one at another path is another device, and
/// which of two a kernel lists first changes with each plug.
PortFault find_path(const HidAddress& address, std::string& best) {
  hid_device_info* const first = hid_enumerate(address.vendor, address.product);
  std::vector<HidFound> agreeing;
  for (const hid_device_info* one = first; one != nullptr; one = one->next) {
    if (one->path == nullptr) continue;
    const HidFound found{.path = one->path,
                         .vendor = one->vendor_id,
                         .product = one->product_id,
                         .release = one->release_number,
                         .interface_number = one->interface_number,
                         .usage_page = one->usage_page,
                         .serial = printable(one->serial_number),
                         .name = {}};
    if (agrees(found, address)) agreeing.push_back(found);
  }
  hid_free_enumeration(first);
  if (agreeing.empty()) return PortFault::NotOpen;
  const HidFound& chosen = *std::ranges::min_element(agreeing, {}, &HidFound::path);
  best = chosen.path;
  const bool twin = std::ranges::any_of(agreeing, [&](const HidFound& one) {
    return one.path != chosen.path && one.interface_number == chosen.interface_number;
  });
  return twin ? PortFault::Ambiguous : PortFault::None;
}

}  // namespace

std::vector<HidFound> list_hid() {
  const std::lock_guard locked{hid_library_lock()};
  return list_unlocked(0, 0);
}

bool agrees(const HidFound& found, const HidAddress& address) {
  return found.vendor == address.vendor && found.product == address.product &&
         (address.interface_number < 0 || address.interface_number == found.interface_number) &&
         (address.usage_page == 0 || address.usage_page == found.usage_page) &&
         (address.serial.empty() || address.serial == found.serial);
}

std::optional<std::string> why_not_opened(const HidFound& found) {
  const std::lock_guard locked{hid_library_lock()};
  if (hid_device* const device = hid_open_path(found.path.c_str())) {
    hid_close(device);
    return std::nullopt;
  }
  const std::string why = printable(hid_error(nullptr));
  const char* const path = found.path.c_str();
  if (::access(path, F_OK) == 0 && ::access(path, R_OK | W_OK) != 0) {
    return "no permission for " + found.path +
           ": install Palp's udev rules (70-palp-hid.rules), join the group plugdev, plug it in "
           "again";
  }
  return "cannot be opened: " + (why.empty() ? "busy or gone" : why);
}

struct HidPort::Handle {
  explicit Handle(hid_device* opened) : device{opened} {}
  ~Handle() { hid_close(device); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  hid_device* device;
};

HidPort::HidPort(HidAddress address) : address_{std::move(address)} {}
HidPort::~HidPort() = default;

PortFault HidPort::open() {
  close();
  const std::lock_guard locked{hid_library_lock()};
  std::string path;
  if (const PortFault fault = find_path(address_, path); fault != PortFault::None) return fault;
  hid_device* const device = hid_open_path(path.c_str());
  if (device == nullptr) return PortFault::NotOpen;
  handle_ = std::make_unique<Handle>(device);
  return PortFault::None;
}

void HidPort::close() { handle_.reset(); }

PortFault HidPort::read(std::span<std::uint8_t> report, std::size_t& length, Duration wait) {
  length = 0;
  if (!handle_) return PortFault::Lost;
  const auto whole = std::chrono::duration_cast<std::chrono::milliseconds>(wait).count();
  const int count = hid_read_timeout(
      handle_->device, report.data(), report.size(), static_cast<int>(std::max<long>(0, whole)));
  if (count < 0) {
    close();
    return PortFault::Lost;
  }
  length = static_cast<std::size_t>(count);
  return PortFault::None;
}

// Whether a write failed because the device is gone, the next read says: the kernel tells it there.
PortFault HidPort::write(std::span<const std::uint8_t> report) {
  if (!handle_) return PortFault::Lost;
  const int count = hid_write(handle_->device, report.data(), report.size());
  return count < 0 ? PortFault::Refused : PortFault::None;
}

PortFault HidPort::set_feature(std::span<const std::uint8_t> report) {
  if (!handle_) return PortFault::Lost;
  const int count = hid_send_feature_report(handle_->device, report.data(), report.size());
  return count < 0 ? PortFault::Refused : PortFault::None;
}

PortFault HidPort::get_feature(std::span<std::uint8_t> report, std::size_t& length) {
  length = 0;
  if (!handle_) return PortFault::Lost;
  const int count = hid_get_feature_report(handle_->device, report.data(), report.size());
  if (count < 0) return PortFault::Refused;
  length = static_cast<std::size_t>(count);
  return PortFault::None;
}

}  // namespace palp::io
