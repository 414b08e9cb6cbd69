#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "common/core/check.h"

/// The primitives of protobuf's wire format (protobuf.dev, "Encoding"): what a message of proto3 is
/// made of. Thread: any; allocates nothing.
namespace palp::message {

static_assert(std::endian::native == std::endian::little,
              "fixed numbers are copied as they lie in memory");

enum class WireType : std::uint8_t { Varint = 0, Fixed64 = 1, Part = 2, Fixed32 = 5 };

inline constexpr unsigned kFieldNumberMax = 2047;  ///< tags of one byte or two

/// As it stands before a field: in one byte up to number 15.
constexpr std::uint16_t wire_tag(unsigned number, WireType type) noexcept {
  return static_cast<std::uint16_t>(number << 3U | static_cast<unsigned>(type));
}
constexpr std::size_t tag_size(std::uint16_t tag) noexcept { return tag < 0x80 ? 1 : 2; }

template <class Number>
constexpr WireType fixed_type() noexcept {
  static_assert(sizeof(Number) == 4 || sizeof(Number) == 8);
  return sizeof(Number) == 4 ? WireType::Fixed32 : WireType::Fixed64;
}

inline constexpr std::size_t kVarintSizeMax = 10;     ///< [bytes], of 64 bits in groups of seven
inline constexpr std::size_t kPartSizeVarintMax = 5;  ///< [bytes], what protobuf reads of a size

/// [bytes] that the size of a part takes.
constexpr std::size_t size_of_size(std::size_t size) noexcept { return size < 0x80 ? 1 : 2; }
inline constexpr std::size_t kPartSizeMax = 0x3FFF;  ///< [bytes], that we write

/// Reads from the front. What a failed call leaves behind is of no use.
class WireReader {
 public:
  explicit WireReader(std::span<const std::byte> bytes) noexcept : bytes_{bytes} {}
  [[nodiscard]] bool empty() const noexcept { return bytes_.empty(); }

  /// Steps over the tag if it comes next.
  template <std::uint16_t kTag>
  [[nodiscard]] bool skip() noexcept {
    constexpr std::size_t kSize = tag_size(kTag);
    if (bytes_.size() < kSize) return false;
    if constexpr (kSize == 1) {
      if (bytes_.front() != std::byte{kTag}) return false;
    } else {
      constexpr std::byte kFirst{static_cast<std::uint8_t>(kTag | 0x80U)};
      constexpr std::byte kSecond{static_cast<std::uint8_t>(kTag >> 7U)};
      if (bytes_[0] != kFirst || bytes_[1] != kSecond) return false;
    }
    bytes_ = bytes_.subspan(kSize);
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

  [[nodiscard]] bool take_bytes(std::span<const std::byte>& part) noexcept {
    std::uint64_t size = 0;
    if (!take_varint(size, kPartSizeVarintMax) || size > bytes_.size()) return false;
    part = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return true;
  }
  [[nodiscard]] bool take_part(WireReader& part) noexcept { return take_bytes(part.bytes_); }

  /// Steps over a field that nobody here knows, groups of the old syntax included.
  /// @returns false where it is none, or its tag takes more bytes than it needs.
  [[nodiscard]] bool skip_field() noexcept;

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

  template <std::uint16_t kTag>
  void put_tag() noexcept {
    if constexpr (tag_size(kTag) == 2) put_byte(static_cast<std::uint8_t>(kTag | 0x80U));
    put_byte(static_cast<std::uint8_t>(tag_size(kTag) == 2 ? kTag >> 7U : kTag));
  }

  void put_bytes(std::span<const std::byte> bytes) noexcept {
    put_varint(bytes.size());
    if (!bytes.empty()) std::memcpy(end_, bytes.data(), bytes.size());
    end_ += bytes.size();
  }

  /// Leaves room for the size of the part that is written next, to be given to end_part().
  [[nodiscard]] std::byte* begin_part() noexcept { return end_++; }
  /// Where the size takes a second byte, the part moves on by one.
  void end_part(std::byte* begin) noexcept {
    const auto size = static_cast<std::size_t>(end_ - begin - 1);
    PALP_CHECK(size <= kPartSizeMax, "a part's size takes two bytes at most");
    if (size_of_size(size) == 2) {
      std::memmove(begin + 2, begin + 1, size);
      ++end_;
      *begin++ = static_cast<std::byte>(size | 0x80U);
    }
    *begin = static_cast<std::byte>(size_of_size(size) == 2 ? size >> 7U : size);
  }

 private:
  std::byte* begin_;
  std::byte* end_;
};

}  // namespace palp::message
