#include "netem/model/exact_model.h"

#include <algorithm>

namespace palp::netem {
namespace {

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
      chances_{law.impairment, streams},
      path_{law.impairment, streams, start},
      bottleneck_{law.impairment},
      delays_{law, streams, start},
      slots_{streams.of(Stage::Slot), start} {
  change(law);
}

void ExactModel::change(const PreparedLaw& law) noexcept {
  law_ = &law;
  chances_.change(law.impairment, index_);
  path_.change(law.impairment, last_at_);
  bottleneck_.change(law.impairment);
  recording_.rewind();
  delays_.change(law);
  order_.change(law.impairment);
  slots_.change(law);
}

void ExactModel::lean(const PreparedLaw& towards, double share) noexcept {
  chances_.lean(towards.impairment, share, index_);
  delays_.lean(towards, share);
}

std::span<const CopyOutcome> ExactModel::next(const Arrival& arrival) noexcept {
  const TimePoint at = first_ ? arrival.at : std::max(arrival.at, last_at_);
  delays_.begin(index_, first_ ? Duration{} : at - last_at_);
  last_at_ = at;
  std::size_t count = 1;
  if (!law_->impairment.replay.rows.empty()) {
    count = recording_.outcomes(law_->impairment.replay, index_, at, arrival, copies_);
  } else if (chances_.quiet(index_) && path_.calm(at)) {
    copies_[0] = untouched(arrival);
    go_on(copies_[0], 0, Chances{}, std::max(at, arrival.held_until), arrival.room > 0);
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
  const Chances original = chances_.next(index_);
  if (flood_ > 0) chances_.wake();
  const PathCondition path = path_.calm(at) ? PathCondition{.onward = at} : path_.at(at, index_);
  const std::size_t count = 1 + (original.duplicate ? 1U : 0U) + flood_;
  std::size_t room = arrival.room;
  for (std::size_t copy = 0; copy < count; ++copy) {
    CopyOutcome& outcome = copies_[copy];
    outcome = untouched(arrival);
    const Chances chances = copy == 0 ? original : chances_.of_copy(original, copy, index_);
    harm(outcome, copy, chances, path);
    go_on(outcome, copy, chances, std::max(path.onward, arrival.held_until), room > 0);
    if (outcome.verdict == Verdict::Delivered) --room;
  }
  return count;
}

[[gnu::always_inline]] inline void ExactModel::go_on(CopyOutcome& outcome,
                                                     std::size_t copy,
                                                     const Chances& chances,
                                                     TimePoint onward,
                                                     bool room) noexcept {
  if (on_its_way(outcome) && !(room && fits(outcome))) outcome.verdict = Verdict::OverLimit;
  if (on_its_way(outcome) || (copy == 0 && delays_.remembers())) {
    const DelaySequence::Drawn drawn = delays_.draw(copy, onward);
    outcome.delay = drawn.delay;
    outcome.floored = drawn.floored;
  }
  if (on_its_way(outcome)) leave(outcome, chances, onward);
}

/// Losses, lengths, flipped bits and blackouts.
void ExactModel::harm(CopyOutcome& outcome,
                      std::size_t copy,
                      const Chances& chances,
                      const PathCondition& path) const noexcept {
  if (lost(copy, chances, path)) {
    const bool markable = law_->impairment.ecn && (outcome.tos & kEcnMask) != 0;
    if (markable) outcome.tos |= kEcnMask;
    if (!markable) outcome.verdict = Verdict::Lost;
  }
  damage(outcome, copy, chances);
  if (path.dark) outcome.verdict = Verdict::Blackout;
}

bool ExactModel::lost(std::size_t copy,
                      const Chances& chances,
                      const PathCondition& path) const noexcept {
  const auto strikes = [&](double share, Stage stage) {
    return share > 0 && streams_.of(stage, copy).uniform(index_) < share;
  };
  return chances.lost || chances.swept || path.lost || strikes(path.loss_state, Stage::StayLoss) ||
         strikes(chances.loss_gemodel, Stage::GemodelLoss);
}

void ExactModel::damage(CopyOutcome& outcome,
                        std::size_t copy,
                        const Chances& chances) const noexcept {
  const Impairment& law = law_->impairment;
  if (chances.cut) {
    outcome.length =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(outcome.length, law.truncate_to));
  }
  const std::uint64_t headers = 8 * kFrameHeaders;
  const std::uint64_t payload = 8 * std::uint64_t{outcome.length};
  const std::uint64_t from = law.corrupt_payload ? headers : 0;
  if (!chances.flipped || headers + payload == from) return;
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
                                                     const Chances& chances,
                                                     TimePoint onward) noexcept {
  TimePoint from = onward;
  if (!bottleneck_.off()) {
    from = bottleneck_.pass(onward, outcome.length + kFrameHeaders);
    if (from == Bottleneck::kDropped) {
      outcome.verdict = Verdict::OverLimit;
      return;
    }
  }
  outcome.immediate = chances.jumps;
  TimePoint release =
      chances.jumps ? from : order_.fit(from + outcome.delay, last_at_, chances.swaps);
  if (slots_.on()) release = slots_.fit(release, outcome.length + kFrameHeaders);
  outcome.release = release;
}

}  // namespace palp::netem
