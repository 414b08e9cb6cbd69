#include "netem/exact_fates.h"

#include <algorithm>
#include <cmath>

namespace palp::netem {
namespace {

/// Slots that are walked through one by one in a gap; then the grid is entered afresh.
constexpr int kSlotsPerGapMax = 256;
constexpr std::uint8_t kEcnMask = 3;  ///< RFC 3168: 0: cannot be marked, 3: is marked

/// 0 .. count - 1, evenly.
std::uint64_t pick(std::uint64_t bits, std::uint64_t count) noexcept {
  return ((bits >> 32U) * count) >> 32U;
}

Duration rounded(double nanoseconds) noexcept {
  return Duration{static_cast<std::int64_t>(nanoseconds + 0.5)};
}

}  // namespace

ExactFates::ExactFates(const PreparedLaw& law, const Streams& streams, TimePoint start)
    : law_{&law},
      streams_{streams},
      start_{start},
      duplicate_{law.impairment.duplicate, streams.of(Stage::Duplicate)},
      loss_{law.impairment.loss, streams.of(Stage::Loss)},
      corrupt_{law.impairment.corrupt, streams.of(Stage::Corrupt)},
      truncate_{law.impairment.truncate, streams.of(Stage::Truncate)},
      reorder_{law.impairment.reorder.chance, streams.of(Stage::Reorder)},
      swap_{law.impairment.swap, streams.of(Stage::Swap)},
      state_{streams.of(Stage::StateSteps)},
      gemodel_{streams.of(Stage::GemodelSteps)},
      burst_{streams.of(Stage::Burst)},
      gilbert_{streams.of(Stage::StayState), streams.of(Stage::StayLength)},
      stall_{streams.of(Stage::StallGap), streams.of(Stage::StallLength)},
      bottleneck_{law.impairment},
      delay_stream_{streams.of(Stage::Delay)},
      stay_loss_stream_{streams.of(Stage::StayLoss)},
      gemodel_loss_stream_{streams.of(Stage::GemodelLoss)},
      slot_stream_{streams.of(Stage::Slot)} {
  change(law);
}

void ExactFates::change(const PreparedLaw& law) noexcept {
  law_ = &law;
  const Impairment& impairment = law.impairment;
  duplicate_.change(impairment.duplicate);
  loss_.change(impairment.loss);
  corrupt_.change(impairment.corrupt);
  truncate_.change(impairment.truncate);
  reorder_.change(impairment.reorder.chance);
  swap_.change(impairment.swap);
  bottleneck_.change(impairment);
  trace_at_ = 0;
  shared_ = !impairment.blackouts.empty() || impairment.burst.length > Duration{} ||
            impairment.state || impairment.gemodel || !impairment.bitmap.lost.empty() ||
            impairment.gilbert.bad > Duration{} || impairment.stall.median > Duration{} ||
            impairment.reorder.gap > 0 || impairment.order == Order::Swap;
  damages_ = impairment.truncate.share > 0 || impairment.corrupt.share > 0;
  mean_ = law.curve.mean();
  jitter_ = law.curve.jitter();
  least_ = impairment.delay.floor * mean_;
  drawn_ = impairment.delay.jitter > Duration{} || impairment.delay.shape == DelayShape::Histogram;
  correlated_ = drawn_ && (law.carry > 0 || impairment.delay.correlation_time > Duration{});
  carry_ = law.carry;
  fresh_ = std::sqrt(1 - carry_ * carry_);
  carry_gap_ = Duration{-1};
}

void ExactFates::lean(const Impairment& towards, double share) noexcept {
  const auto between = [share](double from, double to) { return from + share * (to - from); };
  const auto mix = [&](const Chance& one, const Chance& to) {
    return Chance{between(one.share, to.share), between(one.correlation, to.correlation)};
  };
  const auto count = [](Duration span) { return static_cast<double>(span.count()); };
  const Impairment& from = law_->impairment;
  const DelayLaw& law = from.delay;
  mean_ = between(count(law.mean), count(towards.delay.mean));
  jitter_ = between(count(law.jitter), count(towards.delay.jitter));
  least_ = between(law.floor, towards.delay.floor) * mean_;
  drawn_ = jitter_ > 0;
  loss_.change(mix(from.loss, towards.loss));
  duplicate_.change(mix(from.duplicate, towards.duplicate));
  corrupt_.change(mix(from.corrupt, towards.corrupt));
  damages_ = true;
}

std::span<const CopyFate> ExactFates::next(const Arrival& arrival) noexcept {
  const TimePoint at = first_ ? arrival.at : std::max(arrival.at, last_at_);
  if (!law_->impairment.replay.rows.empty()) return replay(arrival);
  if (correlated_) correlate(first_ ? Duration{} : at - last_at_);
  last_at_ = at;

  const std::size_t count = 1 + (duplicate_.next(index_) ? 1U : 0U) + flood_;
  Common common;
  common.onward = at;
  if (shared_) common = common_fate(at);
  common.onward = std::max(common.onward, arrival.held_until);
  std::size_t room = arrival.room;
  for (std::size_t copy = 0; copy < count; ++copy) {
    CopyFate& fate = copies_[copy];
    fate = {.tos = arrival.tos, .length = static_cast<std::uint32_t>(arrival.length)};
    if (law_->impairment.dscp_clear) fate.tos &= kEcnMask;
    if (lost(common, copy)) {
      const bool markable = law_->impairment.ecn && (fate.tos & kEcnMask) != 0;
      if (markable) fate.tos |= kEcnMask;
      if (!markable) fate.verdict = Verdict::Lost;
    }
    if (damages_) damage(fate, copy);
    if (common.dark) {
      fate.verdict = Verdict::Blackout;
    } else if (fate.verdict != Verdict::Lost &&
               (room == 0 ||
                (law_->impairment.mtu > 0 &&
                 fate.length + kFrameHeaders - kEthernetHeader > law_->impairment.mtu))) {
      fate.verdict = Verdict::OverLimit;
    }
    draw_delay(fate, copy, common);
    if (fate.verdict != Verdict::Delivered && fate.verdict != Verdict::HeaderHit) continue;
    put_in_order(fate, copy == 0 && common.swaps);
    if (fate.verdict == Verdict::Delivered) --room;
  }
  first_ = false;
  z_before_ = z_;
  ++index_;
  return std::span{copies_}.first(count);
}

inline ExactFates::Common ExactFates::common_fate(TimePoint at) noexcept {
  Common common;
  common.onward = at;
  common.dark = !law_->impairment.blackouts.empty() && in_blackout(at);
  if (law_->impairment.burst.length > Duration{})
    common.lost = burst_.next(law_->impairment.burst, at, index_);
  if (law_->impairment.state)
    common.lost = state_.next(*law_->impairment.state, index_) || common.lost;
  if (!law_->impairment.bitmap.lost.empty()) {
    const auto& lost = law_->impairment.bitmap.lost;
    common.lost = common.lost || lost[index_ % lost.size()];
  }
  if (law_->impairment.gemodel)
    common.loss_gemodel = gemodel_.next(*law_->impairment.gemodel, index_);
  if (law_->impairment.gilbert.bad > Duration{}) {
    common.loss_state = gilbert_.next(law_->impairment.gilbert, at);
  }
  if (law_->impairment.stall.median > Duration{} && law_->impairment.stall.rate > 0) {
    common.onward = stall_.next(law_->impairment.stall, at);
  }
  common.jumps = law_->impairment.reorder.gap > 0 && jumps();
  common.swaps = law_->impairment.order == Order::Swap && swap_.next(index_);
  return common;
}

/// Of every datagram, lost or not, so that losses move no other draw.
inline bool ExactFates::jumps() noexcept {
  if (++since_reorder_ < law_->impairment.reorder.gap || !reorder_.next(index_)) return false;
  since_reorder_ = 0;
  return true;
}

bool ExactFates::in_blackout(TimePoint at) const noexcept {
  const Duration elapsed = at - start_;
  return std::any_of(law_->impairment.blackouts.begin(),
                     law_->impairment.blackouts.end(),
                     [elapsed](const Blackout& window) {
                       return elapsed >= window.from && elapsed < window.from + window.length;
                     });
}

/// Every process is asked, whatever the others said: their states do not depend on each other.
inline bool ExactFates::lost(const Common& common, std::size_t copy) noexcept {
  bool lost = common.lost;
  const bool random =
      copy == 0 ? loss_.next(index_) : loss_.aside(streams_.of(Stage::Loss, copy), index_);
  lost = lost || random;
  if (common.loss_state > 0) {
    lost = lost ||
           stream_of(stay_loss_stream_, Stage::StayLoss, copy).uniform(index_) < common.loss_state;
  }
  if (common.loss_gemodel > 0) {
    lost = lost || stream_of(gemodel_loss_stream_, Stage::GemodelLoss, copy).uniform(index_) <
                       common.loss_gemodel;
  }
  return lost;
}

inline void ExactFates::damage(CopyFate& fate, std::size_t copy) noexcept {
  if (!truncate_.off()) {
    const bool cut = copy == 0 ? truncate_.next(index_)
                               : truncate_.aside(streams_.of(Stage::Truncate, copy), index_);
    if (cut) {
      fate.length = static_cast<std::uint32_t>(
          std::min<std::uint64_t>(fate.length, law_->impairment.truncate_to));
    }
  }
  if (corrupt_.off()) return;
  const bool hit =
      copy == 0 ? corrupt_.next(index_) : corrupt_.aside(streams_.of(Stage::Corrupt, copy), index_);
  const std::uint64_t headers = 8 * kFrameHeaders;
  const std::uint64_t payload = 8 * std::uint64_t{fate.length};
  const std::uint64_t from = law_->impairment.corrupt_payload ? headers : 0;
  if (!hit || headers + payload == from) return;
  const std::uint64_t bits = streams_.of(Stage::CorruptBit, copy).bits(index_);
  fate.flipped_bit = static_cast<std::int32_t>(from + pick(bits, headers + payload - from));
  if (fate.verdict == Verdict::Delivered && fate.flipped_bit < static_cast<std::int32_t>(headers)) {
    fate.verdict = Verdict::HeaderHit;
  }
}

/// Prepares the step of the correlated process over `gap`.
inline void ExactFates::correlate(Duration gap) noexcept {
  const Duration memory = law_->impairment.delay.correlation_time;
  if (memory == Duration{} || gap == carry_gap_) return;
  const double span = seconds(gap) / seconds(memory);
  carry_ = std::exp(-span);
  fresh_ = std::sqrt(-std::expm1(-2 * span));
  carry_gap_ = gap;
}

/// A draw for each original, got through or not: correlated delays and the rest stay apart.
inline void ExactFates::draw_delay(CopyFate& fate,
                                   std::size_t copy,
                                   const Common& common) noexcept {
  const bool delivered = fate.verdict == Verdict::Delivered || fate.verdict == Verdict::HeaderHit;
  if (!delivered && (copy > 0 || !correlated_)) return;
  if (!law_->impairment.trace.points.empty()) {
    fate.delay = traced_delay(common.onward, copy);
  } else if (!drawn_) {
    fate.delay = rounded(mean_);
  } else {
    double around = 0;  // [1], in units of the jitter
    if (correlated_) {
      around = law_->curve.at_normal(draw_normal(copy));
    } else {
      const RandomStream stream = stream_of(delay_stream_, Stage::Delay, copy);
      around = law_->curve.by_normal() ? law_->curve.at_normal(law_->normal.at(stream.bits(index_)))
                                       : law_->curve.at_share(random_middle(stream.bits(index_)));
    }
    const double drawn = mean_ + jitter_ * around;
    fate.floored = drawn < least_;
    fate.delay = rounded(std::max(drawn, least_));
  }
  if (!delivered) return;
  TimePoint from = common.onward;
  if (!bottleneck_.off()) {
    from = bottleneck_.pass(common.onward, fate.length + kFrameHeaders);
    if (from == Bottleneck::kDropped) {
      fate.verdict = Verdict::OverLimit;
      return;
    }
  }
  fate.immediate = copy == 0 && common.jumps;
  fate.release = fate.immediate ? from : from + fate.delay;
}

/// A standard normal. A duplicate is a sibling of its original in the correlated process and leaves
/// no trace in it.
inline double ExactFates::draw_normal(std::size_t copy) noexcept {
  const RandomStream stream = stream_of(delay_stream_, Stage::Delay, copy);
  double z = law_->normal.at(stream.bits(index_));
  if (!first_) z = carry_ * z_before_ + fresh_ * z;
  if (copy == 0) z_ = z;
  return z;
}

/// The arrival time, sent + delay, is interpolated, not the delay: so a stall keeps its shape, hold
/// and then a bunch, and order is kept.
Duration ExactFates::traced_delay(TimePoint onward, std::size_t copy) noexcept {
  const auto& points = law_->impairment.trace.points;
  const Duration since = onward - start_ - points.front().sent;
  const Duration step = points.back().sent - points[points.size() - 2].sent;
  const Duration turn = points.back().sent - points.front().sent + step;
  Duration inside = since;
  if (law_->impairment.trace.loop && since > Duration{}) inside = since % turn;
  inside += points.front().sent;
  if (trace_at_ >= points.size() || points[trace_at_].sent > inside) trace_at_ = 0;
  const auto after = std::upper_bound(
      points.begin() + static_cast<std::ptrdiff_t>(trace_at_),
      points.end(),
      inside,
      [](Duration time, const DelayTrace::Point& point) { return time < point.sent; });
  Duration delay = points.front().delay;
  if (after != points.begin()) {
    const DelayTrace::Point& left = *(after - 1);
    trace_at_ = static_cast<std::size_t>(after - points.begin()) - 1;
    delay = left.delay;
    if (after != points.end() && inside > left.sent) {
      const double part = seconds(inside - left.sent) / seconds(after->sent - left.sent);
      const Duration arrives = after->sent + after->delay - left.sent - left.delay;
      delay =
          left.delay + rounded(part * static_cast<double>(arrives.count())) - (inside - left.sent);
    }
  }
  if (law_->impairment.trace.dither) {
    delay += rounded((streams_.of(Stage::Dither, copy).uniform(index_) - 0.5) * 1e6 + 1e9) -
             Duration{1'000'000'000};
  }
  return std::max(delay, Duration{});
}

inline void ExactFates::put_in_order(CopyFate& fate, bool swaps) noexcept {
  const TimePoint earliest = last_at_;
  if (law_->impairment.order != Order::Netem && !fate.immediate) {
    fate.release = std::max(fate.release, last_release_);
    const std::uint64_t depth = std::min<std::uint64_t>(law_->impairment.swap_depth, released_);
    const TimePoint overtaken =
        depth > 0 ? releases_[(released_ - depth) % kSwapDepthMax] : TimePoint::min();
    if (swaps && overtaken > earliest) {
      fate.release = std::max(overtaken - Duration{1}, earliest);
    } else {
      last_release_ = fate.release;
      releases_[released_++ % kSwapDepthMax] = fate.release;
    }
  }
  if (law_->impairment.slot.max > Duration{}) fit_slot(fate);
}

/// Moves the release to the slot that has room for it. Slots lie on a grid of their own, drawn by
/// their number; nothing overtakes.
void ExactFates::fit_slot(CopyFate& fate) noexcept {
  const SlotLaw& law = law_->impairment.slot;
  if (!slots_begun_) slot_at_ = start_;
  slots_begun_ = true;
  const auto next_slot = [&](TimePoint from) {
    const double draw = random_middle(slot_stream_.bits(slot_number_++));
    double span = static_cast<double>(law.min.count()) +
                  draw * static_cast<double>((law.max - law.min).count());
    if (law.spacing) span += law_->slot_curve.jitter() * law_->slot_curve.at_share(draw);
    slot_packets_ = 0;
    slot_bytes_ = 0;
    return from + std::max(rounded(std::max(span, 1.0)), Duration{1});
  };
  const auto full = [&] {
    return (law.packets > 0 && slot_packets_ >= law.packets) ||
           (law.bytes > 0 && slot_bytes_ > 0 &&
            slot_bytes_ + fate.length + kFrameHeaders > law.bytes);
  };
  for (int walked = 0; slot_at_ < fate.release || full(); ++walked) {
    slot_at_ = next_slot(walked < kSlotsPerGapMax ? slot_at_ : std::max(slot_at_, fate.release));
  }
  ++slot_packets_;
  slot_bytes_ += fate.length + kFrameHeaders;
  fate.release = slot_at_;
}

std::span<const CopyFate> ExactFates::replay(const Arrival& arrival) noexcept {
  const TimePoint at = first_ ? arrival.at : std::max(arrival.at, last_at_);
  const auto& rows = law_->impairment.replay.rows;
  first_ = false;
  last_at_ = at;
  while (replay_at_ < rows.size() && rows[replay_at_].index < index_) ++replay_at_;
  std::size_t count = 0;
  std::size_t room = arrival.room;
  for (; replay_at_ < rows.size() && rows[replay_at_].index == index_ && count < kCopiesMax;
       ++replay_at_, ++count) {
    const Recording::Row& row = rows[replay_at_];
    copies_[count] = {.verdict = static_cast<Verdict>(row.verdict),
                      .tos = arrival.tos,
                      .flipped_bit = row.flipped_bit,
                      .length = static_cast<std::uint32_t>(arrival.length),
                      .delay = row.delay,
                      .release = at + row.delay};
    if (copies_[count].verdict != Verdict::Delivered) continue;
    if (room == 0) copies_[count].verdict = Verdict::OverLimit;
    if (room > 0) --room;
  }
  if (count == 0) {  // beyond the recording a perfect link
    copies_[count++] = {.verdict = room > 0 ? Verdict::Delivered : Verdict::OverLimit,
                        .tos = arrival.tos,
                        .length = static_cast<std::uint32_t>(arrival.length),
                        .release = at};
  }
  ++index_;
  return std::span{copies_}.first(count);
}

}  // namespace palp::netem
