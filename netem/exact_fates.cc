#include "netem/exact_fates.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

bool goes_on(const CopyFate& fate) noexcept {
  return fate.verdict == Verdict::Delivered || fate.verdict == Verdict::HeaderHit;
}

bool stalls(const Impairment& law) noexcept {
  return law.stall.median > Duration{} && law.stall.rate > 0;
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
      slot_stream_{streams.of(Stage::Slot)},
      slot_at_{start} {
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
  calm_until_ = TimePoint::min();
  mean_ = law.curve.mean();
  jitter_ = law.curve.jitter();
  least_ = impairment.delay.floor * mean_;
  choose_draw(impairment.delay.jitter > Duration{} ||
              impairment.delay.shape == DelayShape::Histogram);
  carry_ = law.carry;
  fresh_ = std::sqrt(1 - carry_ * carry_);
  carry_gap_ = Duration{-1};
  const SlotLaw& slot = impairment.slot;
  constexpr auto kEndless = std::numeric_limits<std::uint64_t>::max();
  slotted_ = slot.max > Duration{};
  slot_min_ = static_cast<double>(slot.min.count());
  slot_width_ = static_cast<double>((slot.max - slot.min).count());
  slot_packets_max_ = slot.packets > 0 ? slot.packets : kEndless;
  slot_bytes_max_ = slot.bytes > 0 ? slot.bytes : kEndless;
}

void ExactFates::choose_draw(bool random) noexcept {
  const DelayLaw& delay = law_->impairment.delay;
  if (!law_->impairment.trace.points.empty()) {
    draw_ = Draw::Trace;
  } else if (!random) {
    draw_ = Draw::Mean;
  } else if (law_->carry > 0 || delay.correlation_time > Duration{}) {
    draw_ = Draw::Correlated;
  } else {
    draw_ = law_->curve.by_normal() ? Draw::Normal : Draw::Share;
  }
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
  choose_draw(jitter_ > 0);
  loss_.change(mix(from.loss, towards.loss));
  duplicate_.change(mix(from.duplicate, towards.duplicate));
  corrupt_.change(mix(from.corrupt, towards.corrupt));
}

std::span<const CopyFate> ExactFates::next(const Arrival& arrival) noexcept {
  const TimePoint at = first_ ? arrival.at : std::max(arrival.at, last_at_);
  const Impairment& law = law_->impairment;
  if (!law.replay.rows.empty()) return replay(arrival);
  if (draw_ == Draw::Correlated) correlate(first_ ? Duration{} : at - last_at_);
  last_at_ = at;

  const Chances chances = draw_chances();
  Common common{.onward = at};
  const bool calm = at < calm_until_;
  if (!calm) common = common_fate(at);
  const TimePoint onward = std::max(common.onward, arrival.held_until);
  const bool harmless = calm && !(chances.lost || chances.cut || chances.flipped);
  const auto tos = static_cast<std::uint8_t>(law.dscp_clear ? arrival.tos & kEcnMask : arrival.tos);
  const std::size_t count = 1 + (chances.duplicate ? 1U : 0U) + flood_;
  std::size_t room = arrival.room;
  for (std::size_t copy = 0; copy < count; ++copy) {
    CopyFate& fate = copies_[copy];
    fate = {.tos = tos, .length = static_cast<std::uint32_t>(arrival.length)};
    if (!harmless || copy > 0) harm(fate, copy, chances, common);
    if (goes_on(fate) && (room == 0 || !fits(fate))) fate.verdict = Verdict::OverLimit;
    // A correlated delay is drawn of each original, got through or not.
    if (goes_on(fate) || (copy == 0 && draw_ == Draw::Correlated)) {
      fate.delay = draw_delay(copy, onward, fate.floored);
    }
    if (!goes_on(fate)) continue;
    leave(fate, onward, copy == 0 && chances.jumps, copy == 0 && chances.swaps);
    if (fate.verdict == Verdict::Delivered) --room;
  }
  first_ = false;
  z_before_ = z_;
  ++index_;
  return std::span{copies_}.first(count);
}

/// Every process is asked, whatever the others said: their states do not depend on each other.
inline ExactFates::Chances ExactFates::draw_chances() noexcept {
  const Impairment& law = law_->impairment;
  return {.duplicate = duplicate_.next(index_),
          .lost = loss_.next(index_),
          .cut = truncate_.next(index_),
          .flipped = corrupt_.next(index_),
          .jumps = law.reorder.gap > 0 && jumps(),
          .swaps = law.order == Order::Swap && swap_.next(index_)};
}

/// Of every datagram, lost or not, so that losses move no other draw.
inline bool ExactFates::jumps() noexcept {
  if (++since_reorder_ < law_->impairment.reorder.gap || !reorder_.next(index_)) return false;
  since_reorder_ = 0;
  return true;
}

ExactFates::Common ExactFates::common_fate(TimePoint at) noexcept {
  const Impairment& law = law_->impairment;
  Common common{.onward = at};
  common.dark = in_blackout(at);
  if (law.burst.length > Duration{}) common.lost = burst_.next(law.burst, at, index_);
  if (law.state) common.lost = state_.next(*law.state, index_) || common.lost;
  if (!law.bitmap.lost.empty()) {
    common.lost = common.lost || law.bitmap.lost[index_ % law.bitmap.lost.size()];
  }
  if (law.gemodel) common.loss_gemodel = gemodel_.next(*law.gemodel, index_);
  if (law.gilbert.bad > Duration{}) common.loss_state = gilbert_.next(law.gilbert, at);
  if (stalls(law)) common.onward = stall_.next(law.stall, at);
  calm_until_ = calm_until(at);
  return common;
}

/// Until when nothing of what holds for all copies will act: the processes that count datagrams
/// must be asked each time, those in time only when theirs has come.
TimePoint ExactFates::calm_until(TimePoint at) const noexcept {
  const Impairment& law = law_->impairment;
  if (law.burst.length > Duration{} || law.state || law.gemodel || !law.bitmap.lost.empty()) {
    return TimePoint::min();
  }
  TimePoint until = TimePoint::max();
  for (const Blackout& window : law.blackouts) {
    if (at - start_ < window.from + window.length) until = std::min(until, start_ + window.from);
  }
  if (law.gilbert.bad > Duration{}) until = std::min(until, gilbert_.harmless_until(law.gilbert));
  if (stalls(law)) until = std::min(until, stall_.begins());
  return until;
}

bool ExactFates::in_blackout(TimePoint at) const noexcept {
  const Duration elapsed = at - start_;
  return std::any_of(law_->impairment.blackouts.begin(),
                     law_->impairment.blackouts.end(),
                     [elapsed](const Blackout& window) {
                       return elapsed >= window.from && elapsed < window.from + window.length;
                     });
}

/// Losses, lengths, flipped bits and blackouts.
void ExactFates::harm(CopyFate& fate,
                      std::size_t copy,
                      const Chances& chances,
                      const Common& common) noexcept {
  if (lost(copy, chances, common)) {
    const bool markable = law_->impairment.ecn && (fate.tos & kEcnMask) != 0;
    if (markable) fate.tos |= kEcnMask;
    if (!markable) fate.verdict = Verdict::Lost;
  }
  damage(fate, copy, chances);
  if (common.dark) fate.verdict = Verdict::Blackout;
}

bool ExactFates::lost(std::size_t copy, const Chances& chances, const Common& common) noexcept {
  const auto draw = [&](RandomStream original, Stage stage) {
    return stream_of(original, stage, copy).uniform(index_);
  };
  const bool random =
      copy == 0 ? chances.lost : loss_.aside(streams_.of(Stage::Loss, copy), index_);
  return common.lost || random ||
         (common.loss_state > 0 && draw(stay_loss_stream_, Stage::StayLoss) < common.loss_state) ||
         (common.loss_gemodel > 0 &&
          draw(gemodel_loss_stream_, Stage::GemodelLoss) < common.loss_gemodel);
}

void ExactFates::damage(CopyFate& fate, std::size_t copy, const Chances& chances) noexcept {
  const Impairment& law = law_->impairment;
  const bool cut =
      copy == 0 ? chances.cut : truncate_.aside(streams_.of(Stage::Truncate, copy), index_);
  if (cut) {
    fate.length = static_cast<std::uint32_t>(std::min<std::uint64_t>(fate.length, law.truncate_to));
  }
  const bool hit =
      copy == 0 ? chances.flipped : corrupt_.aside(streams_.of(Stage::Corrupt, copy), index_);
  const std::uint64_t headers = 8 * kFrameHeaders;
  const std::uint64_t payload = 8 * std::uint64_t{fate.length};
  const std::uint64_t from = law.corrupt_payload ? headers : 0;
  if (!hit || headers + payload == from) return;
  const std::uint64_t bits = streams_.of(Stage::CorruptBit, copy).bits(index_);
  fate.flipped_bit = static_cast<std::int32_t>(from + pick(bits, headers + payload - from));
  if (fate.verdict == Verdict::Delivered && fate.flipped_bit < static_cast<std::int32_t>(headers)) {
    fate.verdict = Verdict::HeaderHit;
  }
}

inline bool ExactFates::fits(const CopyFate& fate) const noexcept {
  const std::uint64_t mtu = law_->impairment.mtu;
  return mtu == 0 || fate.length + kFrameHeaders - kEthernetHeader <= mtu;
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

inline Duration ExactFates::draw_delay(std::size_t copy, TimePoint onward, bool& floored) noexcept {
  if (draw_ == Draw::Mean) return rounded(mean_);
  if (draw_ == Draw::Trace) return traced_delay(onward, copy);
  double around = 0;  // [1], in units of the jitter
  if (draw_ == Draw::Correlated) {
    around = law_->curve.at_normal(draw_normal(copy));
  } else {
    const std::uint64_t bits = stream_of(delay_stream_, Stage::Delay, copy).bits(index_);
    around = draw_ == Draw::Normal ? law_->curve.at_normal(law_->normal.at(bits))
                                   : law_->curve.at_share(random_middle(bits));
  }
  const double drawn = mean_ + jitter_ * around;
  floored = drawn < least_;
  return rounded(std::max(drawn, least_));
}

/// Through the line, after its delay, in order.
inline void ExactFates::leave(CopyFate& fate, TimePoint onward, bool jumps, bool swaps) noexcept {
  TimePoint from = onward;
  if (!bottleneck_.off()) {
    from = bottleneck_.pass(onward, fate.length + kFrameHeaders);
    if (from == Bottleneck::kDropped) {
      fate.verdict = Verdict::OverLimit;
      return;
    }
  }
  fate.immediate = jumps;
  fate.release = jumps ? from : from + fate.delay;
  put_in_order(fate, swaps);
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
  if (slotted_) fit_slot(fate);
}

/// Moves the release to the slot that has room for it. Slots lie on a grid of their own, drawn by
/// their number; nothing overtakes.
inline void ExactFates::fit_slot(CopyFate& fate) noexcept {
  const std::uint64_t length = fate.length + kFrameHeaders;
  const auto full = [&] {
    return slot_packets_ >= slot_packets_max_ ||
           (slot_bytes_ > 0 && slot_bytes_ + length > slot_bytes_max_);
  };
  for (int walked = 0; slot_at_ < fate.release || full(); ++walked) {
    next_slot(walked < kSlotsPerGapMax ? slot_at_ : std::max(slot_at_, fate.release));
  }
  ++slot_packets_;
  slot_bytes_ += length;
  fate.release = slot_at_;
}

inline void ExactFates::next_slot(TimePoint from) noexcept {
  const double draw = random_middle(slot_stream_.bits(slot_number_++));
  double span = slot_min_ + draw * slot_width_;
  if (law_->impairment.slot.spacing) {
    span += law_->slot_curve.jitter() * law_->slot_curve.at_share(draw);
  }
  slot_at_ = from + rounded(std::max(span, 1.0));
  slot_packets_ = 0;
  slot_bytes_ = 0;
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
