#include "lab/run/adversary.h"

#include <algorithm>
#include <utility>

#include "common/core/random.h"

namespace palp::lab {
namespace {

constexpr std::uint64_t kLieStream = 0x6c69'6500'0000ULL;  // "lie"
constexpr Duration kLieLength = std::chrono::milliseconds{50};
constexpr double kSurfaceMax = 3e-3;                                            // [m]
constexpr std::array<double, kModelTerms> kTermMax{0.1, 0.3, 0.1, 0.02, 1e-4};  // [N]
constexpr double kStiffnessMax = 600;                                           // [N/m], at a knot
constexpr double kShareMax = 0.3;        // [-], of what relaxes
constexpr double kForceMax = 3;          // [N]
constexpr double kWaveMax = 1;           // [sqrt(W)], of either sign: forces of some newtons
constexpr double kEnergyDeclared = 1e3;  // [J]

}  // namespace

LyingCodec::LyingCodec(std::unique_ptr<link::Codec> codec, std::uint64_t seed, Duration period)
    : codec_{std::move(codec)},
      seed_{seed},
      telegrams_per_lie_{
          static_cast<std::uint64_t>(std::max<std::int64_t>(1, kLieLength / period))},
      period_{seconds(period)} {}

ModelPayload LyingCodec::model(std::uint64_t lie) const noexcept {
  const auto uniform = [&](std::uint64_t which) {
    return random_uniform(seed_, kLieStream + which, lie);
  };
  ModelPayload model;
  model.version = static_cast<std::uint32_t>(lie + 1);
  model.surface = kSurfaceMax * (2 * uniform(0) - 1);
  for (std::size_t term = 0; term < kModelTerms; ++term) {
    model.c[term] = kTermMax[term] * uniform(1 + term);
  }
  for (std::size_t k = 0; k < model.relaxing.size(); ++k) {
    model.relaxing[k] = kShareMax * uniform(1 + kModelTerms + k);
  }
  // Every other one rises and falls.
  for (std::size_t k = 0; k < kModelKnots.size() && lie % 2 == 0; ++k) {
    model.stiffness[k] = kStiffnessMax * uniform(20 + k);
  }
  model.depth_max = 5e-3;
  return model;
}

WavePayload LyingCodec::wave(std::uint64_t lie) noexcept {
  wave_integral_ += period_ * kWaveMax * (2 * random_uniform(seed_, kLieStream, lie) - 1);
  return {.wave_integral = wave_integral_, .wave_energy = kEnergyDeclared};
}

// NOLINTNEXTLINE(bugprone-exception-escape): copying a payload does not throw
std::size_t LyingCodec::encode(const WireTelegram& telegram,
                               std::span<std::byte, message::kTelegramSizeMax> out) noexcept {
  const std::uint64_t lie = told_++ / telegrams_per_lie_;
  WireTelegram lying = telegram;
  PortSample& port = lying.telegram.port;
  if (std::holds_alternative<ModelPayload>(port.payload)) {
    port.payload = model(lie);
  } else {
    port.force = kForceMax * random_uniform(seed_, kLieStream, lie);
    if (std::holds_alternative<WavePayload>(port.payload)) port.payload = wave(lie);
    if (std::holds_alternative<TdpaPayload>(port.payload)) {
      port.payload = TdpaPayload{.energy_in = kEnergyDeclared};
    }
  }
  return codec_->encode(lying, out);
}

std::optional<WireTelegram> LyingCodec::decode(std::span<const std::byte> bytes) noexcept {
  return codec_->decode(bytes);
}

}  // namespace palp::lab
