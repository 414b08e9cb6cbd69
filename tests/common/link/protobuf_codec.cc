#include "tests/common/link/protobuf_codec.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/wire_format_lite.h>

#include "common/core/check.h"
#include "proto/link.pb.h"
#include "tests/common/message/by_protobuf.h"

namespace palp::link {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::internal::WireFormatLite;

/// Steps over a base-128 number of at most 10 bytes. @returns false where it does not end.
bool take_varint(std::span<const std::byte>& bytes, std::uint64_t& value) noexcept {
  value = 0;
  for (std::size_t i = 0; i < bytes.size() && i < 10; ++i) {
    const auto byte = std::to_integer<std::uint64_t>(bytes[i]);
    value |= (byte & 0x7FU) << (7 * i);
    if (byte < 0x80) {
      bytes = bytes.subspan(i + 1);
      return true;
    }
  }
  return false;
}

}  // namespace

/// Reads the table of what may come from the schema itself, so that it cannot fall behind.
struct ProtobufCodec::ShapeBuilder {
  std::vector<Shape>& shapes;

  [[nodiscard]] std::uint8_t add(const Descriptor& message, std::size_t depth) const {
    PALP_CHECK(depth < kDepthMax, "telegrams nest no deeper");
    const std::size_t index = shapes.size();
    shapes.emplace_back();
    for (int i = 0; i < message.field_count(); ++i) {
      const FieldDescriptor& field = *message.field(i);
      const auto number = static_cast<std::size_t>(field.number());
      PALP_CHECK(number < kFieldNumbers && !field.is_repeated(), "the scan knows no such field");
      Field entry;
      entry.wire_type = static_cast<std::uint8_t>(WireFormatLite::WireTypeForFieldType(
          static_cast<WireFormatLite::FieldType>(field.type())));
      entry.excluded_by = 1U << number;
      if (const auto* one_of = field.containing_oneof()) {
        for (int k = 0; k < one_of->field_count(); ++k) {
          entry.excluded_by |= 1U << one_of->field(k)->number();
        }
      }
      if (const Descriptor* nested = field.message_type()) entry.message = add(*nested, depth + 1);
      shapes[index][number] = entry;
    }
    return static_cast<std::uint8_t>(index);
  }
};

ProtobufCodec::ProtobufCodec() {
  const std::uint8_t telegram = ShapeBuilder{shapes_}.add(*wire::Telegram::descriptor(), 0);
  PALP_CHECK(telegram == 0, "the outermost message comes first");
}

bool ProtobufCodec::fits(std::size_t shape,
                         std::span<const std::byte> bytes,
                         std::size_t depth) const noexcept {
  if (depth >= kDepthMax) return false;
  std::uint32_t seen = 0;
  while (!bytes.empty()) {
    std::uint64_t tag = 0;
    const std::size_t before = bytes.size();
    if (!take_varint(bytes, tag)) return false;
    const std::uint64_t number = tag >> 3U;
    // A tag in more bytes than it needs would be taken too.
    if (number >= kFieldNumbers || before - bytes.size() != (tag < 0x80 ? 1U : 2U)) return false;
    const Field& field = shapes_[shape][number];
    if (field.wire_type != (tag & 7U) || (seen & field.excluded_by) != 0) return false;
    seen |= 1U << number;

    std::uint64_t size = 0;
    switch (static_cast<WireFormatLite::WireType>(field.wire_type)) {
      case WireFormatLite::WIRETYPE_VARINT:
        if (!take_varint(bytes, size)) return false;
        continue;
      case WireFormatLite::WIRETYPE_FIXED32:
        size = 4;
        break;
      case WireFormatLite::WIRETYPE_FIXED64:
        size = 8;
        break;
      case WireFormatLite::WIRETYPE_LENGTH_DELIMITED:
        if (!take_varint(bytes, size) || size > bytes.size()) return false;
        if (!fits(field.message, bytes.first(size), depth + 1)) return false;
        break;
      default:
        return false;
    }
    if (size > bytes.size()) return false;
    bytes = bytes.subspan(size);
  }
  return true;
}

std::size_t ProtobufCodec::encode(const WireTelegram& telegram,
                                  std::span<std::byte, message::kTelegramSizeMax> out) noexcept {
  if (!well_formed(telegram)) return 0;
  wire::Telegram parsed;
  message::to_protobuf(telegram, parsed, false);
  // There with every telegram, also where all in them is 0.
  (void)parsed.mutable_site();
  (void)parsed.mutable_sample();

  const std::size_t size = parsed.ByteSizeLong();
  parsed.SerializeWithCachedSizesToArray(reinterpret_cast<std::uint8_t*>(out.data()));
  return size;
}

std::optional<WireTelegram> ProtobufCodec::decode(std::span<const std::byte> bytes) noexcept {
  if (bytes.size() > message::kTelegramSizeMax || !fits(0, bytes, 0)) return std::nullopt;
  wire::Telegram parsed;
  if (!parsed.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return std::nullopt;
  if (parsed.has_sample_second_earlier() && !parsed.has_sample_first_earlier()) {
    return std::nullopt;
  }
  if (!parsed.has_site() || !parsed.has_sample()) return std::nullopt;

  WireTelegram telegram;
  message::from_protobuf(parsed, telegram, false);
  if (parsed.has_echo_ns() && telegram.echo_ns == message::kNothingHeard) return std::nullopt;
  if (parsed.has_sample_first_earlier()) telegram.older_count = 1;
  if (parsed.has_sample_second_earlier()) telegram.older_count = 2;
  if (!well_formed(telegram)) return std::nullopt;
  return telegram;
}

}  // namespace palp::link
