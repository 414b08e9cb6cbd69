#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <variant>

#include "common/message/field.h"
#include "common/message/kind.h"
#include "common/message/wire_format.h"

/// The visitor that makes a struct's bytes: those of protobuf, in the order of the list. Each form
/// is instantiated in one source, wire_bytes.cc and log_bytes.cc. Thread: any; allocates nothing.
namespace palp::message {

/// The most bytes that a struct takes.
template <Form kForm, class Struct, unsigned kBase = 0>
constexpr std::size_t size_max() noexcept;

template <Form kForm, class Value>
constexpr std::size_t part_size_max() noexcept {
  constexpr std::size_t kMost = size_max<kForm, Value>();
  static_assert(kMost <= kPartSizeMax);
  return size_of_size(kMost) + kMost;
}

template <Form kForm, unsigned kBase, class Struct, unsigned kNumber, class Where, class... Options>
constexpr std::size_t size_max(const Field<kNumber, Where, Options...>& /*field*/) noexcept {
  using Item = Field<kNumber, Where, Options...>;
  using Value = ValueOf<Item, Struct>;
  constexpr std::size_t kTag = tag_size(kTagOf<kForm, kBase, Item, Value>);
  if constexpr (Described<Value>) {
    return kTag + part_size_max<kForm, Value>();
  } else if constexpr (kIsText<Value>) {
    return kTag + size_of_size(Item::kTextMax) + Item::kTextMax;
  } else if constexpr (wire_type_of<kForm, Item, Value>() != WireType::Varint) {
    return kTag + sizeof(WidthOf<kForm, Item, NumberOf<Value>>);
  } else {
    return kTag + (std::is_enum_v<Value> ? 1 : kVarintSizeMax);
  }
}

template <Form kForm, unsigned kBase, class Struct, class Where>
constexpr std::size_t size_max(const Aside<Where>& /*aside*/) noexcept {
  return 0;
}

template <Form kForm, unsigned kBase, class Struct, unsigned kOffset, class Where>
constexpr std::size_t size_max(const Spread<kOffset, Where>& /*spread*/) noexcept {
  using Value = ValueOf<Spread<kOffset, Where>, Struct>;
  if constexpr (kIsOptional<Value>) {
    return size_max<kForm, typename Value::value_type, kBase + kOffset>();
  } else {
    return size_max<kForm, Value, kBase + kOffset>();
  }
}

template <Form kForm, unsigned kBase, class Struct, class Where, class... Choices>
constexpr std::size_t size_max(const OneOf<Where, Choices...>& /*one_of*/) noexcept {
  return std::max({std::size_t{0},
                   tag_size(wire_tag(kBase + number_in<kForm, Choices>(), WireType::Part)) +
                       part_size_max<kForm, typename Choices::Type>()...});
}

template <Form kForm, class Struct, unsigned kBase>
constexpr std::size_t size_max() noexcept {
  std::size_t sum = 0;
  each(fields<Struct>.items,
       [&](const auto& item) { sum += size_max<kForm, kBase, Struct>(item); });
  return sum;
}

/// Writes a struct; the writer has room for size_max().
template <Form kForm, unsigned kBase = 0, class Struct>
void write(const Struct& from, WireWriter& out) noexcept;

template <Form kForm, std::uint16_t kTag>
void write_part(const auto& part, WireWriter& out) noexcept {
  out.put_tag<kTag>();
  std::byte* size = out.begin_part();
  write<kForm>(part, out);
  out.end_part(size);
}

template <Form kForm, class Item>
void write_number(const Item& item, auto number, WireWriter& out, auto put_tag) noexcept {
  using Number = decltype(number);
  using Width = WidthOf<kForm, Item, Number>;
  constexpr bool kAlways = std::is_base_of_v<Always, Item>;
  if constexpr (std::is_floating_point_v<Number>) {
    using Bits = std::conditional_t<sizeof(Width) == 4, std::uint32_t, std::uint64_t>;
    const auto bits = std::bit_cast<Bits>(static_cast<Width>(number));
    if (!kAlways && bits == 0) return;  // -0.0 is written
    put_tag();
    out.put_fixed(bits);
  } else if constexpr (requires { item.none; }) {
    if (number == item.none) return;
    put_tag();
    out.put_varint(number);
  } else {
    if (!kAlways && number == 0) return;
    put_tag();
    if constexpr (std::is_base_of_v<FixedWidth, Item>) {
      out.put_fixed(number);
    } else {
      out.put_varint(static_cast<std::uint64_t>(number));
    }
  }
}

template <Form kForm, unsigned kBase, unsigned kNumber, class Where, class... Options>
void write_item(const Field<kNumber, Where, Options...>& field,
                const auto& from,
                WireWriter& out) noexcept {
  using Item = Field<kNumber, Where, Options...>;
  using Value = ValueOf<Item, std::remove_cvref_t<decltype(from)>>;
  constexpr std::uint16_t kTag = kTagOf<kForm, kBase, Item, Value>;
  const Value& value = Item::of(from);
  if constexpr (requires { Item::exists(from); }) {
    if (!Item::exists(from)) return;
  }
  if constexpr (requires { Item::says_nothing(value); }) {
    if (Item::says_nothing(value)) return;
  }
  if constexpr (Described<Value>) {
    write_part<kForm, kTag>(value, out);
  } else if constexpr (kIsText<Value>) {
    const std::string_view text = std::string_view{value}.substr(0, Item::kTextMax);
    if (text.empty() && !std::is_base_of_v<Always, Item>) return;
    out.put_tag<kTag>();
    out.put_bytes(std::as_bytes(std::span{text}));
  } else {
    write_number<kForm>(field, number_of(value), out, [&] { out.put_tag<kTag>(); });
  }
}

template <Form kForm, unsigned kBase, class Where>
void write_item(const Aside<Where>& /*aside*/, const auto& /*from*/, WireWriter& /*out*/) noexcept {
}

template <Form kForm, unsigned kBase, unsigned kOffset, class Where>
void write_item(const Spread<kOffset, Where>& /*spread*/,
                const auto& from,
                WireWriter& out) noexcept {
  const auto& within = Where::of(from);
  if constexpr (kIsOptional<std::remove_cvref_t<decltype(within)>>) {
    if (within) write<kForm, kBase + kOffset>(*within, out);
  } else {
    write<kForm, kBase + kOffset>(within, out);
  }
}

template <Form kForm, unsigned kBase, class Where, class... Choices>
void write_item(const OneOf<Where, Choices...>& one_of,
                const auto& from,
                WireWriter& out) noexcept {
  const auto& variant = Where::of(from);
  static_assert(
      std::variant_size_v<std::remove_cvref_t<decltype(variant)>> == sizeof...(Choices) + 1,
      "each alternative has its choice");
  each(one_of.choices, [&]<class Item>(const Item& /*choice*/) {
    const auto* chosen = std::get_if<typename Item::Type>(&variant);
    constexpr std::uint16_t kTag = wire_tag(kBase + number_in<kForm, Item>(), WireType::Part);
    if (chosen != nullptr) write_part<kForm, kTag>(*chosen, out);
  });
}

template <Form kForm, unsigned kBase, class Struct>
void write(const Struct& from, WireWriter& out) noexcept {
  each(fields<Struct>.items, [&](const auto& item) { write_item<kForm, kBase>(item, from, out); });
}

}  // namespace palp::message
