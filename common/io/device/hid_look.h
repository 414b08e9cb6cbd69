#pragma once

#include <string>
#include <vector>

#include "common/io/device/report_port.h"

namespace palp::io {

/// A product, and all that it may call itself; one with several interfaces by the first of them.
struct HidProduct {
  std::string name;
  std::vector<HidAddress> addresses;
};

/// What a first look for a product gave.
struct HidLook {
  std::string product;
  std::string address;  ///< "hid:/dev/hidraw3"; empty: not there
  bool usable{};
  std::string found;  ///< its own name and serial number, or why it cannot be used; for people
};

/// Every device of these products that is there, and a line for each product of which none is.
/// Opens and closes; sends nothing. Blocks.
[[nodiscard]] std::vector<HidLook> look_for_hid(const std::vector<HidProduct>& products);

}  // namespace palp::io
