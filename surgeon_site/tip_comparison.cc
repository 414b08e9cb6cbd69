#include "surgeon_site/tip_comparison.h"

#include <algorithm>
#include <cmath>

namespace palp::surgeon {
namespace {

constexpr double kBin = 10e-3;         // [s]
constexpr double kMemory = 50e-3;      // [s], of means
constexpr double kNoiseLeast = 0.045;  // [N], with a sensor of kStep
constexpr double kNoiseShare = 0.045;  // [-], of the measured force
constexpr double kStep = 0.05;         // [N]
constexpr double kSum = 3e-3;          // [N s], beyond the limit
constexpr double kSumMost = 4e-3;      // [N s]
constexpr double kOver = 0.8;          // [-], of the limit: below it is over
constexpr double kOverTime = 0.1;      // [s]
constexpr double kRestSpeed = 8e-3;    // [m/s]
constexpr double kRestTime = 50e-3;    // [s], until what a motion pressed more is gone

/// [N], from which a difference is no matter of the sensor: the mean of a force that stands still
/// is off by half a step at most.
double limit_of(double measured, const ForceSensorFacts& sensor) noexcept {
  const double coarse = 0.5 * std::max(0.0, sensor.step - kStep);
  return std::max(kNoiseLeast, kNoiseShare * measured) + coarse;
}

}  // namespace

void TipComparison::look(const Look& now, const PatientDevices& devices, double passed) noexcept {
  now_.given += now.given * passed;
  now_.measured += now.measured * passed;
  now_.position += now.position * passed;
  now_.tip += now.tip * passed;
  now_.span += passed;
  // A hair: the sum of ten periods may fall short of ten.
  if (now_.span < kBin * (1 - 1e-6)) return;
  const double span = now_.span;
  const Sums mean{
      now_.given / span, now_.measured / span, now_.position / span, now_.tip / span, span};
  const double way = count_ == 0 ? 0 : mean.position - position_;
  given_[count_++ % kBins] = {mean.given, way};
  position_ = mean.position;
  compare(mean, now.round_trip, devices);
  now_ = {};
}

void TipComparison::compare(const Sums& mean,
                            double round_trip,
                            const PatientDevices& devices) noexcept {
  const double ago = round_trip + devices.stage.lag + devices.sensor.lag;
  const auto back = static_cast<std::size_t>(
      std::clamp(std::ceil(ago / kBin), 0.0, static_cast<double>(kBins - 1)));
  if (back >= count_) return;
  const Bin& then = given_[(count_ - 1 - back) % kBins];
  const bool rests = std::abs(then.way) <= kRestSpeed * kBin;
  rested_ = rests ? rested_ + kBin : 0;
  if (rested_ <= kRestTime) return;
  const double share = -std::expm1(-kBin / kMemory);
  const bool as_deep = mean.position >= mean.tip;
  const double given = as_deep ? std::min(then.force, mean.given) : then.force;
  measured_ += share * (mean.measured - measured_);
  more_ += share * (mean.measured - given - more_);
  judge(limit_of(measured_, devices.sensor));
}

void TipComparison::judge(double limit) noexcept {
  sum_ = std::clamp(sum_ + (more_ - limit) * kBin, 0.0, kSumMost);
  if (!says_) {
    says_ = sum_ >= kSum;
    below_ = 0;
    return;
  }
  below_ = more_ < kOver * limit ? below_ + kBin : 0;
  if (below_ < kOverTime) return;
  says_ = false;
  sum_ = 0;
}

}  // namespace palp::surgeon
