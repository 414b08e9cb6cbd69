#pragma once

#include <bit>
#include <cstdint>

#include "common/core/random.h"
#include "common/message/field.h"
#include "common/message/kind.h"

/// Random structs for tests, filled by their lists: everything they hold is drawn from a seed.
namespace palp::message {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : seed_{seed} {}
  std::uint64_t bits() { return random_bits(seed_, 0, next_++); }
  std::uint64_t below(std::uint64_t limit) { return bits() % limit; }
  /// In [-limit, limit]: mostly ordinary, now and then an edge.
  double within(double limit) {
    switch (below(8)) {
      case 0:
        return 0.0;
      case 1:
        return -0.0;
      case 2:
        return limit;
      case 3:
        return -limit;
      default:
        return limit * (2 * random_uniform(seed_, 1, next_++) - 1);
    }
  }

 private:
  std::uint64_t seed_;
  std::uint64_t next_{};
};

/// On the wire within the limits; in the log any bit pattern, NaN and -0 among them.
template <Form kForm, class Struct>
void draw_into(Struct& out, Draw& draw);

template <Form kForm, class Item>
void draw_value(const Item& item, auto& value, Draw& draw) {
  using Value = std::remove_cvref_t<decltype(value)>;
  using Number = NumberOf<Value>;
  if constexpr (requires { item.none; }) {
    if (draw.below(4) == 0) {
      value = item.none;
      return;
    }
  }
  if constexpr (std::is_enum_v<Value>) {
    value = static_cast<Value>(draw.below(enumerators<Value>.values.size()));
  } else if constexpr (std::is_floating_point_v<Number>) {
    if constexpr (kForm == Form::Wire && requires { item.most; }) {
      value = draw.within(item.most);
    } else if constexpr (std::is_same_v<WidthOf<kForm, Item, Number>, float>) {
      value = std::bit_cast<float>(static_cast<std::uint32_t>(draw.bits()));
    } else {
      value = std::bit_cast<double>(draw.bits());
    }
  } else if constexpr (kForm == Form::Wire && requires { item.most; }) {
    value = static_cast<Value>(draw.below(item.most + 1));
  } else if constexpr (std::is_same_v<Value, bool>) {
    value = draw.below(2) == 1;
  } else {
    // Often small, so that 0 and all sizes occur.
    value = from_number<Value>(static_cast<Number>(draw.bits() >> draw.below(64)));
  }
}

template <Form kForm, class Item>
void draw_item(const Item& item, auto& out, Draw& draw) {
  auto& value = Item::of(out);
  using Value = std::remove_cvref_t<decltype(value)>;
  if constexpr (requires { item.choices; }) {
    std::uint64_t chosen = draw.below(std::variant_size_v<Value>);
    value = std::monostate{};
    each(item.choices, [&]<class Choice>(const Choice& /*choice*/) {
      if (chosen-- == 1) {
        draw_into<kForm>(value.template emplace<typename Choice::Type>(), draw);
      }
    });
  } else if constexpr (kIsOptional<Value>) {
    value.reset();
    if (draw.below(2) == 0) draw_into<kForm>(value.emplace(), draw);
  } else if constexpr (requires { Item::says_nothing(value); }) {
    value = {};
    if (draw.below(3) != 0) draw_into<kForm>(value, draw);
    if (Item::says_nothing(value)) value = {};
  } else if constexpr (Described<Value>) {
    draw_into<kForm>(value, draw);
  } else if constexpr (kIsText<Value>) {
    value = "some text";
  } else {
    draw_value<kForm>(item, value, draw);
  }
}

template <Form kForm, class Struct>
void draw_into(Struct& out, Draw& draw) {
  each(fields<Struct>.items, [&](const auto& item) { draw_item<kForm>(item, out, draw); });
}

template <Form kForm, class Struct>
Struct drawn(std::uint64_t seed) {
  Draw draw{seed};
  Struct out{};
  draw_into<kForm>(out, draw);
  return out;
}

/// As it comes out of the schema's `float` fields; sums stay double.
template <class Struct>
void round_as_on_wire(Struct& of) {
  each(fields<Struct>.items, [&]<class Item>(const Item& item) {
    auto& value = Item::of(of);
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (requires { item.choices; }) {
      each(item.choices, [&]<class Choice>(const Choice& /*choice*/) {
        auto* chosen = std::get_if<typename Choice::Type>(&value);
        if (chosen != nullptr) round_as_on_wire(*chosen);
      });
    } else if constexpr (Described<Value>) {
      round_as_on_wire(value);
    } else if constexpr (requires { typename Item::Narrow; }) {
      value = Value{static_cast<typename Item::Narrow>(value)};
    }
  });
}

}  // namespace palp::message
