#include "surgeon_site/encoder.h"

#include <cmath>
#include <numbers>

#include "common/core/check.h"

namespace palp::surgeon {
namespace {

constexpr Duration kPeriod = std::chrono::milliseconds{1};

double low_pass_gain(double cut_off, Duration span) noexcept {
  return 1 - std::exp(-2 * std::numbers::pi * cut_off * seconds(span));
}

}  // namespace

Encoder::Encoder(double step, double cut_off, double position) noexcept
    : step_{step}, cut_off_{cut_off}, gain_of_period_{low_pass_gain(cut_off, kPeriod)} {
  PALP_CHECK(step > 0, "an encoder counts steps");
  position_ = in_steps(position);
}

double Encoder::in_steps(double position) const noexcept {
  return step_ * std::round(position / step_);
}

void Encoder::sample(double position, Duration span) noexcept {
  const double now = in_steps(position);
  const double gain = span == kPeriod ? gain_of_period_ : low_pass_gain(cut_off_, span);
  velocity_ += gain * ((now - position_) / seconds(span) - velocity_);
  position_ = now;
}

}  // namespace palp::surgeon
