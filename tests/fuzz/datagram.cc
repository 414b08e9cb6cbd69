// Input: one datagram. What follows the 16 header bytes is decoded whatever the header says,
// because a mutated length would hide it from everything behind the header.
#include <algorithm>
#include <array>
#include <vector>

#include "common/core/check.h"
#include "common/link/aead_protection.h"
#include "common/link/codec_control.h"
#include "common/link/codec_wire.h"
#include "common/link/packet_protection.h"
#include "common/link/transport.h"
#include "tests/common/link/protobuf_codec.h"
#include "tests/common/link/some_keys.h"
#include "tests/common/link/whole_open.h"
#include "tests/common/message/same.h"
#include "tests/fuzz/fuzz.h"

namespace palp::link {
namespace {

using message::same;

bool equal(std::span<const std::byte> a, std::span<const std::byte> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

void header_laws(std::span<const std::byte> datagram) {
  const auto header = parse_header(datagram);
  std::array<std::byte, kDatagramSizeMax> plain{};
  PlainProtection protection;
  const auto opened = whole_open(protection, datagram, plain);
  if (!header) {
    PALP_CHECK(!opened, "nothing opens without a header");
    return;
  }
  std::array<std::byte, kHeaderSize> packed{};
  pack_header(*header, packed);
  PALP_CHECK(equal(packed, datagram.first(kHeaderSize)), "a header packs as it was");
  if (!opened) return;
  std::array<std::byte, kHeaderSize + kDatagramSizeMax> sealed{};
  const std::size_t size = protection.seal(*header, std::span{plain}.first(*opened), sealed);
  PALP_CHECK(equal(std::span{sealed}.first(size), datagram), "what opens seals as it was");
}

/// Nobody has sealed it under these keys: its header may say anything, but nothing opens.
void hidden_header_laws(std::span<const std::byte> datagram) {
  static AeadProtection protection{some_keys(1, Role::Patient).data};
  std::array<std::byte, kDatagramSizeMax> plain{};
  PALP_CHECK(!whole_open(protection, datagram, plain), "a tag cannot be guessed");
}

/// Said here once more, so that the limits do not vouch for themselves.
void limit_laws(const WireTelegram& telegram) {
  const auto within = [](double value, double limit) { return value >= -limit && value <= limit; };
  const auto sound = [&](const PortSample& sample) {
    return within(sample.position, 10) && within(sample.velocity, 1e3) && within(sample.force, 1e5);
  };
  const DepthReport& depth = telegram.telegram.site.depth;
  const MapReport& map = telegram.telegram.site.map;
  PALP_CHECK(telegram.sent_at_ns <= message::kSentAtMaxNs &&
                 telegram.newest_number <= message::kNumberMax &&
                 telegram.hold_us <= message::kHoldMaxUs &&
                 telegram.older_count <= telegram.older.size(),
             "numbers keep the limits of the wire");
  PALP_CHECK(sound(telegram.telegram.port) && sound(telegram.older[0]) && sound(telegram.older[1]),
             "samples keep the limits of the wire");
  PALP_CHECK(within(depth.hash, 1e5) && within(depth.depth, 10) && within(depth.depth_stddev, 10) &&
                 within(depth.depth_low, 10) && within(depth.depth_high, 10) &&
                 within(telegram.telegram.site.place.x, 10) &&
                 within(telegram.telegram.site.place.y, 10) && within(map.depth.high, 10) &&
                 within(map.next.x, 10) && within(map.log_odds, 1e5),
             "reports keep the limits of the wire");
  PALP_CHECK(static_cast<int>(telegram.telegram.site.state) < kSiteStateCount &&
                 static_cast<int>(depth.verdict) < kDepthVerdictCount &&
                 static_cast<int>(depth.reason) < kDepthReasonCount,
             "enumerators are ours");
}

void telegram_laws(std::span<const std::byte> bytes) {
  WireCodec codec;
  static ProtobufCodec reference;
  const auto telegram = codec.decode(bytes);
  const auto expected = reference.decode(bytes);
  PALP_CHECK(telegram.has_value() == expected.has_value(), "what protobuf reads is read");
  if (!telegram) return;
  PALP_CHECK(same(*telegram, *expected), "as protobuf reads it");
  limit_laws(*telegram);
  std::array<std::byte, message::kTelegramSizeMax> first{};
  const std::size_t first_size = codec.encode(*telegram, first);
  PALP_CHECK(first_size > 0, "what is well formed encodes");
  std::array<std::byte, message::kTelegramSizeMax> by_protobuf{};
  PALP_CHECK(equal(std::span{by_protobuf}.first(reference.encode(*telegram, by_protobuf)),
                   std::span{first}.first(first_size)),
             "as protobuf writes it");
  const auto again = codec.decode(std::span{first}.first(first_size));
  PALP_CHECK(again && same(*telegram, *again), "what was decoded survives the wire exactly");
  std::array<std::byte, message::kTelegramSizeMax> second{};
  const std::size_t second_size = codec.encode(*again, second);
  PALP_CHECK(equal(std::span{first}.first(first_size), std::span{second}.first(second_size)),
             "encoding again gives the same bytes");
}

bool printable(const std::string& text, std::size_t size_max) {
  return text.size() <= size_max &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

void hello_laws(std::span<const std::byte> bytes) {
  const auto hello = decode_hello(bytes);
  if (!hello) return;
  PALP_CHECK(hello->session_id != 0, "a Hello names its session");
  PALP_CHECK(printable(hello->coupling, kNameSizeMax) && printable(hello->git, kNameSizeMax),
             "names are short and printable");
  const ControlBytes encoded = encode(*hello);
  const auto again = decode_hello(encoded.view());
  PALP_CHECK(again.has_value() && equal(encode(*again).view(), encoded.view()) &&
                 again->role == hello->role && again->session_id == hello->session_id &&
                 again->peer_session_id == hello->peer_session_id &&
                 again->connection_id == hello->connection_id &&
                 again->settings_hash == hello->settings_hash &&
                 again->protocol_version == hello->protocol_version &&
                 again->coupling == hello->coupling && again->git == hello->git,
             "a Hello survives the wire");
}

void bye_laws(std::span<const std::byte> bytes) {
  const auto bye = decode_bye(bytes);
  if (!bye) return;
  PALP_CHECK(static_cast<int>(bye->reason) < kByeReasonCount, "a reason of ours");
  PALP_CHECK(printable(bye->text, kTextSizeMax), "a sentence is short and printable");
  const auto again = decode_bye(encode(*bye).view());
  PALP_CHECK(again.has_value() && again->session_id == bye->session_id &&
                 again->peer_session_id == bye->peer_session_id && again->reason == bye->reason &&
                 again->text == bye->text,
             "a Bye survives the wire");
}

}  // namespace
}  // namespace palp::link

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto datagram = palp::fuzz::as_bytes(data, size);
  palp::link::header_laws(datagram);
  palp::link::hidden_header_laws(datagram);
  const auto content = datagram.subspan(std::min(size, palp::link::kHeaderSize));
  palp::link::telegram_laws(content);
  palp::link::hello_laws(content);
  palp::link::bye_laws(content);
  return 0;
}
