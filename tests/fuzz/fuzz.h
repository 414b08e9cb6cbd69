#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

/// What a fuzzer calls with each input; the laws in it are PALP_CHECKs. Always returns 0.
// NOLINTNEXTLINE(readability-identifier-naming): the name is libFuzzer's
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace palp::fuzz {

inline std::span<const std::byte> as_bytes(const std::uint8_t* data, std::size_t size) {
  return std::as_bytes(std::span{data, size});
}

inline std::string_view as_text(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Reads an input as numbers, one after the other; behind its end all are 0.
class ByteSource {
 public:
  explicit ByteSource(std::span<const std::byte> bytes) : rest_{bytes} {}

  /// The next number, its first byte the lowest.
  template <class Unsigned>
  Unsigned take() {
    std::uint64_t value = 0;
    const auto bytes = take_bytes(sizeof(Unsigned));
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      value |= std::to_integer<std::uint64_t>(bytes[i]) << (8 * i);
    }
    return static_cast<Unsigned>(value);
  }
  /// 0 <= result < limit <= 256.
  std::size_t below(std::size_t limit) { return take<std::uint8_t>() % limit; }
  std::span<const std::byte> take_bytes(std::size_t count) {
    const auto taken = rest_.first(std::min(count, rest_.size()));
    rest_ = rest_.subspan(taken.size());
    return taken;
  }
  /// 2^k - 1 + a little: all magnitudes alike, so that borders are near.
  std::uint64_t magnitude() {
    const unsigned shift = take<std::uint8_t>() % 64U;
    return (std::uint64_t{1} << shift) - 1 + take<std::uint8_t>() % 4U;
  }
  [[nodiscard]] bool empty() const { return rest_.empty(); }

 private:
  std::span<const std::byte> rest_;
};

}  // namespace palp::fuzz
