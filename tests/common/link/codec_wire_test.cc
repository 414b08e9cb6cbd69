// The product's codec beside protobuf's own: the same bytes out, the same telegrams in.
#include "common/link/codec_wire.h"

#include <bit>
#include <numeric>
#include <string>
#include <vector>

#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "proto/link.pb.h"
#include "tests/common/link/protobuf_codec.h"
#include "tests/common/link/some_telegram.h"
#include "tests/common/message/same.h"

namespace palp::link {
namespace {

using message::same;

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using Bytes = std::vector<std::byte>;

Bytes encoded(Codec& codec, const WireTelegram& telegram) {
  std::array<std::byte, message::kTelegramSizeMax> room{};
  const std::size_t size = codec.encode(telegram, room);
  return {room.begin(), room.begin() + static_cast<std::ptrdiff_t>(size)};
}

enum class Outcome { BothRefuse, BothRead, TheyDiffer };

Outcome read_by_both(const Bytes& bytes) {
  static ProtobufCodec reference;
  const auto ours = WireCodec{}.decode(bytes);
  const auto expected = reference.decode(bytes);
  if (ours.has_value() != expected.has_value()) return Outcome::TheyDiffer;
  if (!ours) return Outcome::BothRefuse;
  return same(*ours, *expected) ? Outcome::BothRead : Outcome::TheyDiffer;
}

/// Bytes of a message of the schema, whatever fields it has: in any order, numbers often longer
/// than they need to be, and now and then a defect.
class SchemaDraw {
 public:
  SchemaDraw(std::uint64_t seed, std::uint64_t defect_every)
      : draw_{seed}, defect_every_{defect_every} {}

  Bytes message(const Descriptor& schema) {
    std::vector<int> order(static_cast<std::size_t>(schema.field_count()));
    std::iota(order.begin(), order.end(), 0);
    if (draw_.below(3) == 0) {
      for (std::size_t i = order.size(); i > 1; --i) {
        std::swap(order[i - 1], order[draw_.below(i)]);
      }
    }
    Bytes out;
    std::vector<bool> chosen(static_cast<std::size_t>(schema.real_oneof_decl_count()));
    for (const int index : order) {
      const FieldDescriptor& field = *schema.field(index);
      const auto* one_of = field.real_containing_oneof();
      if (one_of != nullptr && !defect()) {
        if (chosen[static_cast<std::size_t>(one_of->index())] || draw_.below(3) == 0) continue;
        chosen[static_cast<std::size_t>(one_of->index())] = true;
      }
      const bool part = field.message_type() != nullptr && one_of == nullptr;
      if (!part && one_of == nullptr && draw_.below(5) == 0) continue;
      if (part && defect()) continue;
      add(field, out);
      if (defect()) add(field, out);
      if (defect()) varint(draw_.below(256), out);  // the tag of something
    }
    return out;
  }

 private:
  bool defect() { return draw_.below(defect_every_) == 0; }

  void varint(std::uint64_t value, Bytes& out) {
    std::size_t longer = draw_.below(8) == 0 ? draw_.below(10) : 0;
    for (; value >= 0x80; value >>= 7U) out.push_back(static_cast<std::byte>(value | 0x80U));
    for (; longer > 0; --longer, value = 0) out.push_back(static_cast<std::byte>(value | 0x80U));
    out.push_back(static_cast<std::byte>(value));
  }

  template <class Number>
  void fixed(Number value, Bytes& out) {
    const auto bytes = std::bit_cast<std::array<std::byte, sizeof value>>(value);
    out.insert(out.end(), bytes.begin(), bytes.end());
  }

  double real() { return defect() ? std::bit_cast<double>(draw_.bits()) : draw_.within(10); }

  /// The acknowledgement's numbers have limits of their own, mostly kept.
  std::uint64_t whole() { return defect() ? draw_.bits() : draw_.bits() >> (12 + draw_.below(50)); }

  std::uint64_t cell() { return defect() ? draw_.bits() : draw_.below(kMapCellsMax); }

