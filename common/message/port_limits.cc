#include "common/message/port_limits.h"

#include <algorithm>
#include <cmath>

#include "common/message/field.h"

namespace palp::message {
namespace {

template <class Struct>
bool keep(Struct& of) noexcept;

template <class Item>
bool keep_item(const Item& item, auto& of) noexcept {
  auto& value = Item::of(of);
  bool acted = false;
  if constexpr (requires { item.choices; }) {
    each(item.choices, [&]<class Choice>(const Choice& /*choice*/) {
      auto* chosen = std::get_if<typename Choice::Type>(&value);
      acted = (chosen != nullptr && keep(*chosen)) || acted;
    });
  } else if constexpr (requires { item.most; }) {
    if (std::abs(value) <= item.most) return false;  // NaN: no
    value = std::isnan(value) ? 0 : std::clamp(value, -item.most, item.most);
    acted = true;
  }
  return acted;
}

template <class Struct>
bool keep(Struct& of) noexcept {
  bool acted = false;
  each(fields<Struct>.items, [&](const auto& item) { acted = keep_item(item, of) || acted; });
  return acted;
}

}  // namespace

bool keep_limits(PortSample& sample) noexcept { return keep(sample); }

}  // namespace palp::message
