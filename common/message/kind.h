#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>

#include "common/message/field.h"
#include "common/message/wire_format.h"

/// What the type of a member means for the visitors of lists.
namespace palp::message {

/// Of a field, in the struct where it stands.
template <class Item, class Struct>
using ValueOf = std::remove_cvref_t<decltype(Item::of(std::declval<Struct&>()))>;

template <class Value>
inline constexpr bool kIsTime = requires(Value value) {
  value.time_since_epoch();
};
template <class Value>
inline constexpr bool kIsSpan = requires(Value value) {
  value.count();
};
template <class Value>
inline constexpr bool kIsText = std::is_convertible_v<const Value&, std::string_view>;
template <class Value>
inline constexpr bool kIsOptional = false;
template <class Value>
inline constexpr bool kIsOptional<std::optional<Value>> = true;

/// A member as the plain number that is told: instants and spans in nanoseconds, enums as whole
/// numbers.
template <class Value>
constexpr auto number_of(const Value& value) noexcept {
  if constexpr (std::is_enum_v<Value>) {
    return static_cast<std::underlying_type_t<Value>>(value);
  } else if constexpr (kIsTime<Value>) {
    return std::int64_t{value.time_since_epoch().count()};
  } else if constexpr (kIsSpan<Value>) {
    return std::int64_t{value.count()};
  } else {
    static_assert(std::is_arithmetic_v<Value>, "a member of this type has no place in a list");
    return value;
  }
}
template <class Value>
using NumberOf = decltype(number_of(std::declval<const Value&>()));

/// The other way round.
template <class Value>
constexpr Value from_number(NumberOf<Value> number) noexcept {
  if constexpr (kIsTime<Value>) {
    return Value{typename Value::duration{number}};
  } else {
    return static_cast<Value>(number);
  }
}

/// The number that a field or a choice has in a form.
template <Form kForm, class Item>
constexpr unsigned number_in() noexcept {
  if constexpr (kForm == Form::Log && requires { Item::kLogNumber; }) {
    return Item::kLogNumber;
  } else {
    return Item::kNumber;
  }
}

/// Its type in a form: `Number`, or what is narrower there.
template <Form kForm, class Item, class Number>
constexpr auto width_of() noexcept {
  constexpr bool kNarrow = requires { typename Item::Narrow; };
  if constexpr (kNarrow && (kForm == Form::Wire || requires { Item::kInLog; })) {
    return typename Item::Narrow{};
  } else {
    return Number{};
  }
}
template <Form kForm, class Item, class Number>
using WidthOf = decltype(width_of<kForm, Item, Number>());

template <Form kForm, class Item, class Value>
constexpr WireType wire_type_of() noexcept {
  if constexpr (Described<Value> || kIsText<Value>) {
    return WireType::Part;
  } else if constexpr (std::is_floating_point_v<NumberOf<Value>> ||
                       std::is_base_of_v<FixedWidth, Item>) {
    return fixed_type<WidthOf<kForm, Item, NumberOf<Value>>>();
  } else {
    return WireType::Varint;
  }
}

template <Form kForm, unsigned kBase, class Item, class Value>
inline constexpr std::uint16_t kTagOf = wire_tag(kBase + number_in<kForm, Item>(),
                                                 wire_type_of<kForm, Item, Value>());

}  // namespace palp::message
