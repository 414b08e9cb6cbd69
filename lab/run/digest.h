#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <cstdio>
#include <string>

namespace palp::lab {

/// A running 64-bit hash over numbers, for "same seed, same bits". Not for security.
class Digest {
 public:
  void add(std::uint64_t word) noexcept {
    state_ ^= word;
    state_ *= 0x9fb21c651e98df25ULL;  // odd: the step is a bijection, no input is forgotten
    state_ ^= state_ >> 29;
  }
  void add(double value) noexcept { add(std::bit_cast<std::uint64_t>(value)); }
  template <std::integral T>
  requires(!std::same_as<T, std::uint64_t>) void add(T value) noexcept {
    add(static_cast<std::uint64_t>(value));
  }
  [[nodiscard]] std::uint64_t value() const noexcept { return state_; }

 private:
  std::uint64_t state_{0x6a09e667f3bcc908ULL};
};

/// Of sixteen digits, as reports and files have it.
[[nodiscard]] inline std::string hexadecimal(std::uint64_t value) {
  std::array<char, 17> text{};
  std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(value));
  return text.data();
}

}  // namespace palp::lab
