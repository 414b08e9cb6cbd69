#include "common/message/warm_up_telegrams.h"

#include "common/message/kind.h"

namespace palp::message {
namespace {

/// Sets every number of a struct to 1, which is in the limits of all.
template <class Struct>
void fill(Struct& out) noexcept {
  each(fields<Struct>.items, [&]<class Item>(const Item& item) {
    auto& value = Item::of(out);
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (requires { item.choices; }) {
      each(item.choices, [&]<class Choice>(const Choice& /*choice*/) {
        auto* chosen = std::get_if<typename Choice::Type>(&value);
        if (chosen != nullptr) fill(*chosen);
      });
    } else if constexpr (Described<Value>) {
      fill(value);
    } else {
      value = from_number<Value>(1);
    }
  });
}

using Telegrams = std::array<Telegram, std::variant_size_v<CouplingPayload>>;

Telegrams make() noexcept {
  Telegrams telegrams;
  each(fields<PortSample>.items, [&](const auto& item) {
    if constexpr (requires { item.choices; }) {
      std::size_t kind = 0;
      each(item.choices, [&]<class Choice>(const Choice& /*choice*/) {
        telegrams[++kind].port.payload.template emplace<typename Choice::Type>();
      });
    }
  });
  for (Telegram& telegram : telegrams) {
    fill(telegram.site);
    fill(telegram.port);
  }
  return telegrams;
}

const Telegrams kTelegrams = make();

}  // namespace

const Telegrams& warm_up_telegrams() noexcept { return kTelegrams; }

}  // namespace palp::message
