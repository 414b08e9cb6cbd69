#include "common/link/codec.h"

#include <cmath>
#include <cstring>
#include <type_traits>

namespace palp::link {
namespace {

bool within(double value, double limit) noexcept { return std::abs(value) <= limit; }  // NaN: no

bool well_formed(const DepthReport& report) noexcept {
  return static_cast<int>(report.verdict) < kDepthVerdictCount &&
         static_cast<int>(report.reason) < kDepthReasonCount && within(report.depth, kLengthMax) &&
         within(report.depth_stddev, kLengthMax) && within(report.depth_low, kLengthMax) &&
         within(report.depth_high, kLengthMax) && within(report.hash, kForceMax);
}

bool well_formed(const WavePayload& wave) noexcept {
  return within(wave.wave_integral, kSumMax) && within(wave.wave_energy, kSumMax);
}

bool well_formed(const TdpaPayload& tdpa) noexcept { return within(tdpa.energy_in, kSumMax); }

bool well_formed(const ModelPayload& model) noexcept {
  for (const double c : model.c) {
    if (!within(c, kForceMax)) return false;
  }
  for (const double share : model.relaxing) {
    if (!within(share, kForceMax)) return false;
  }
  return within(model.surface, kLengthMax) && within(model.depth_max, kLengthMax) &&
         within(model.residual, kForceMax) && within(model.swing, kLengthMax) &&
         within(model.swing_quadrature, kLengthMax) && within(model.swing_rate, kSpeedMax);
}

/// A raw copy may hold any index: then none of these, and not well formed.
bool well_formed(const CouplingPayload& payload) noexcept {
  static_assert(std::variant_size_v<CouplingPayload> == 4, "a new payload needs its line here");
  if (const auto* wave = std::get_if<WavePayload>(&payload)) return well_formed(*wave);
  if (const auto* tdpa = std::get_if<TdpaPayload>(&payload)) return well_formed(*tdpa);
  if (const auto* model = std::get_if<ModelPayload>(&payload)) return well_formed(*model);
  return std::holds_alternative<std::monostate>(payload);
}

bool well_formed(const PortSample& sample) noexcept {
  return within(sample.position, kLengthMax) && within(sample.velocity, kSpeedMax) &&
         within(sample.force, kForceMax) && well_formed(sample.payload);
}

bool well_formed_earlier(const PortSample& sample) noexcept {
  return well_formed(sample) && (std::holds_alternative<std::monostate>(sample.payload) ||
                                 std::holds_alternative<WavePayload>(sample.payload));
}

bool well_formed_acknowledgement(const WireTelegram& telegram) noexcept {
  if (telegram.echo_ns == kNothingHeard) {
    return telegram.hold_us == 0 && telegram.newest_number == 0 && telegram.before_newest == 0;
  }
  return telegram.echo_ns <= kSentAtMaxNs && telegram.hold_us <= kHoldMaxUs &&
         telegram.newest_number <= kNumberMax;
}

}  // namespace

bool well_formed(const WireTelegram& telegram) noexcept {
  if (telegram.sent_at_ns > kSentAtMaxNs || !well_formed_acknowledgement(telegram)) return false;
  if (telegram.older_count > telegram.older.size()) return false;
  for (std::size_t i = 0; i < telegram.older_count; ++i) {
    if (!well_formed_earlier(telegram.older[i])) return false;
  }
  const SiteReport& site = telegram.telegram.site;
  return static_cast<int>(site.state) < kSiteStateCount && within(site.place.x, kLengthMax) &&
         within(site.place.y, kLengthMax) && well_formed(site.depth) &&
         well_formed(telegram.telegram.port);
}

std::size_t RawCodec::encode(const WireTelegram& telegram,
                             std::span<std::byte, kTelegramSizeMax> out) noexcept {
  static_assert(std::is_trivially_copyable_v<WireTelegram>);
  static_assert(sizeof(WireTelegram) <= kTelegramSizeMax);
  if (!well_formed(telegram)) return 0;
  std::memcpy(out.data(), &telegram, sizeof telegram);
  return sizeof telegram;
}

std::optional<WireTelegram> RawCodec::decode(std::span<const std::byte> bytes) noexcept {
  WireTelegram telegram;
  if (bytes.size() != sizeof telegram) return std::nullopt;
  std::memcpy(&telegram, bytes.data(), sizeof telegram);
  if (!well_formed(telegram)) return std::nullopt;
  return telegram;
}

}  // namespace palp::link
