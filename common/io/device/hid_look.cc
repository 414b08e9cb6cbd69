#include "common/io/device/hid_look.h"

#include <algorithm>

#include "common/io/device/hid_port.h"

namespace palp::io {

std::vector<HidLook> look_for_hid(const std::vector<HidProduct>& products) {
  const std::vector<HidFound> there = list_hid();
  std::vector<HidLook> looks;
  for (const HidProduct& product : products) {
    const std::size_t before = looks.size();
    for (const HidFound& one : there) {
      const bool is_one = std::ranges::any_of(
          product.addresses, [&](const HidAddress& address) { return agrees(one, address); });
      if (!is_one) continue;
      HidLook look{.product = product.name,
                   .address = "hid:" + one.path,
                   .usable = false,
                   .found = one.name + (one.serial.empty() ? "" : ", serial " + one.serial)};
      const auto why_not = why_not_opened(one);
      look.usable = !why_not;
      if (why_not) look.found = *why_not;
      looks.push_back(std::move(look));
    }
    if (looks.size() > before) continue;
    looks.push_back({.product = product.name, .address = {}, .usable = false, .found = "absent"});
  }
  return looks;
}

}  // namespace palp::io
