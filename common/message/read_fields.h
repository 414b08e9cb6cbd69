#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <variant>

#include "common/message/field.h"
#include "common/message/kind.h"
#include "common/message/text_encoding.h"
#include "common/message/wire_format.h"

/// The visitor that makes a struct of its bytes, in whatever order they come. On the wire, what the
/// list does not know and what comes twice is refused. In the log it is skipped, and what comes
/// last counts, as with protobuf's own parser, so that files of newer programs can be read. Whether
/// numbers keep their limits is asked behind it (range.h). Each form is instantiated in one source,
/// wire_bytes.cc and log_bytes.cc. Thread: any; allocates nothing.
namespace palp::message {

template <Form kForm>
inline constexpr bool kStrict = kForm == Form::Wire;

/// Which fields of a message were there: bit n is field n.
using Seen = std::uint64_t;

/// What a read goes through.
struct Reading {
  WireReader in;
  Seen seen{};
  bool any{};  ///< in this pass over the list a field was read
};

template <unsigned kNumber>
constexpr Seen bit() noexcept {
  static_assert(kNumber < std::numeric_limits<Seen>::digits);
  return Seen{1} << kNumber;
}

/// What a message without bytes says: 0 everywhere, whatever a struct begins with.
template <class Struct>
void clear(Struct& out) noexcept {
  each(fields<Struct>.items, [&]<class Item>(const Item& item) {
    auto& value = Item::of(out);
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (requires { item.none; }) {
      value = item.none;
    } else if constexpr (requires { item.choices; } || kIsOptional<Value> || kIsText<Value>) {
      value = {};
    } else if constexpr (Described<Value>) {
      clear(value);
    } else if constexpr (requires { Item::kNumber; }) {
      value = from_number<Value>(0);
    }
  });
}

/// `to` is clear, or holds what came before it of the same message.
template <Form kForm, class Struct>
bool read(WireReader in, Struct& to, Seen& seen) noexcept;

template <Form kForm, class Struct>
bool read_part(WireReader& in, Struct& to) noexcept {
  WireReader part{{}};
  Seen seen = 0;
  return in.take_part(part) && read<kForm>(part, to, seen);
}

/// Of ours all enumerators fit into one byte. What an enum cannot hold becomes one out of range.
template <class Value>
bool read_varint(WireReader& in, Value& to) noexcept {
  using Number = NumberOf<Value>;
  std::uint64_t value = 0;
  if (!in.take_varint(value)) return false;
  if constexpr (std::is_same_v<Value, bool>) {
    to = value != 0;
  } else if constexpr (std::is_enum_v<Value>) {
    constexpr std::uint32_t kOutOfRange = std::numeric_limits<std::uint8_t>::max();
    static_assert(sizeof(Value) == 1);
    to = static_cast<Value>(std::min(static_cast<std::uint32_t>(value), kOutOfRange));
  } else if constexpr (sizeof(Number) < sizeof(std::uint32_t)) {
    if (static_cast<std::uint32_t>(value) > std::numeric_limits<Number>::max()) return false;
    to = static_cast<Value>(value);
  } else {
    to = from_number<Value>(static_cast<Number>(value));
  }
  return true;
}

template <Form kForm, class Item, class Value>
bool read_number(const Item& item, WireReader& in, Value& to) noexcept {
  if constexpr (wire_type_of<kForm, Item, Value>() != WireType::Varint) {
    WidthOf<kForm, Item, NumberOf<Value>> value{};
    if (!in.take_fixed(value)) return false;
    to = value;
  } else {
    if (!read_varint(in, to)) return false;
  }
  if constexpr (requires { item.none; }) return to != item.none;
  return true;
}

template <Form kForm, unsigned kBase, unsigned kNumber, class Where, class... Options>
bool read_item(const Field<kNumber, Where, Options...>& field,
               Reading& reading,
               auto& to) noexcept {
  using Item = Field<kNumber, Where, Options...>;
  using Value = ValueOf<Item, std::remove_cvref_t<decltype(to)>>;
  constexpr Seen kBit = bit<kBase + number_in<kForm, Item>()>();
  if (!reading.in.skip<kTagOf<kForm, kBase, Item, Value>>()) return true;
  if (kStrict<kForm> && (reading.seen & kBit) != 0) return false;
  reading.seen |= kBit;
  reading.any = true;
  Value& value = Item::of(to);
  if constexpr (Described<Value>) {
    if (!read_part<kForm>(reading.in, value)) return false;
    if constexpr (requires { Item::says_nothing(value); }) {
      if (Item::says_nothing(value)) value = {};  // whatever else it says
    }
    return true;
  } else if constexpr (kIsText<Value>) {
    std::span<const std::byte> bytes;
    if (!reading.in.take_bytes(bytes)) return false;
    value = as_text(bytes);
    return kForm == Form::Wire || is_utf8(as_text(bytes));
  } else {
    return read_number<kForm>(field, reading.in, value);
  }
}

template <Form kForm, unsigned kBase, class Where>
bool read_item(const Aside<Where>& /*aside*/, Reading& /*reading*/, auto& /*to*/) noexcept {
  return true;
}

template <Form kForm, unsigned kBase, unsigned kOffset, class Where>
bool read_item(const Spread<kOffset, Where>& /*spread*/, Reading& reading, auto& to) noexcept {
  auto& within = Where::of(to);
  const auto read_into = [&reading](auto& part) {
    return all(fields<std::remove_cvref_t<decltype(part)>>.items, [&](const auto& item) {
      return read_item<kForm, kBase + kOffset>(item, reading, part);
    });
  };
  if constexpr (kIsOptional<std::remove_cvref_t<decltype(within)>>) {
    typename std::remove_cvref_t<decltype(within)>::value_type part{};
    if (within) {
      part = *within;
    } else {
      clear(part);
    }
    const bool any_before = reading.any;
    reading.any = false;
    const bool good = read_into(part);
    if (reading.any) within = part;
    reading.any = reading.any || any_before;
    return good;
  } else {
    return read_into(within);
  }
}

template <Form kForm, unsigned kBase, class Where, class... Choices>
bool read_item(const OneOf<Where, Choices...>& one_of, Reading& reading, auto& to) noexcept {
  constexpr Seen kAnyOfThem = (bit<kBase + number_in<kForm, Choices>()>() | ...);
  auto& variant = Where::of(to);
  using Variant = std::remove_cvref_t<decltype(variant)>;
  return all(one_of.choices, [&]<class Item>(const Item& /*choice*/) {
    using Chosen = typename Item::Type;
    constexpr unsigned kNumber = kBase + number_in<kForm, Item>();
    if (!reading.in.skip<wire_tag(kNumber, WireType::Part)>()) return true;
    if (kStrict<kForm> && (reading.seen & kAnyOfThem) != 0) return false;
    reading.seen |= bit<kNumber>();
    reading.any = true;
    if (!std::holds_alternative<Chosen>(variant)) {
      variant = Variant{std::in_place_type<Chosen>};
      clear(*std::get_if<Chosen>(&variant));
    }
    return read_part<kForm>(reading.in, *std::get_if<Chosen>(&variant));
  });
}

/// An optional struct whose first field was not there is not there.
template <Form kForm, unsigned kBase>
void finish_item(const auto& /*item*/, Seen /*seen*/, auto& /*to*/) noexcept {}
template <Form kForm, unsigned kBase, unsigned kOffset, class Where>
void finish_item(const Spread<kOffset, Where>& /*spread*/, Seen seen, auto& to) noexcept {
  auto& within = Where::of(to);
  using Within = std::remove_cvref_t<decltype(within)>;
  if constexpr (kIsOptional<Within>) {
    constexpr auto kFirst = std::get<0>(fields<typename Within::value_type>.items);
    static_assert(std::is_base_of_v<Always, decltype(kFirst)>, "tells that the rest is there");
    if ((seen & bit<kBase + kOffset + decltype(kFirst)::kNumber>()) == 0) within.reset();
  } else {
    each(fields<Within>.items,
         [&](const auto& item) { finish_item<kForm, kBase + kOffset>(item, seen, within); });
  }
}

/// In the order of the list all is read at one go; each field out of it costs another.
template <Form kForm, class Struct>
bool read(WireReader in, Struct& to, Seen& seen) noexcept {
  Reading reading{.in = in};
  while (!reading.in.empty()) {
    reading.any = false;
    const bool good = all(fields<Struct>.items,
                          [&](const auto& item) { return read_item<kForm, 0>(item, reading, to); });
    if (!good) return false;
    if (reading.any) continue;
    if (kStrict<kForm> || !reading.in.skip_field()) return false;
  }
  each(fields<Struct>.items,
       [&](const auto& item) { finish_item<kForm, 0>(item, reading.seen, to); });
  seen = reading.seen;
  return true;
}

}  // namespace palp::message
