#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "common/core/time.h"
#include "common/io/device/register_port.h"

namespace palp::io {

/// Which HID interface is meant: all that is given must agree.
struct HidAddress {
  std::uint16_t vendor{};
  std::uint16_t product{};
  int interface_number{-1};    ///< -1: any
  std::uint16_t usage_page{};  ///< 0: any
  std::string serial;          ///< empty: any
};

/// Reports of one HID interface. Thread: its device's.
class ReportPort {
 public:
  virtual ~ReportPort() = default;
  virtual PortFault open() = 0;
  virtual void close() = 0;  ///< idempotent
  /// The next input report, in the order in which they came, into `report`; `length` [bytes] counts
  /// the id where the device uses ids. 0: none came within `wait`; that is no fault.
  virtual PortFault read(std::span<std::uint8_t> report, std::size_t& length, Duration wait) = 0;
  /// An output report; the first byte is its id, 0 where the device uses none.
  virtual PortFault write(std::span<const std::uint8_t> report) = 0;
  virtual PortFault set_feature(std::span<const std::uint8_t> report) = 0;
  /// `report` holds the id first; `length` [bytes] counts it.
  virtual PortFault get_feature(std::span<std::uint8_t> report, std::size_t& length) = 0;
};

}  // namespace palp::io
