#include "common/message/health_counters.h"

#include "common/message/each_value.h"

namespace palp::message {
namespace {

template <class Option>
Counters with(const LinkHealth& health) {
  Counters counters;
  each_value(health, [&]<class Item>(std::string_view /*prefix*/, const Item& item, auto number) {
    if constexpr (std::is_base_of_v<Option, Item>) {
      counters.emplace_back(item.name.surgeon, number);
    }
  });
  return counters;
}

}  // namespace

Counters refusals_of(const LinkHealth& health) { return with<CountsRefusals>(health); }
Counters counters_of(const LinkHealth& health) { return with<Counts>(health); }

}  // namespace palp::message
