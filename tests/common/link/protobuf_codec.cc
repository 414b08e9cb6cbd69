#include "tests/common/link/protobuf_codec.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/wire_format_lite.h>

#include "common/core/check.h"
#include "proto/link.pb.h"

namespace palp::link {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::internal::WireFormatLite;

void write(const CouplingPayload& payload, wire::Sample& out) {
  if (const auto* wave = std::get_if<WavePayload>(&payload)) {
    out.mutable_wave()->set_wave_integral_sqrt_w_s(wave->wave_integral);
    out.mutable_wave()->set_wave_energy_j(wave->wave_energy);
  } else if (const auto* tdpa = std::get_if<TdpaPayload>(&payload)) {
    out.mutable_tdpa()->set_energy_in_j(tdpa->energy_in);
  } else if (const auto* model = std::get_if<ModelPayload>(&payload)) {
    wire::Model& target = *out.mutable_model();
    target.set_version(model->version);
    target.set_c1_n(static_cast<float>(model->c[0]));
    target.set_c2_n(static_cast<float>(model->c[1]));
    target.set_c3_n(static_cast<float>(model->c[2]));
    target.set_c4_n(static_cast<float>(model->c[3]));
    target.set_c5_n(static_cast<float>(model->c[4]));
    target.set_surface_m(static_cast<float>(model->surface));
    target.set_depth_max_m(static_cast<float>(model->depth_max));
    target.set_residual_n(static_cast<float>(model->residual));
    target.set_swing_m(static_cast<float>(model->swing));
    target.set_swing_quadrature_m(static_cast<float>(model->swing_quadrature));
    target.set_swing_rad_per_s(static_cast<float>(model->swing_rate));
    target.set_relaxing_fast(static_cast<float>(model->relaxing[0]));
    target.set_relaxing_slow(static_cast<float>(model->relaxing[1]));
  }
  static_assert(std::variant_size_v<CouplingPayload> == 4, "a new payload needs its line here");
}

void write(const PortSample& sample, wire::Sample& out) {
  out.set_position_m(static_cast<float>(sample.position));
  out.set_velocity_m_per_s(static_cast<float>(sample.velocity));
  out.set_force_n(static_cast<float>(sample.force));
  write(sample.payload, out);
}

void write(const SiteReport& site, wire::Site& out) {
  out.set_state(static_cast<wire::SiteState>(site.state));
  out.set_epoch(site.epoch);
  out.set_x_m(static_cast<float>(site.place.x));
  out.set_y_m(static_cast<float>(site.place.y));
  const DepthReport& report = site.depth;
  if (report.number == 0) return;
  wire::Depth& depth = *out.mutable_depth();
  depth.set_number(report.number);
  depth.set_verdict(static_cast<wire::DepthVerdict>(report.verdict));
  depth.set_reason(static_cast<wire::DepthReason>(report.reason));
  depth.set_depth_m(static_cast<float>(report.depth));
  depth.set_depth_stddev_m(static_cast<float>(report.depth_stddev));
  depth.set_depth_low_m(static_cast<float>(report.depth_low));
  depth.set_depth_high_m(static_cast<float>(report.depth_high));
  depth.set_hash_n(static_cast<float>(report.hash));
}

CouplingPayload read_payload(const wire::Sample& sample) {
  switch (sample.payload_case()) {
    case wire::Sample::kWave:
      return WavePayload{sample.wave().wave_integral_sqrt_w_s(), sample.wave().wave_energy_j()};
    case wire::Sample::kTdpa:
      return TdpaPayload{sample.tdpa().energy_in_j()};
    case wire::Sample::kModel: {
      const wire::Model& model = sample.model();
      return ModelPayload{
          .version = model.version(),
          .c = {double{model.c1_n()},
                double{model.c2_n()},
                double{model.c3_n()},
                double{model.c4_n()},
                double{model.c5_n()}},
          .surface = double{model.surface_m()},
          .depth_max = double{model.depth_max_m()},
          .residual = double{model.residual_n()},
          .swing = double{model.swing_m()},
          .swing_quadrature = double{model.swing_quadrature_m()},
          .swing_rate = double{model.swing_rad_per_s()},
          .relaxing = {double{model.relaxing_fast()}, double{model.relaxing_slow()}}};
    }
    case wire::Sample::PAYLOAD_NOT_SET:
      break;
  }
  return std::monostate{};
}

PortSample read(const wire::Sample& sample) {
  return {.position = double{sample.position_m()},
          .velocity = double{sample.velocity_m_per_s()},
          .force = double{sample.force_n()},
          .payload = read_payload(sample)};
}

/// `value` as an enumerator; what our enum cannot hold becomes one that is out of range.
template <class Enum>
Enum read_enum(int value) {
  constexpr int kOutOfRange = 0xFF;
  return static_cast<Enum>(value >= 0 && value < kOutOfRange ? value : kOutOfRange);
}

DepthReport read(const wire::Depth& depth) {
  if (depth.number() == 0) return {};  // none yet, whatever else it says
  return {.number = depth.number(),
          .verdict = read_enum<DepthVerdict>(depth.verdict()),
          .reason = read_enum<DepthReason>(depth.reason()),
          .depth = double{depth.depth_m()},
          .depth_stddev = double{depth.depth_stddev_m()},
          .depth_low = double{depth.depth_low_m()},
          .depth_high = double{depth.depth_high_m()},
          .hash = double{depth.hash_n()}};
}

SiteReport read(const wire::Site& site) {
  return {.state = read_enum<SiteState>(site.state()),
          .epoch = site.epoch(),
          .place = {double{site.x_m()}, double{site.y_m()}},
          .depth = read(site.depth())};
}

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
      entry.excluded_by = static_cast<std::uint16_t>(1U << number);
      if (const auto* one_of = field.containing_oneof()) {
        for (int k = 0; k < one_of->field_count(); ++k) {
          entry.excluded_by |= static_cast<std::uint16_t>(1U << one_of->field(k)->number());
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
    const auto tag = std::to_integer<std::size_t>(bytes[0]);
    bytes = bytes.subspan(1);
    const std::size_t number = tag >> 3U;
    if (number >= kFieldNumbers) return false;
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
                                  std::span<std::byte, kTelegramSizeMax> out) noexcept {
  if (!well_formed(telegram)) return 0;
  wire::Telegram message;
  message.set_sent_at_ns(telegram.sent_at_ns);
  if (telegram.echo_ns != kNothingHeard) {
    message.set_echo_ns(telegram.echo_ns);
    message.set_hold_us(telegram.hold_us);
    message.set_newest_number(telegram.newest_number);
    message.set_before_newest(telegram.before_newest);
  }
  write(telegram.telegram.site, *message.mutable_site());
  write(telegram.telegram.port, *message.mutable_sample());
  if (telegram.older_count > 0) write(telegram.older[0], *message.mutable_sample_first_earlier());
  if (telegram.older_count > 1) write(telegram.older[1], *message.mutable_sample_second_earlier());

  const std::size_t size = message.ByteSizeLong();
  message.SerializeWithCachedSizesToArray(reinterpret_cast<std::uint8_t*>(out.data()));
  return size;
}

std::optional<WireTelegram> ProtobufCodec::decode(std::span<const std::byte> bytes) noexcept {
  if (bytes.size() > kTelegramSizeMax || !fits(0, bytes, 0)) return std::nullopt;
  wire::Telegram message;
  if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return std::nullopt;
  if (message.has_sample_second_earlier() && !message.has_sample_first_earlier()) {
    return std::nullopt;
  }
  if (!message.has_site() || !message.has_sample()) return std::nullopt;

  WireTelegram telegram;
  telegram.sent_at_ns = message.sent_at_ns();
  if (message.has_echo_ns()) {
    telegram.echo_ns = message.echo_ns();
    if (telegram.echo_ns == kNothingHeard) return std::nullopt;
  }
  telegram.hold_us = message.hold_us();
  telegram.newest_number = message.newest_number();
  telegram.before_newest = message.before_newest();
  telegram.telegram.site = read(message.site());
  telegram.telegram.port = read(message.sample());
  if (message.has_sample_first_earlier()) {
    telegram.older[0] = read(message.sample_first_earlier());
    telegram.older_count = 1;
  }
  if (message.has_sample_second_earlier()) {
    telegram.older[1] = read(message.sample_second_earlier());
    telegram.older_count = 2;
  }
  if (!well_formed(telegram)) return std::nullopt;
  return telegram;
}

}  // namespace palp::link
