#include "netem/model/exact_model.h"

#include <algorithm>
#include <cmath>

namespace palp::netem {
namespace {

constexpr std::uint8_t kEcnMask = 3;  ///< RFC 3168: 0: cannot be marked, 3: is marked

/// 0 .. count - 1, evenly.
std::uint64_t pick(std::uint64_t bits, std::uint64_t count) noexcept {
  return ((bits >> 32U) * count) >> 32U;
}

bool on_its_way(const CopyOutcome& outcome) noexcept {
  return outcome.verdict == Verdict::Delivered || outcome.verdict == Verdict::HeaderHit;
}

}  // namespace

ExactModel::ExactModel(const PreparedLaw& law, const Streams& streams, TimePoint start)
    : law_{&law},
      streams_{streams},
      start_{start},
      duplicate_{law.impairment.duplicate, streams.of(Stage::Duplicate)},
      loss_{law.impairment.loss, streams.of(Stage::Loss)},
      corrupt_{law.impairment.corrupt, streams.of(Stage::Corrupt)},
      truncate_{law.impairment.truncate, streams.of(Stage::Truncate)},
      reorder_{law.impairment.reorder.chance, streams.of(Stage::Reorder)},
      swap_{law.impairment.swap, streams.of(Stage::Swap)},
      state_{law.impairment.state.value_or(FourStateLaw{}), streams.of(Stage::StateSteps)},
      gemodel_{law.impairment.gemodel.value_or(GemodelLaw{}), streams.of(Stage::GemodelSteps)},
      burst_{streams.of(Stage::Burst)},
      gilbert_{streams.of(Stage::StayState), streams.of(Stage::StayLength)},
      stall_{streams.of(Stage::StallGap), streams.of(Stage::StallLength)},
      bottleneck_{law.impairment},
      delays_{law, streams, start},
      stay_loss_stream_{streams.of(Stage::StayLoss)},
      gemodel_loss_stream_{streams.of(Stage::GemodelLoss)},
      slots_{streams.of(Stage::Slot), start} {
  change(law);
}

void ExactModel::change(const PreparedLaw& law) noexcept {
  catch_up();
  quiet_end_ = 0;
  law_ = &law;
  const Impairment& impairment = law.impairment;
  duplicate_.change(impairment.duplicate);
  loss_.change(impairment.loss);
  corrupt_.change(impairment.corrupt);
  truncate_.change(impairment.truncate);
  reorder_.change(impairment.reorder.chance);
  swap_.change(impairment.swap);
  state_.change(impairment.state.value_or(FourStateLaw{}));
  gemodel_.change(impairment.gemodel.value_or(GemodelLaw{}));
  burst_.change(impairment.burst, last_at_);
  gilbert_.change(impairment.gilbert, last_at_);
  stall_.change(impairment.stall, last_at_);
  bottleneck_.change(impairment);
  calm_until_ = TimePoint::min();
  recording_.rewind();
  delays_.change(law);
  slots_.change(law);
}

void ExactModel::lean(const PreparedLaw& towards, double share) noexcept {
  catch_up();
  quiet_end_ = 0;
  const auto mix = [share](const Chance& one, const Chance& to) {
    return Chance{std::lerp(one.share, to.share, share),
                  std::lerp(one.correlation, to.correlation, share)};
  };
  const Impairment& from = law_->impairment;
  const Impairment& to = towards.impairment;
  delays_.lean(towards, share);
  loss_.lean(mix(from.loss, to.loss));
  duplicate_.lean(mix(from.duplicate, to.duplicate));
  corrupt_.lean(mix(from.corrupt, to.corrupt));
}

std::span<const CopyOutcome> ExactModel::next(const Arrival& arrival) noexcept {
  const TimePoint at = first_ ? arrival.at : std::max(arrival.at, last_at_);
  delays_.begin(index_, first_ ? Duration{} : at - last_at_);
  last_at_ = at;
  std::size_t count = 1;
  if (!law_->impairment.replay.rows.empty()) {
    count = recording_.outcomes(law_->impairment.replay, index_, at, arrival, copies_);
  } else if (index_ < quiet_end_ && at < calm_until_) {
    copies_[0] = untouched(arrival);
    go_on(copies_[0], 0, std::max(at, arrival.held_until), arrival.room > 0);
  } else {
    count = next_troubled(arrival, at);
  }
  first_ = false;
  ++index_;
  return std::span{copies_}.first(count);
}

inline CopyOutcome ExactModel::untouched(const Arrival& arrival) const noexcept {
  const bool clear = law_->impairment.dscp_clear;
  return {.tos = static_cast<std::uint8_t>(clear ? arrival.tos & kEcnMask : arrival.tos),
          .length = static_cast<std::uint32_t>(arrival.length)};
}

/// @returns how many there are of it.
std::size_t ExactModel::next_troubled(const Arrival& arrival, TimePoint at) noexcept {
  draw_chances();
  const Common common = common_outcome(at);
  const std::size_t count = 1 + (chances_.duplicate ? 1U : 0U) + flood_;
  std::size_t room = arrival.room;
  for (std::size_t copy = 0; copy < count; ++copy) {
    CopyOutcome& outcome = copies_[copy];
    outcome = untouched(arrival);
    harm(outcome, copy, common);
    go_on(outcome, copy, std::max(common.onward, arrival.held_until), room > 0);
    if (outcome.verdict == Verdict::Delivered) --room;
  }
  chances_ = {};
  return count;
}

[[gnu::always_inline]] inline void ExactModel::go_on(CopyOutcome& outcome,
                                                     std::size_t copy,
                                                     TimePoint onward,
                                                     bool room) noexcept {
  if (on_its_way(outcome) && !(room && fits(outcome))) outcome.verdict = Verdict::OverLimit;
  if (on_its_way(outcome) || (copy == 0 && delays_.remembers())) {
    const DelaySequence::Drawn drawn = delays_.draw(copy, onward);
    outcome.delay = drawn.delay;
    outcome.floored = drawn.floored;
  }
  if (on_its_way(outcome)) leave(outcome, copy, onward);
}

/// Tells the processes how many datagrams passed without asking them.
void ExactModel::catch_up() noexcept {
  const std::uint64_t passed = index_ - asked_;
  for (ChanceProcess* process : {&duplicate_, &loss_, &truncate_, &corrupt_}) process->skip(passed);
  state_.skip(passed);
  gemodel_.skip(passed);
  if (law_->impairment.reorder.gap == 1) reorder_.skip(passed);
  if (law_->impairment.order == Order::Swap) swap_.skip(passed);
  asked_ = index_;
}

/// Every process is asked, whatever the others said: their states do not depend on each other. And
/// how long none of them will have anything to say.
void ExactModel::draw_chances() noexcept {
  const Impairment& law = law_->impairment;
  catch_up();
  const bool swaps = law.order == Order::Swap;
  chances_ = {.duplicate = duplicate_.next(),
              .lost = loss_.next(),
              .swept = state_.next(),
              .loss_gemodel = gemodel_.next(),
              .cut = truncate_.next(),
              .flipped = corrupt_.next(),
              .jumps = law.reorder.gap > 0 && jumps(),
              .swaps = swaps && swap_.next()};
  asked_ = index_ + 1;
  std::uint64_t quiet = std::min({duplicate_.quiet(),
                                  loss_.quiet(),
                                  truncate_.quiet(),
                                  corrupt_.quiet(),
                                  state_.quiet(),
                                  gemodel_.quiet()});
  if (law.reorder.gap > 0) quiet = law.reorder.gap == 1 ? std::min(quiet, reorder_.quiet()) : 0;
  if (swaps) quiet = std::min(quiet, swap_.quiet());
  quiet_end_ = flood_ > 0 ? 0 : asked_ + quiet;
}

/// Of every datagram, lost or not, so that losses move no other draw.
inline bool ExactModel::jumps() noexcept {
  if (++since_reorder_ < law_->impairment.reorder.gap || !reorder_.next()) return false;
  since_reorder_ = 0;
  return true;
}

ExactModel::Common ExactModel::common_outcome(TimePoint at) noexcept {
  const Impairment& law = law_->impairment;
  Common common{.onward = at, .lost = chances_.swept};
  common.dark = in_blackout(at);
  if (burst_.on()) common.lost = burst_.next(at) || common.lost;
  if (!law.bitmap.lost.empty()) {
    common.lost = common.lost || law.bitmap.lost[index_ % law.bitmap.lost.size()];
  }
  if (gilbert_.on()) common.loss_state = gilbert_.next(at);
  if (stall_.on()) common.onward = stall_.next(at);
  calm_until_ = calm_until(at);
  return common;
}

/// Until when nothing of what comes in time will act.
TimePoint ExactModel::calm_until(TimePoint at) const noexcept {
  const Impairment& law = law_->impairment;
  if (!law.bitmap.lost.empty()) return TimePoint::min();
  TimePoint until = TimePoint::max();
  for (const Blackout& window : law.blackouts) {
    if (at - start_ < window.from + window.length) until = std::min(until, start_ + window.from);
  }
  if (burst_.on()) until = std::min(until, burst_.harmless_until());
  if (gilbert_.on()) until = std::min(until, gilbert_.harmless_until());
  if (stall_.on()) until = std::min(until, stall_.begins());
  return until;
}

bool ExactModel::in_blackout(TimePoint at) const noexcept {
  const Duration elapsed = at - start_;
  return std::any_of(law_->impairment.blackouts.begin(),
                     law_->impairment.blackouts.end(),
                     [elapsed](const Blackout& window) {
                       return elapsed >= window.from && elapsed < window.from + window.length;
                     });
}

/// Losses, lengths, flipped bits and blackouts.
void ExactModel::harm(CopyOutcome& outcome, std::size_t copy, const Common& common) const noexcept {
  if (lost(copy, common)) {
    const bool markable = law_->impairment.ecn && (outcome.tos & kEcnMask) != 0;
    if (markable) outcome.tos |= kEcnMask;
    if (!markable) outcome.verdict = Verdict::Lost;
  }
  damage(outcome, copy);
  if (common.dark) outcome.verdict = Verdict::Blackout;
}

bool ExactModel::lost(std::size_t copy, const Common& common) const noexcept {
  const auto draw = [&](RandomStream original, Stage stage) {
    return stream_of(original, stage, copy).uniform(index_);
  };
  const bool random =
      copy == 0 ? chances_.lost : loss_.aside(streams_.of(Stage::Loss, copy), index_);
  return common.lost || random ||
         (common.loss_state > 0 && draw(stay_loss_stream_, Stage::StayLoss) < common.loss_state) ||
         (chances_.loss_gemodel > 0 &&
          draw(gemodel_loss_stream_, Stage::GemodelLoss) < chances_.loss_gemodel);
}

void ExactModel::damage(CopyOutcome& outcome, std::size_t copy) const noexcept {
  const Impairment& law = law_->impairment;
  const bool cut =
      copy == 0 ? chances_.cut : truncate_.aside(streams_.of(Stage::Truncate, copy), index_);
  if (cut) {
    outcome.length =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(outcome.length, law.truncate_to));
  }
  const bool hit =
      copy == 0 ? chances_.flipped : corrupt_.aside(streams_.of(Stage::Corrupt, copy), index_);
  const std::uint64_t headers = 8 * kFrameHeaders;
  const std::uint64_t payload = 8 * std::uint64_t{outcome.length};
  const std::uint64_t from = law.corrupt_payload ? headers : 0;
  if (!hit || headers + payload == from) return;
  const std::uint64_t bits = streams_.of(Stage::CorruptBit, copy).bits(index_);
  outcome.flipped_bit = static_cast<std::int32_t>(from + pick(bits, headers + payload - from));
  if (outcome.verdict == Verdict::Delivered &&
      outcome.flipped_bit < static_cast<std::int32_t>(headers)) {
    outcome.verdict = Verdict::HeaderHit;
  }
}

