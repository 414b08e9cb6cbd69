#include "netem/model/loss_laws.h"

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

/// The length of a run after its first, of run_scale() and a draw.
std::uint64_t run(double scale, std::uint64_t bits) noexcept {
  const double more = scale == 0 ? 0 : -std::log(random_middle(bits)) * scale;
  return more < static_cast<double>(kEndless) ? static_cast<std::uint64_t>(more) : kEndless;
}

}  // namespace

void ChanceProcess::take_law(const Chance& law) noexcept {
  law_ = law;
  hits_ = run_scale(law.share + law.correlation * (1 - law.share));
  misses_ = run_scale(1 - law.share * (1 - law.correlation));
}

/// What is left of a geometric run is geometric again, so it may be drawn afresh: the next datagram
/// is in this run, as was decided, and who comes behind it follows the new law.
void ChanceProcess::rescale(const Chance& law) noexcept {
  take_law(law);
  hit_ = hit_ && law.share > 0;
  left_ = 1 + run(hit_ ? hits_ : misses_, stream_.bits(number_++));
}

void ChanceProcess::begin(const Chance& law) noexcept {
  take_law(law);
  hit_ = law.share <= 0 || stream_.uniform(number_++) >= law.share;
  turn();
}

/// Hits after misses and the other way round.
void ChanceProcess::turn() noexcept {
  hit_ = !hit_;
  left_ = 1 + run(hit_ ? hits_ : misses_, stream_.bits(number_++));
}

void FourStateProcess::begin(const FourStateLaw& law) noexcept {
  law_ = law;
  scales_ = {0,
             run_scale(1 - law.p13 - law.p14),
             run_scale(1 - law.p23),
             run_scale(1 - law.p31 - law.p32),
             0};
  left_ = more();
  if (left_ == 0) turn();
}

/// How many of the next datagrams stay in the present state.
std::uint64_t FourStateProcess::more() noexcept {
  return run(scales_[state_], stream_.bits(number_++));
}

/// Leaves the state, to where is drawn.
void FourStateProcess::turn() noexcept {
  const double draw = stream_.uniform(number_++);
  switch (state_) {
    case 1:
      state_ = draw * std::min(law_.p13 + law_.p14, 1.0) < law_.p14 ? 4 : 3;
      break;
    case 2:
      state_ = 3;
      break;
    case 3:
      state_ = draw * std::min(law_.p31 + law_.p32, 1.0) < law_.p32 ? 2 : 1;
      break;
    default:
      state_ = 1;
      break;
  }
  left_ = 1 + more();
}

void GemodelProcess::begin(const GemodelLaw& law) noexcept {
  law_ = law;
  goods_ = run_scale(1 - law.to_bad);
  bads_ = run_scale(1 - law.to_good);
  turn(bad_);
}

void GemodelProcess::turn(bool bad) noexcept {
  bad_ = bad;
  left_ = 1 + run(bad_ ? bads_ : goods_, steps_.bits(number_++));
}

void BurstProcess::change(const BurstLaw& law, TimePoint at) noexcept {
  if (law == law_) return;
  law_ = law;
  if (begun_ && on() && at >= until_) plan(at);
}

bool BurstProcess::next(TimePoint at) noexcept {
  if (!begun_) plan(at);
  begun_ = true;
  if (at < from_) return false;
  if (until_ <= from_) {
    from_ = at;
    until_ = at + law_.length;
  }
  if (at < until_) return true;
  plan(until_);
  return next(at);
}

void BurstProcess::plan(TimePoint from) noexcept {
  from_ = from + exponential(1 / law_.rate, gaps_.uniform(number_++));
}

void GilbertTimeProcess::change(const GilbertLaw& law, TimePoint at) noexcept {
  if (law == law_) return;
  law_ = law;
  if (!begun_ || !on()) return;
  ++stay_;
  until_ = at + stay();
}

double GilbertTimeProcess::next(TimePoint at) noexcept {
  if (!begun_) enter(at);
  begun_ = true;
  for (int stays = 0; at >= until_; ++stays) {
    ++stay_;
    if (stays == kStaysPerGapMax) {
      enter(at);
      break;
    }
    bad_ = !bad_;
    until_ += stay();
  }
  return bad_ ? law_.loss_bad : law_.loss_good;
}

/// Enters the chain at `from` as if it had always run: exponential stays have no memory.
void GilbertTimeProcess::enter(TimePoint from) noexcept {
  const double bad_share = seconds(law_.bad) / (seconds(law_.good) + seconds(law_.bad));
  bad_ = states_.uniform(stay_) < bad_share;
  until_ = from + stay();
}

Duration GilbertTimeProcess::stay() noexcept {
  return exponential(seconds(bad_ ? law_.bad : law_.good), lengths_.uniform(stay_));
}

void StallProcess::change(const StallLaw& law, TimePoint at) noexcept {
  if (law == law_) return;
  const bool was_on = on();
  law_ = law;
  if (begun_ && on() && (at < from_ || !was_on)) plan(at);
}

TimePoint StallProcess::next(TimePoint at) noexcept {
  if (!begun_) plan(at);
  begun_ = true;
  for (int stalls = 0; at >= until_; ++stalls) {
    // After a long silence the past is as good as never: the next stall is planned from here.
    plan(stalls < kStaysPerGapMax ? until_ : at);
  }
  return at >= from_ ? until_ : at;
}

void StallProcess::plan(TimePoint from) noexcept {
  from_ = from + exponential(1 / law_.rate, gaps_.uniform(number_));
  const double length = seconds(law_.median) * std::exp(law_.spread * lengths_.normal(number_));
  until_ = from_ + std::max(from_seconds(std::min(length, kStallMax)), Duration{1});
  ++number_;
}

}  // namespace palp::netem
