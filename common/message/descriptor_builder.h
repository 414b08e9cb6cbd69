#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "common/message/wire_format.h"

namespace palp::message {

/// Messages of descriptor.proto, as protobuf writes them. Their field numbers are protobuf's own.
class DescriptorBuilder {
 public:
  void number(unsigned field, std::uint64_t value) {
    varint(wire_tag(field, WireType::Varint));
    varint(value);
  }
  void text(unsigned field, std::string_view value) {
    part(field, std::as_bytes(std::span{value}));
  }
  void part(unsigned field, std::span<const std::byte> value) {
    varint(wire_tag(field, WireType::Part));
    varint(value.size());
    bytes_.insert(bytes_.end(), value.begin(), value.end());
  }
  [[nodiscard]] const std::vector<std::byte>& bytes() const noexcept { return bytes_; }

 private:
  void varint(std::uint64_t value) {
    std::array<std::byte, kVarintSizeMax> room{};
    WireWriter writer{room};
    writer.put_varint(value);
    bytes_.insert(
        bytes_.end(), room.begin(), room.begin() + static_cast<std::ptrdiff_t>(writer.size()));
  }
  std::vector<std::byte> bytes_;
};

}  // namespace palp::message