inline bool ExactModel::fits(const CopyOutcome& outcome) const noexcept {
  const std::uint64_t mtu = law_->impairment.mtu;
  return mtu == 0 || outcome.length + kFrameHeaders - kEthernetHeader <= mtu;
}

/// Through the line, after its delay, in order, at its slot. Only the original jumps or swaps.
[[gnu::always_inline]] inline void ExactModel::leave(CopyOutcome& outcome,
                                                     std::size_t copy,
                                                     TimePoint onward) noexcept {
  TimePoint from = onward;
  if (!bottleneck_.off()) {
    from = bottleneck_.pass(onward, outcome.length + kFrameHeaders);
    if (from == Bottleneck::kDropped) {
      outcome.verdict = Verdict::OverLimit;
      return;
    }
  }
  outcome.immediate = copy == 0 && chances_.jumps;
  TimePoint release = outcome.immediate ? from : from + outcome.delay;
  const Order order = law_->impairment.order;
  if (order == Order::Keep && !outcome.immediate) {
    // Which of the two it is cannot be foreseen: no branch.
    const TimePoint last = last_release_;
    release = release < last ? last : release;
    last_release_ = release;
  } else if (order == Order::Swap && !outcome.immediate) {
    release = swap_order(release, copy == 0 && chances_.swaps);
  }
  if (slots_.on()) release = slots_.fit(release, outcome.length + kFrameHeaders);
  outcome.release = release;
}

/// Who swaps leaves before those who came just before it.
TimePoint ExactModel::swap_order(TimePoint release, bool swaps) noexcept {
  const std::uint64_t depth = std::min<std::uint64_t>(law_->impairment.swap_depth, released_);
  const TimePoint overtaken =
      depth > 0 ? releases_[(released_ - depth) % kSwapDepthMax] : TimePoint::min();
  if (swaps && overtaken > last_at_) return std::max(overtaken - Duration{1}, last_at_);
  last_release_ = std::max(release, last_release_);
  releases_[released_++ % kSwapDepthMax] = last_release_;
  return last_release_;
}

}  // namespace palp::netem
