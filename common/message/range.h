#pragma once

#include <cmath>
#include <type_traits>
#include <variant>

#include "common/message/field.h"
#include "common/message/kind.h"

/// The visitor that asks whether every number of a struct keeps its limits: on the wire those of
/// the list, in the log only that enumerators are known, because a file must not look at values.
/// Instantiated where the bytes are. Thread: any; allocates nothing.
namespace palp::message {

template <Form kForm, class Struct>
bool in_range(const Struct& of) noexcept;

template <Form kForm, unsigned kNumber, class Where, class... Options>
bool item_in_range(const Field<kNumber, Where, Options...>& field, const auto& of) noexcept {
  using Item = Field<kNumber, Where, Options...>;
  const auto& value = Item::of(of);
  using Value = std::remove_cvref_t<decltype(value)>;
  if constexpr (requires { Item::exists(of); }) {
    if (!Item::exists(of)) return true;
  }
  if constexpr (requires { field.none; }) {
    if (value == field.none) return true;
  }
  if constexpr (Described<Value>) {
    return in_range<kForm>(value);
  } else if constexpr (std::is_enum_v<Value>) {
    return number_of(value) < enumerators<Value>.values.size();
  } else if constexpr (kForm == Form::Wire && kIsText<Value>) {
    return value.size() <= Item::kTextMax;
  } else if constexpr (kForm == Form::Wire && requires { field.most; }) {
    if constexpr (std::is_floating_point_v<Value>) {
      return std::abs(value) <= field.most;  // NaN: no
    } else {
      return value <= field.most;
    }
  } else {
    static_assert(kForm == Form::Log || !std::is_floating_point_v<Value>,
                  "what crosses has a limit");
    return true;
  }
}

template <Form kForm, class Where>
bool item_in_range(const Aside<Where>& /*aside*/, const auto& /*of*/) noexcept {
  return true;
}

template <Form kForm, unsigned kBase, class Where>
bool item_in_range(const Spread<kBase, Where>& /*spread*/, const auto& of) noexcept {
  const auto& within = Where::of(of);
  if constexpr (kIsOptional<std::remove_cvref_t<decltype(within)>>) {
    return !within || in_range<kForm>(*within);
  } else {
    return in_range<kForm>(within);
  }
}

/// A raw copy may hold any index: then none of these, and not in range.
template <Form kForm, class Where, class... Choices>
bool item_in_range(const OneOf<Where, Choices...>& one_of, const auto& of) noexcept {
  const auto& variant = Where::of(of);
  if (std::holds_alternative<std::monostate>(variant)) return true;
  return !all(one_of.choices, [&]<class Item>(const Item& /*choice*/) {
    const auto* chosen = std::get_if<typename Item::Type>(&variant);
    return chosen == nullptr || !in_range<kForm>(*chosen);
  });
}

template <Form kForm, class Struct>
bool in_range(const Struct& of) noexcept {
  return all(fields<Struct>.items,
             [&](const auto& item) { return item_in_range<kForm>(item, of); });
}

}  // namespace palp::message
