#include "netem/fate.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/core/check.h"
#include "common/core/random.h"
#include "common/link/transport.h"

namespace palp::netem {
namespace {

/// Keeps our streams apart from those of everybody else who draws with the same seed ("netem").
constexpr std::uint64_t kStreamBase = 0x6e65'7465'6d00'0000ULL;

/// After so many stays within one gap the chain has forgotten where it was: it is entered afresh
/// from its stationary law, which bounds the work per datagram.
constexpr int kStaysPerGapMax = 256;

bool is_share(double value) { return value >= 0 && value <= 1; }

bool is_time(Duration value) { return value >= Duration{} && value <= kTimeMax; }

bool is_sound(const Impairment& impairment) {
  const DelayLaw& delay = impairment.delay;
  const GilbertLaw& gilbert = impairment.gilbert;
  const bool stays =
      gilbert.bad == Duration{} || (gilbert.good >= kStayMin && gilbert.bad >= kStayMin);
  return is_time(delay.mean) && is_time(delay.jitter) && is_share(delay.floor) &&
         is_share(delay.correlation) && is_time(delay.correlation_time) &&
         is_share(impairment.loss) && is_share(impairment.duplicate) &&
         impairment.burst.rate >= 0 && impairment.burst.rate <= kBurstRateMax &&
         is_time(impairment.burst.length) && is_time(gilbert.good) && is_time(gilbert.bad) &&
         is_share(gilbert.loss_bad) && is_share(gilbert.loss_good) && stays;
}

}  // namespace

FateSequence::FateSequence(const Impairment& impairment,
                           std::uint64_t seed,
                           Direction direction,
                           TimePoint start)
    : impairment_{impairment},
      seed_{seed},
      base_stream_{kStreamBase | (static_cast<std::uint64_t>(direction) << 16U)},
      start_{start},
      correlated_{impairment.delay.correlation > 0 ||
                  impairment.delay.correlation_time > Duration{}} {
  PALP_CHECK(is_sound(impairment),
             "an impairment's shares lie in 0..1 and its times in 0..kTimeMax");
  if (const double asked = impairment.delay.correlation; asked > 0) {
    // The correlation of the delays is the one asked for. A uniform one is Phi(z), whose
    // correlation is (6/pi) asin(a/2) (Kruskal 1958).
    carry_ = impairment.delay.shape == DelayShape::Uniform
                 ? 2 * std::sin(std::numbers::pi * asked / 6)
                 : asked;
    fresh_ = std::sqrt(1 - carry_ * carry_);
  }
}

Fate FateSequence::next(const Arrival& arrival) noexcept {
  const TimePoint at = first_ ? arrival.at : std::max(arrival.at, last_at_);
  correlate(first_ ? Duration{} : at - last_at_);

  Fate fate;
  fate.index = index_;
  fate.count = hits(impairment_.duplicate, Stage::Duplicate, 0) ? 2 : 1;
  const bool dark = in_blackout(at);
  const bool burst = in_burst(at);
  const double gilbert = gilbert_loss(at);
  std::size_t room = arrival.length > link::kDatagramSizeMax ? 0 : arrival.room;
  for (std::size_t copy = 0; copy < fate.count; ++copy) {
    CopyFate& copy_fate = fate.copies[copy];
    if (dark) {
      copy_fate.verdict = Verdict::Blackout;
    } else if (burst || hits(impairment_.loss, Stage::Loss, copy) ||
               hits(gilbert, Stage::StayLoss, copy)) {
      copy_fate.verdict = Verdict::Lost;
    } else if (room == 0) {
      copy_fate.verdict = Verdict::OverLimit;
    }
    const bool delivered = copy_fate.verdict == Verdict::Delivered;
    if (delivered || (correlated_ && copy == 0)) draw_delay(copy_fate, copy);
    if (!delivered) continue;
    --room;
    copy_fate.release = at + copy_fate.delay;
    if (impairment_.order == Order::Keep) {
      copy_fate.release = std::max(copy_fate.release, last_release_);
      last_release_ = copy_fate.release;
    }
  }
  z_before_ = z_;
  last_at_ = at;
  first_ = false;
  ++index_;
  return fate;
}

std::uint64_t FateSequence::stream(Stage stage, std::size_t copy) const noexcept {
  return base_stream_ | (static_cast<std::uint64_t>(stage) << 8U) | copy;
}

bool FateSequence::hits(double probability, Stage stage, std::size_t copy) const noexcept {
  if (probability <= 0) return false;
  if (probability >= 1) return true;
  return random_uniform(seed_, stream(stage, copy), index_) < probability;
}

bool FateSequence::in_blackout(TimePoint at) const noexcept {
  const Duration elapsed = at - start_;
  return std::any_of(impairment_.blackouts.begin(),
                     impairment_.blackouts.end(),
                     [elapsed](const Blackout& window) {
                       return elapsed >= window.from && elapsed < window.from + window.length;
                     });
}

bool FateSequence::in_burst(TimePoint at) noexcept {
  const BurstLaw& law = impairment_.burst;
  if (law.length == Duration{} || law.rate <= 0) return false;
  if (burst_seen_ && at < burst_until_) return true;
  if (first_) return false;
  const TimePoint quiet_since = burst_seen_ ? std::max(last_at_, burst_until_) : last_at_;
  const double expected = law.rate * seconds(at - quiet_since);
  const double draw = random_uniform(seed_, stream(Stage::Burst), index_);
  // rate * dt, saturating as a Poisson process does when the gap is long.
  if (draw >= expected || draw >= -std::expm1(-expected)) return false;
  burst_seen_ = true;
  burst_until_ = at + law.length;
  return true;
}

double FateSequence::gilbert_loss(TimePoint at) noexcept {
  const GilbertLaw& law = impairment_.gilbert;
  if (law.bad == Duration{}) return 0;
  if (first_) enter_stay(at);
  for (int stays = 0; at >= stay_until_; ++stays) {
    ++stay_;
    if (stays == kStaysPerGapMax) {
      enter_stay(at);
      break;
    }
    stay_is_bad_ = !stay_is_bad_;
    const Duration mean = stay_is_bad_ ? law.bad : law.good;
    const double draw = random_uniform(seed_, stream(Stage::StayLength), stay_);
    stay_until_ += from_seconds(-std::log1p(-draw) * seconds(mean));
  }
  return stay_is_bad_ ? law.loss_bad : law.loss_good;
}

/// Enters the chain at `from` as if it had always run: exponential stays have no memory.
void FateSequence::enter_stay(TimePoint from) noexcept {
  const GilbertLaw& law = impairment_.gilbert;
  const double bad_share = seconds(law.bad) / (seconds(law.good) + seconds(law.bad));
  stay_is_bad_ = random_uniform(seed_, stream(Stage::StayState), stay_) < bad_share;
  const double draw = random_uniform(seed_, stream(Stage::StayLength), stay_);
  stay_until_ =
      from + from_seconds(-std::log1p(-draw) * seconds(stay_is_bad_ ? law.bad : law.good));
}

/// Prepares the step of the correlated process over `gap`.
void FateSequence::correlate(Duration gap) noexcept {
  const Duration memory = impairment_.delay.correlation_time;
  if (memory == Duration{} || gap == carry_gap_) return;
  const double span = seconds(gap) / seconds(memory);
  carry_ = std::exp(-span);
  fresh_ = std::sqrt(-std::expm1(-2 * span));
  carry_gap_ = gap;
}

void FateSequence::draw_delay(CopyFate& copy_fate, std::size_t copy) noexcept {
  const DelayLaw& law = impairment_.delay;
  if (law.jitter == Duration{}) {
    copy_fate.delay = law.mean;
    return;
  }
  const auto mean = static_cast<double>(law.mean.count());      // [ns]
  const auto jitter = static_cast<double>(law.jitter.count());  // [ns]
  const double drawn = mean + jitter * draw_shape(copy);        // [ns]
  const double least = law.floor * mean;                        // [ns]
  copy_fate.floored = drawn < least;
  copy_fate.delay = Duration{std::llround(std::max(drawn, least))};
}

/// A draw of the delay's shape: uniform in [-1, 1) or standard normal. A duplicate is a sibling of
/// its original in the correlated process and leaves no trace in it.
double FateSequence::draw_shape(std::size_t copy) noexcept {
  const bool uniform = impairment_.delay.shape == DelayShape::Uniform;
  if (!correlated_ && uniform) {
    return 2 * random_uniform(seed_, stream(Stage::Delay, copy), index_) - 1;
  }
  double z = random_normal(seed_, stream(Stage::Delay, copy), index_);
  if (correlated_) {
    if (!first_) z = carry_ * z_before_ + fresh_ * z;
    if (copy == 0) z_ = z;
  }
  return uniform ? 2 * normal_cdf(z) - 1 : z;
}

}  // namespace palp::netem
