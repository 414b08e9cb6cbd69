#include "tests/common/io/device/fake_hidapi.h"

#include <algorithm>
#include <cstring>
#include <sstream>
#include <utility>

#include <hidapi/hidapi.h>

namespace palp::fake_hid {
namespace {

std::vector<std::unique_ptr<Device>>& devices() {
  static std::vector<std::unique_ptr<Device>> all;
  return all;
}

}  // namespace

Device& plug(Device device) {
  devices().push_back(std::make_unique<Device>(std::move(device)));
  return *devices().back();
}

void clear() { devices().clear(); }

Bytes bytes_of(const std::string& hex) {
  std::istringstream words{hex};
  Bytes bytes;
  for (std::string word; words >> word;) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoul(word, nullptr, 16)));
  }
  return bytes;
}

}  // namespace palp::fake_hid

using palp::fake_hid::Bytes;
using palp::fake_hid::Device;

struct hid_device_ {
  Device* device;
};

namespace {

Bytes copied(const unsigned char* data, std::size_t length) { return {data, data + length}; }

int given(const Bytes& report, unsigned char* data, std::size_t length) {
  const std::size_t count = std::min(report.size(), length);
  std::copy_n(report.begin(), count, data);
  return static_cast<int>(count);
}

}  // namespace

extern "C" {

hid_device_info* hid_enumerate(unsigned short vendor, unsigned short product) {
  hid_device_info* first = nullptr;
  for (const auto& one : palp::fake_hid::devices()) {
    if (!one->there || (vendor != 0 && vendor != one->vendor) ||
        (product != 0 && product != one->product)) {
      continue;
    }
    auto* const info = new hid_device_info{};
    info->path = ::strdup(one->path.c_str());
    info->vendor_id = one->vendor;
    info->product_id = one->product;
    info->serial_number = const_cast<wchar_t*>(one->serial.c_str());
    info->product_string = const_cast<wchar_t*>(one->name.c_str());
    info->usage_page = one->usage_page;
    info->interface_number = one->interface_number;
    info->next = std::exchange(first, info);
  }
  return first;
}

void hid_free_enumeration(hid_device_info* first) {
  while (first != nullptr) {
    std::free(first->path);
    delete std::exchange(first, first->next);
  }
}

hid_device* hid_open_path(const char* path) {
  for (const auto& one : palp::fake_hid::devices()) {
    if (one->path != path || !one->openable || !one->there) continue;
    ++one->opened;
    one->open = true;
    return new hid_device_{one.get()};
  }
  return nullptr;
}

void hid_close(hid_device* handle) {
  if (handle == nullptr) return;
  handle->device->open = false;
  delete handle;
}

int hid_read_timeout(hid_device* handle, unsigned char* data, size_t length, int /*wait_ms*/) {
  Device& device = *handle->device;
  if (!device.there) return -1;
  device.before_read();
  if (device.input.empty()) return 0;
  const Bytes report = std::move(device.input.front());
  device.input.pop_front();
  return given(report, data, length);
}

int hid_write(hid_device* handle, const unsigned char* data, size_t length) {
  Device& device = *handle->device;
  if (!device.there || !device.writable) return -1;
  device.written.push_back(copied(data, length));
  device.on_write(device.written.back());
  return static_cast<int>(length);
}

int hid_send_feature_report(hid_device* handle, const unsigned char* data, size_t length) {
  Device& device = *handle->device;
  if (!device.there || !device.writable) return -1;
  device.features.push_back(copied(data, length));
  return static_cast<int>(length);
}

int hid_get_feature_report(hid_device* handle, unsigned char* data, size_t length) {
  Device& device = *handle->device;
  if (!device.there) return -1;
  const Bytes report = device.feature(data[0]);
  return report.empty() ? -1 : given(report, data, length);
}

const wchar_t* hid_error(hid_device* /*handle*/) { return L"no such device"; }
}