  void add(const FieldDescriptor& field, Bytes& out) {
    constexpr unsigned kVarint = 0;
    constexpr unsigned kFixed64 = 1;
    constexpr unsigned kPart = 2;
    constexpr unsigned kFixed32 = 5;
    const auto tag = [&](unsigned type) {
      const unsigned shown = defect() ? static_cast<unsigned>(draw_.below(8)) : type;
      const unsigned whole = static_cast<unsigned>(field.number()) << 3U | shown;
      if (whole >= 0x80) out.push_back(static_cast<std::byte>(whole | 0x80U));
      out.push_back(static_cast<std::byte>(whole >= 0x80 ? whole >> 7U : whole));
    };
    switch (field.cpp_type()) {
      case FieldDescriptor::CPPTYPE_FLOAT:
        tag(kFixed32);
        return fixed(static_cast<float>(field.name() == "inclusion" ? real() / 10 : real()), out);
      case FieldDescriptor::CPPTYPE_DOUBLE:
        tag(kFixed64);
        return fixed(real(), out);
      case FieldDescriptor::CPPTYPE_ENUM:
        tag(kVarint);
        return varint(defect() ? draw_.bits() : draw_.below(3), out);
      case FieldDescriptor::CPPTYPE_MESSAGE: {
        tag(kPart);
        const Bytes inside = message(*field.message_type());
        varint(defect() ? draw_.below(300) : inside.size(), out);
        out.insert(out.end(), inside.begin(), inside.end());
        return;
      }
      default:
        if (field.type() == FieldDescriptor::TYPE_FIXED32) {
          tag(kFixed32);
          return fixed(static_cast<std::uint32_t>(draw_.bits()), out);
        }
        tag(kVarint);
        if (field.name() == "index" || field.name() == "count") return varint(cell(), out);
        return varint(field.name() == "hold_us" ? whole() >> 26U : whole(), out);
    }
  }

  message::Draw draw_;
  std::uint64_t defect_every_;
};

RC_GTEST_PROP(WireCodecTest, WritesTheBytesOfProtobuf, (std::uint64_t seed)) {
  WireCodec ours;
  ProtobufCodec reference;
  RC_ASSERT(encoded(ours, some_telegram(seed)) == encoded(reference, some_telegram(seed)));
}

RC_GTEST_PROP(WireCodecTest, ReadsWhatProtobufReadsHoweverItWasSpoiled, (std::uint64_t seed)) {
  WireCodec codec;
  message::Draw draw{seed + 1};
  Bytes bytes = encoded(codec, some_telegram(seed));
  for (std::uint64_t i = 0; i < 12; ++i) {
    const Outcome outcome = read_by_both(bytes);
    RC_ASSERT(outcome == Outcome::BothRead || (i > 0 && outcome == Outcome::BothRefuse));
    const std::size_t at = draw.below(bytes.size());
    const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    switch (draw.below(5)) {
      case 0:
        bytes[at] ^= static_cast<std::byte>(1U << draw.below(8));
        break;
      case 1:
        bytes[at] = static_cast<std::byte>(draw.bits());
        break;
      case 2:
        bytes.insert(place, static_cast<std::byte>(draw.bits()));
        break;
      case 3:
        bytes.erase(place);
        break;
      default:
        bytes.resize(at + 1);
    }
    if (bytes.empty()) return;
  }
}

TEST(WireCodecTest, ReadsAllThatTheSchemaHasInAnyOrderAsProtobufDoes) {
  const Descriptor& schema = *wire::Telegram::descriptor();
  for (const std::uint64_t defect_every : {1'000'000U, 200U, 20U}) {
    int good = 0;
    for (std::uint64_t seed = 0; seed < 3000; ++seed) {
      const Outcome outcome = read_by_both(SchemaDraw{seed, defect_every}.message(schema));
      ASSERT_NE(outcome, Outcome::TheyDiffer) << "seed " << seed;
      good += outcome == Outcome::BothRead ? 1 : 0;
    }
    // Else the draw proves little: whole messages without defects, broken ones with many.
    EXPECT_GT(good, defect_every > 1000 ? 300 : -1);
    EXPECT_LT(good, defect_every > 1000 ? 3000 : 1500);
  }
}

TEST(WireCodecTest, ReadsTheEdgesOfTheFormatAsProtobufDoes) {
  const std::vector<std::string> alone{
      {"\x32\x00\x3A\x00\x08\x01", 6},              // sent_at_ns
      {"\x32\x02\x10\x07\x3A\x00", 6},              // site { epoch }
      {"\x32\x04\x22\x02\x08\x01\x3A\x00", 8},      // site { depth { number } }
      {"\x32\x00\x3A\x04\x32\x02\x08\x01", 8},      // sample { model { version } }
      {"\x32\x00\x3A\x80\x80\x80\x80\x00", 8},      // a size in five bytes
      {"\x32\x00\x3A\x80\x80\x80\x80\x80\x00", 9},  // and in six
      {"\x32\x00\x3A\x00\x10\x00", 6},              // echo_ns 0 is heard
      {"\x32\x00\x3A\x00\x10\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\x01", 15},
      {"\x32\x06\x22\x04\x10\x7F\x18\x7F\x3A\x00", 10}};  // a depth without number says nothing
  const std::vector<bool> taken{true, true, true, true, true, false, true, false, true};
  for (std::size_t i = 0; i < alone.size(); ++i) {
    const auto view = std::as_bytes(std::span{alone[i]});
    EXPECT_EQ(read_by_both({view.begin(), view.end()}),
              taken[i] ? Outcome::BothRead : Outcome::BothRefuse)
        << i;
  }
}

}  // namespace
}  // namespace palp::link
