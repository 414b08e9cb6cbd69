#include "common/core/filters.h"

#include <cmath>
#include <numbers>

#include "common/core/check.h"

namespace palp {

LowPass::LowPass(double cut_off, double period) noexcept
    : gain_{1 - std::exp(-2 * std::numbers::pi * cut_off * period)} {
  PALP_CHECK(cut_off > 0 && period > 0, "a low pass needs a positive cut-off and period");
}

double LowPass::step(double input, std::int64_t periods) noexcept {
  if (periods <= 1) return step(input);
  const double gain = -std::expm1(static_cast<double>(periods) * std::log1p(-gain_));
  return value_ += gain * (input - value_);
}

VelocityEstimate::VelocityEstimate(double cut_off, double period) noexcept
    : filter_{cut_off, period}, period_{period} {}

void VelocityEstimate::reset() noexcept {
  started_ = false;
  filter_.reset(0);
}

double VelocityEstimate::step(double position, std::int64_t periods) noexcept {
  if (!started_) previous_ = position;
  started_ = true;
  const double rate = (position - previous_) / (period_ * static_cast<double>(periods));
  previous_ = position;
  return filter_.step(rate, periods);
}

}  // namespace palp
