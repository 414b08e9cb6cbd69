#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "common/core/check.h"

/// The primitives of protobuf's wire format (protobuf.dev, "Encoding"): what a message of proto3
/// without repeated fields is made of. Thread: any; allocates nothing.
namespace palp::link {

static_assert(std::endian::native == std::endian::little,
              "fixed numbers are copied as they lie in memory");

/// Tags of field numbers below 16, the only ones there are: one byte.
enum class WireType : std::uint8_t { Varint = 0, Fixed64 = 1, Part = 2, Fixed32 = 5 };

constexpr std::uint8_t wire_tag(unsigned number, WireType type) noexcept {
  return static_cast<std::uint8_t>(number << 3U | static_cast<unsigned>(type));
}

template <class Number>
constexpr WireType fixed_type() noexcept {
  static_assert(sizeof(Number) == 4 || sizeof(Number) == 8);
  return sizeof(Number) == 4 ? WireType::Fixed32 : WireType::Fixed64;
}

inline constexpr std::size_t kVarintSizeMax = 10;     ///< [bytes], of 64 bits in groups of seven
inline constexpr std::size_t kPartSizeVarintMax = 5;  ///< [bytes], what protobuf reads of a size
inline constexpr std::size_t kPartSizeMax = 0x7F;     ///< [bytes], that we write: a size of a byte

/// Reads from the front. What a failed call leaves behind is of no use.
class WireReader {
 public:
  explicit WireReader(std::span<const std::byte> bytes) noexcept : bytes_{bytes} {}
  [[nodiscard]] bool empty() const noexcept { return bytes_.empty(); }

  /// Steps over the tag if it comes next.
  [[nodiscard]] bool skip(std::uint8_t tag) noexcept {
    if (bytes_.empty() || bytes_.front() != std::byte{tag}) return false;
    bytes_ = bytes_.subspan(1);
    return true;
  }

  /// @returns false where it does not end within `size_max` bytes.
  [[nodiscard]] bool take_varint(std::uint64_t& value,
                                 std::size_t size_max = kVarintSizeMax) noexcept {
    value = 0;
    for (std::size_t i = 0; i < bytes_.size() && i < size_max; ++i) {
      const auto byte = std::to_integer<std::uint64_t>(bytes_[i]);
      value |= (byte & 0x7FU) << (7 * i);
      if (byte < 0x80) {
        bytes_ = bytes_.subspan(i + 1);
        return true;
      }
    }
    return false;
  }

  template <class Number>
  [[nodiscard]] bool take_fixed(Number& value) noexcept {
    static_assert(std::is_trivially_copyable_v<Number>);
    if (bytes_.size() < sizeof value) return false;
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_ = bytes_.subspan(sizeof value);
    return true;
  }

  [[nodiscard]] bool take_part(WireReader& part) noexcept {
    std::uint64_t size = 0;
    if (!take_varint(size, kPartSizeVarintMax) || size > bytes_.size()) return false;
    part = WireReader{bytes_.first(size)};
    bytes_ = bytes_.subspan(size);
    return true;
  }

 private:
  std::span<const std::byte> bytes_;
};

/// Writes into room that must be large enough for all that comes.
class WireWriter {
 public:
  explicit WireWriter(std::span<std::byte> room) noexcept : begin_{room.data()}, end_{begin_} {}
  [[nodiscard]] std::size_t size() const noexcept {
    return static_cast<std::size_t>(end_ - begin_);
  }

  void put_byte(std::uint8_t value) noexcept { *end_++ = std::byte{value}; }

  void put_varint(std::uint64_t value) noexcept {
    for (; value >= 0x80; value >>= 7U) put_byte(static_cast<std::uint8_t>(value | 0x80U));
    put_byte(static_cast<std::uint8_t>(value));
  }

  template <class Number>
  void put_fixed(Number value) noexcept {
    static_assert(std::is_trivially_copyable_v<Number>);
    std::memcpy(end_, &value, sizeof value);
    end_ += sizeof value;
  }

  /// Leaves room for the size of the part that is written next, to be given to end_part().
  [[nodiscard]] std::byte* begin_part() noexcept { return end_++; }
  void end_part(std::byte* size) noexcept {
    const std::ptrdiff_t written = end_ - size - 1;
    PALP_CHECK(static_cast<std::size_t>(written) <= kPartSizeMax, "a part's size takes a byte");
    *size = static_cast<std::byte>(written);
  }

 private:
  std::byte* begin_;
  std::byte* end_;
};

}  // namespace palp::link
