#pragma once

#include <cstddef>
#include <string_view>
#include <variant>

#include "common/message/field.h"
#include "common/message/kind.h"

/// The visitor that tells every number of a struct, what lies aside included: for digests and for
/// people. Include it in sources only. Thread: any; allocates nothing.
namespace palp::message {

/// What stands for a payload's kind and for whether an optional struct is there.
struct Presence {
  FieldName name;
};

/// Calls visit(prefix, item, number) for each, in the order of the list; text is left out.
template <class Struct>
void each_value(const Struct& of, auto&& visit, std::string_view prefix = {}) noexcept;

template <class Item>
void each_value_of_item(const Item& item,
                        const auto& of,
                        auto&& visit,
                        std::string_view prefix) noexcept {
  const auto& value = Item::of(of);
  using Value = std::remove_cvref_t<decltype(value)>;
  if constexpr (requires { Item::exists(of); }) {
    if (!Item::exists(of)) return;
  }
  if constexpr (requires { item.choices; }) {
    visit(prefix, Presence{item.name.data()}, value.index());
    each(item.choices, [&]<class Choice>(const Choice& choice) {
      const auto* chosen = std::get_if<typename Choice::Type>(&value);
      if (chosen != nullptr) each_value(*chosen, visit, choice.name);
    });
  } else if constexpr (kIsOptional<Value>) {
    visit(prefix, Presence{item.prefix.data()}, value.has_value());
    if (value) each_value(*value, visit, item.prefix);
  } else if constexpr (requires { item.prefix; }) {
    each_value(value, visit, item.prefix);
  } else if constexpr (Described<Value>) {
    each_value(value, visit, item.name.surgeon);
  } else if constexpr (!kIsText<Value>) {
    visit(prefix, item, number_of(value));
  }
}

template <class Struct>
void each_value(const Struct& of, auto&& visit, std::string_view prefix) noexcept {
  each(fields<Struct>.items,
       [&](const auto& item) { each_value_of_item(item, of, visit, prefix); });
}

}  // namespace palp::message
