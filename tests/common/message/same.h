#pragma once

#include <bit>
#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

#include "common/message/each_value.h"

/// Structs of lists compared to the last bit, so that NaN is itself and -0.0 is not 0.0.
namespace palp::message {

using Words = std::vector<std::uint64_t>;

template <class Struct>
void add_words(const Struct& of, Words& words) {
  each_value(of, [&](std::string_view /*prefix*/, const auto& /*item*/, auto number) {
    if constexpr (std::is_same_v<decltype(number), double>) {
      words.push_back(std::bit_cast<std::uint64_t>(number));
    } else {
      words.push_back(static_cast<std::uint64_t>(number));
    }
  });
}

/// Every number of a struct, or of what a variant of structs holds, and which that is.
template <class Struct>
Words words_of(const Struct& of) {
  Words words;
  if constexpr (Described<Struct>) {
    add_words(of, words);
  } else {
    words.push_back(of.index());
    std::visit([&](const auto& one) { add_words(one, words); }, of);
  }
  return words;
}

template <class Struct>
bool same(const Struct& a, const Struct& b) {
  return words_of(a) == words_of(b);
}

}  // namespace palp::message
