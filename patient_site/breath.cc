#include "patient_site/breath.h"

#include <cmath>
#include <numbers>

#include "common/core/random.h"

namespace palp::patient {
namespace {

using std::numbers::pi;

constexpr std::uint64_t kBreathStream = 0x627265617468;  // "breath"

}  // namespace

Breath::Breath(const BreathConfig& config) noexcept
    : config_{config}, from_{-config.amplitude}, to_{config.amplitude} {
  if (!(config.variation > 0) || !(config.frequency > 0)) return;
  // As the sine does, it begins in the middle of a way inwards.
  span_ = 0.5 / config.frequency;
  began_ = -0.5 * span_;
}

/// [-], the draw's share of the mean.
double Breath::varied(std::uint64_t draw) const noexcept {
  return 1 + config_.variation * (2 * random_uniform(config_.seed, kBreathStream, draw) - 1);
}

void Breath::breathe_on() noexcept {
  ++half_;
  began_ += span_;
  span_ = 0.5 / config_.frequency * varied(2 * half_);
  from_ = to_;
  to_ = (half_ % 2 == 0 ? 1 : -1) * config_.amplitude * varied(2 * half_ + 1);
}

Breath::Motion Breath::at(double time) noexcept {
  if (!(config_.amplitude > 0)) return {};
  if (!(span_ > 0)) {
    const double omega = 2 * pi * config_.frequency;
    const double phase = omega * time;
    return {config_.amplitude * std::sin(phase), config_.amplitude * omega * std::cos(phase)};
  }
  while (time >= began_ + span_) breathe_on();
  const double rate = pi / span_;
  const double phase = rate * (time - began_);
  const double half_way = 0.5 * (to_ - from_);
  return {from_ + half_way * (1 - std::cos(phase)), half_way * rate * std::sin(phase)};
}

}  // namespace palp::patient
