#include "lab/run/adversary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/core/random.h"

namespace palp::lab {
namespace {

constexpr std::uint64_t kLieStream = 0x6c69'6500'0000ULL;  // "lie"
constexpr Duration kOtherLaws = std::chrono::milliseconds{50};
constexpr double kSwingMax = 2e-3;                                              // [m]
constexpr double kSwingRateMax = 6;                                             // [rad/s]
constexpr double kSurfaceMax = 3e-3;                                            // [m]
constexpr std::array<double, kModelTerms> kTermMax{0.1, 0.3, 0.1, 0.02, 1e-4};  // [N]
constexpr double kStiffnessMax = 600;                                           // [N/m], at a knot
constexpr double kShareMax = 0.3;        // [-], of what relaxes
constexpr double kForceMax = 3;          // [N]
constexpr double kWaveMax = 1;           // [sqrt(W)], of either sign: forces of some newtons
constexpr double kEnergyDeclared = 1e3;  // [J]

}  // namespace

LieManner drawn_manner(std::uint64_t seed) noexcept {
  constexpr double kKinds = 6;
  const double length = 10 * std::pow(10.0, 2 * random_uniform(seed, kLieStream + 50, 0));  // [ms]
  return {static_cast<LieManner::Kind>(kKinds * random_uniform(seed, kLieStream + 51, 0)),
          from_seconds(1e-3 * length)};
}

LyingCodec::LyingCodec(std::unique_ptr<link::Codec> codec,
                       std::uint64_t seed,
                       Duration period,
                       const LieManner& manner)
    : codec_{std::move(codec)}, seed_{seed}, manner_{manner}, period_{seconds(period)} {}

ModelPayload LyingCodec::tissue(std::uint64_t lie) const noexcept {
  const auto uniform = [&](std::uint64_t which) {
    return random_uniform(seed_, kLieStream + which, lie);
  };
  ModelPayload model;
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

/// After so many lies. What does not change of one tissue lies where the hand meets it.
ModelPayload LyingCodec::model(double turns) const noexcept {
  using Kind = LieManner::Kind;
  const auto lie = static_cast<std::uint64_t>(turns);
  const double swell = 0.5 + 0.5 * std::sin(std::numbers::pi * turns);  // [-]
  ModelPayload model = tissue(manner_.kind == Kind::Tissues ? lie : 0);
  if (manner_.kind != Kind::Tissues) model.surface = -0.3 * kSurfaceMax;
  const auto grow = [&model](double by) {
    for (double& c : model.c) c *= by;
    for (double& stiffness : model.stiffness) stiffness *= by;
  };
  switch (manner_.kind) {
    case Kind::Tissues:
      break;
    case Kind::TwoInTurn:
      grow(lie % 2 == 0 ? 0.2 : 1);
      break;
    case Kind::Stiffness:
      grow(swell);
      break;
    case Kind::Surface:
      model.surface += kSurfaceMax * (swell - 0.5);
      break;
    case Kind::Breath:
      model.swing = kSwingMax * (2 * random_uniform(seed_, kLieStream + 40, lie) - 1);
      model.swing_quadrature = kSwingMax * (2 * random_uniform(seed_, kLieStream + 41, lie) - 1);
      model.swing_rate = kSwingRateMax * random_uniform(seed_, kLieStream + 42, lie);
      break;
    case Kind::Relaxing:
      for (double& share : model.relaxing) share = lie % 2 == 0 ? 0 : 1;
      break;
  }
  model.version = static_cast<std::uint32_t>(told_);
  return model;
}

WavePayload LyingCodec::wave(std::uint64_t lie) noexcept {
  wave_integral_ += period_ * kWaveMax * (2 * random_uniform(seed_, kLieStream, lie) - 1);
  return {.wave_integral = wave_integral_, .wave_energy = kEnergyDeclared};
}

// NOLINTNEXTLINE(bugprone-exception-escape): copying a payload does not throw
std::size_t LyingCodec::encode(const WireTelegram& telegram,
                               std::span<std::byte, message::kTelegramSizeMax> out) noexcept {
  const double time = period_ * static_cast<double>(told_++);  // [s]
  const auto lie = static_cast<std::uint64_t>(time / seconds(kOtherLaws));
  WireTelegram lying = telegram;
  PortSample& port = lying.telegram.port;
  if (std::holds_alternative<ModelPayload>(port.payload)) {
    port.payload = model(time / seconds(manner_.length));
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
