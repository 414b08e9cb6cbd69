#include "netem/loss_laws.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palp::netem {
namespace {

/// After so many stays within one gap the chain has forgotten where it was: it is entered afresh
/// from its stationary law, which bounds the work per datagram.
constexpr int kStaysPerGapMax = 256;
constexpr std::uint64_t kEndless = std::uint64_t{1} << 62U;  ///< datagrams, more than there are
constexpr double kStallMax = 3600;  ///< [s], an hour: keeps the log-normal within the line of time

Duration exponential(double mean, double draw) noexcept {
  constexpr double kMeanMax = 1e8;  // [s], three years: 36 of them stay on the line of time
  return from_seconds(-std::log1p(-draw) * std::min(mean, kMeanMax));
}

/// 1 + floor(exponential draw times this) is the length of a run in which each is followed by one
/// more with probability `stays`.
double run_scale(double stays) noexcept {
  return stays <= 0   ? 0
         : stays >= 1 ? std::numeric_limits<double>::infinity()
                      : -1 / std::log(stays);
}

}  // namespace

void ChanceProcess::begin(const Chance& law) noexcept {
  law_ = law;
  hits_ = run_scale(law.share + law.correlation * (1 - law.share));
  misses_ = run_scale(1 - law.share * (1 - law.correlation));
  hit_ = law.share <= 0 || stream_.uniform(number_++) >= law.share;
  turn();
}

/// Hits after misses and the other way round.
void ChanceProcess::turn() noexcept {
  hit_ = !hit_;
  const double scale = hit_ ? hits_ : misses_;
  const double more = -std::log(random_middle(stream_.bits(number_++))) * scale;
  left_ = 1 + (more < static_cast<double>(kEndless) ? static_cast<std::uint64_t>(more) : kEndless);
}

bool FourStateProcess::next(const FourStateLaw& law, std::uint64_t index) noexcept {
  const double draw = stream_.uniform(index);
  switch (state_) {
    case 1:
      state_ = draw < law.p14 ? 4 : draw < law.p14 + law.p13 ? 3 : 1;
      break;
    case 2:
      state_ = draw < law.p23 ? 3 : 2;
      break;
    case 3:
      state_ = draw < law.p32 ? 2 : draw < law.p32 + law.p31 ? 1 : 3;
      break;
    default:
      state_ = 1;
      break;
  }
  return state_ >= 3;
}

bool BurstProcess::next(const BurstLaw& law, TimePoint at, std::uint64_t index) noexcept {
  const bool was_first = first_;
  const TimePoint last_at = last_at_;
  first_ = false;
  last_at_ = at;
  if (seen_ && at < until_) return true;
  if (was_first) return false;
  const TimePoint quiet_since = seen_ ? std::max(last_at, until_) : last_at;
  const double expected = law.rate * seconds(at - quiet_since);
  const double draw = stream_.uniform(index);
  // rate * dt, saturating as a Poisson process does when the gap is long.
  if (draw >= expected || draw >= -std::expm1(-expected)) return false;
  seen_ = true;
  until_ = at + law.length;
  return true;
}

double GilbertTimeProcess::next(const GilbertLaw& law, TimePoint at) noexcept {
  if (!begun_) enter(law, at);
  begun_ = true;
  for (int stays = 0; at >= until_; ++stays) {
    ++stay_;
    if (stays == kStaysPerGapMax) {
      enter(law, at);
      break;
    }
    bad_ = !bad_;
    until_ += exponential(seconds(bad_ ? law.bad : law.good), lengths_.uniform(stay_));
  }
  return bad_ ? law.loss_bad : law.loss_good;
}

/// Enters the chain at `from` as if it had always run: exponential stays have no memory.
void GilbertTimeProcess::enter(const GilbertLaw& law, TimePoint from) noexcept {
  const double bad_share = seconds(law.bad) / (seconds(law.good) + seconds(law.bad));
  bad_ = states_.uniform(stay_) < bad_share;
  until_ = from + exponential(seconds(bad_ ? law.bad : law.good), lengths_.uniform(stay_));
}

TimePoint StallProcess::next(const StallLaw& law, TimePoint at) noexcept {
  if (!begun_) plan(law, at);
  begun_ = true;
  for (int stalls = 0; at >= until_; ++stalls) {
    // After a long silence the past is as good as never: the next stall is planned from here.
    plan(law, stalls < kStaysPerGapMax ? until_ : at);
  }
  return at >= from_ ? until_ : at;
}

void StallProcess::plan(const StallLaw& law, TimePoint from) noexcept {
  from_ = from + exponential(1 / law.rate, gaps_.uniform(number_));
  const double length = seconds(law.median) * std::exp(law.spread * lengths_.normal(number_));
  until_ = from_ + std::max(from_seconds(std::min(length, kStallMax)), Duration{1});
  ++number_;
}

}  // namespace palp::netem
