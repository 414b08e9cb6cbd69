#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

/// hidapi's C functions over devices in memory, linked in place of the library: what our code hands
/// to hidapi, and what it makes of hidapi's answers, byte for byte.
namespace palp::fake_hid {

using Bytes = std::vector<std::uint8_t>;

struct Device {
  std::string path;
  std::uint16_t vendor{};
  std::uint16_t product{};
  int interface_number{};
  std::uint16_t usage_page{};
  std::wstring serial;
  std::wstring name;
  bool openable{true};
  bool writable{true};
  bool there{true};  ///< else unplugged: not listed, reads fail
  std::deque<Bytes> input;
  std::vector<Bytes> written;   ///< output reports as hid_write was given them
  std::vector<Bytes> features;  ///< as hid_send_feature_report was given them
  std::function<void(const Bytes&)> on_write{[](const Bytes&) {}};
  std::function<void()> before_read{[] {}};  ///< of each read: a device that lives in time
  std::function<Bytes(std::uint8_t id)> feature{[](std::uint8_t) { return Bytes{}; }};
  int opened{};  ///< times
  bool open{};
};

/// Plugs one in; it stays where it is until clear().
Device& plug(Device device);
/// A machine without devices. No handle may be open.
void clear();

/// Reads "50 50 01", as the documents write bytes.
Bytes bytes_of(const std::string& hex);

}  // namespace palp::fake_hid
