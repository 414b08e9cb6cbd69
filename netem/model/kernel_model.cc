#include "netem/model/kernel_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "netem/model/bottleneck.h"

namespace palp::netem {
namespace {

constexpr std::uint32_t kAll = std::numeric_limits<std::uint32_t>::max();

std::uint32_t as_share(double share) { return static_cast<std::uint32_t>(std::rint(share * kAll)); }

}  // namespace

std::int64_t kernel_delay(std::int64_t mean,
                          std::int32_t jitter,
                          std::span<const std::int16_t> table,
                          std::uint32_t draw) noexcept {
  constexpr std::int64_t kScale = 8192;
  if (jitter == 0) return mean;
  if (table.empty()) {
    const std::uint32_t width = 2 * static_cast<std::uint32_t>(jitter);
    return std::int64_t{draw % width} + mean - jitter;
  }
  const std::int64_t entry = table[draw % table.size()];
  std::int64_t rest = (jitter % kScale) * entry;
  rest += rest >= 0 ? kScale / 2 : -kScale / 2;
  return rest / kScale + (jitter / kScale) * entry + mean;
}

std::vector<std::int16_t> kernel_table(const DelayLaw& law) {
  switch (law.shape) {
    case DelayShape::Normal:
      return normal_table().entries;
    case DelayShape::Pareto:
      return pareto_table().entries;
    case DelayShape::ParetoNormal:
      return paretonormal_table().entries;
    case DelayShape::Table:
      return law.table.entries;
    default:
      return {};
  }
}

KernelModel::KernelModel(const PreparedLaw& law, const Streams& streams)
    : law_{&law}, streams_{streams} {
  // Linux begins each state with a draw of its own; these are of a copy that never is.
  constexpr std::size_t kNobody = 255;
  duplicate_state_.last = draw(Stage::Duplicate, kNobody);
  loss_state_.last = draw(Stage::Loss, kNobody);
  corrupt_state_.last = draw(Stage::Corrupt, kNobody);
  reorder_state_.last = draw(Stage::Reorder, kNobody);
  delay_state_.last = draw(Stage::Delay, kNobody);
  change(law);
}

void KernelModel::change(const PreparedLaw& law) noexcept {
  law_ = &law;
  const Impairment& impairment = law.impairment;
  constexpr std::int64_t kJitterMax = std::numeric_limits<std::int32_t>::max();
  duplicate_ = as_share(impairment.duplicate.share);
  loss_ = as_share(impairment.loss.share);
  corrupt_ = as_share(impairment.corrupt.share);
  reorder_ = as_share(impairment.reorder.chance.share);
  // tc sends the duplicates' correlation with the others', if there is one: never alone.
  const bool sent = impairment.loss.correlation > 0 || impairment.corrupt.correlation > 0 ||
                    impairment.reorder.chance.correlation > 0 || impairment.delay.correlation > 0;
  duplicate_state_.rho = sent ? as_share(impairment.duplicate.correlation) : 0;
  loss_state_.rho = as_share(impairment.loss.correlation);
  corrupt_state_.rho = as_share(impairment.corrupt.correlation);
  reorder_state_.rho = as_share(impairment.reorder.chance.correlation);
  delay_state_.rho = as_share(impairment.delay.correlation);
  if (const auto& chain = impairment.state) {
    chain_ = {as_share(chain->p13),
              as_share(chain->p31),
              as_share(chain->p32),
              as_share(chain->p14),
              as_share(chain->p23)};
  }
  if (const auto& chain = impairment.gemodel) {
    chain_ = {as_share(chain->to_bad),
              as_share(chain->to_good),
              kAll - as_share(chain->loss_bad),
              as_share(chain->loss_good),
              0};
  }
  jitter_ = static_cast<std::int32_t>(std::min(impairment.delay.jitter.count(), kJitterMax));
}

KernelModel::Share KernelModel::Correlated::next(Share draw) noexcept {
  if (rho == 0) return draw;
  const std::uint64_t weight = std::uint64_t{rho} + 1;
  const std::uint64_t sum = draw * ((std::uint64_t{1} << 32U) - weight) + last * weight;
  last = static_cast<Share>(sum >> 32U);
  return last;
}

KernelModel::Share KernelModel::draw(Stage stage, std::size_t copy) const noexcept {
  return static_cast<Share>(streams_.of(stage, copy).bits(index_) >> 32U);
}

std::span<const CopyOutcome> KernelModel::next(const Arrival& arrival) noexcept {
  last_at_ = first_ ? arrival.at : std::max(arrival.at, last_at_);
  first_ = false;
  const TimePoint now = std::max(last_at_, arrival.held_until);
  CopyOutcome& original = copies_[0];
  CopyOutcome& copy = copies_[1];
  original = {.tos = arrival.tos, .length = static_cast<std::uint32_t>(arrival.length)};

  bool duplicated =
      duplicate_ > 0 && duplicate_ >= duplicate_state_.next(draw(Stage::Duplicate, 0));
  if (loss_event(0)) {
    const bool markable = law_->impairment.ecn && (original.tos & kEcnMask) != 0;
    if (markable) {
      original.tos |= kEcnMask;
    } else if (duplicated) {
      duplicated = false;  // one more and one less
    } else {
      original.verdict = Verdict::Lost;
    }
  }
  copy = original;
  if (original.verdict == Verdict::Delivered) {
    corrupt(original, 0);
    if (arrival.room == 0) {
      original.verdict = Verdict::OverLimit;
      copy.verdict = Verdict::OverLimit;
    } else {
      if (duplicated && survives(copy, 1)) enqueue(copy, 1, now);
      enqueue(original, 0, now);
    }
  }
  ++index_;
  return std::span{copies_}.first(duplicated ? 2 : 1);
}

/// The copy passes the stages from the start.
bool KernelModel::survives(CopyOutcome& outcome, std::size_t copy) noexcept {
  if (loss_event(copy)) {
    if (law_->impairment.ecn && (outcome.tos & kEcnMask) != 0) {
      outcome.tos |= kEcnMask;
    } else {
      outcome.verdict = Verdict::Lost;
      return false;
    }
  }
  corrupt(outcome, copy);
  return true;
}

bool KernelModel::loss_event(std::size_t copy) noexcept {
  if (law_->impairment.state) return four_state_loss(draw(Stage::StateSteps, copy));
  if (law_->impairment.gemodel) return gemodel_loss(copy);
  return loss_ > 0 && loss_ >= loss_state_.next(draw(Stage::Loss, copy));
}

/// The sums overflow as Linux's do, and a draw exactly on an inner border changes nothing.
bool KernelModel::four_state_loss(Share draw) noexcept {
  const auto [p13, p31, p32, p14, p23] = chain_;
  const Share leave_good = p13 + p14;
  const Share leave_lost = p31 + p32;
  switch (state_) {
    case 1:
      if (draw < p14) {
        state_ = 4;
        return true;
      }
      if (p14 < draw && draw < leave_good) {
        state_ = 3;
        return true;
      }
      return false;
    case 2:
      if (draw >= p23) return false;
      state_ = 3;
      return true;
    case 3:
      if (draw < p32) {
        state_ = 2;
      } else if (p32 < draw && draw < leave_lost) {
        state_ = 1;
      } else {
        return leave_lost < draw;
      }
      return false;
    default:
      state_ = 1;
      return false;
  }
}

bool KernelModel::gemodel_loss(std::size_t copy) noexcept {
  const auto [to_bad, to_good, kept_in_bad, lost_in_good, unused] = chain_;
  const bool was_bad = state_ == 2;
  const Share step = draw(Stage::GemodelSteps, copy);
  if (step < (was_bad ? to_good : to_bad)) state_ = was_bad ? 1 : 2;
  const Share loss = draw(Stage::GemodelLoss, copy);
  return was_bad ? loss > kept_in_bad : loss < lost_in_good;
}

void KernelModel::corrupt(CopyOutcome& outcome, std::size_t copy) noexcept {
  if (corrupt_ == 0 || corrupt_ < corrupt_state_.next(draw(Stage::Corrupt, copy))) return;
  const std::uint64_t bits = 8 * (kFrameHeaders + std::uint64_t{outcome.length});
  const std::uint64_t pick = (std::uint64_t{draw(Stage::CorruptBit, copy)} * bits) >> 32U;
  outcome.flipped_bit = static_cast<std::int32_t>(pick);
  if (pick < 8 * kFrameHeaders) outcome.verdict = Verdict::HeaderHit;
}

/// The tail of the way in: sent at once ahead of the queue, or delayed. A frame whose header was
/// hit takes the same way; it is its receiver that drops it.
void KernelModel::enqueue(CopyOutcome& outcome, std::size_t copy, TimePoint now) noexcept {
  const std::uint32_t gap = law_->impairment.reorder.gap;
  const bool delayed =
      gap == 0 || counter_ < gap - 1 || reorder_ < reorder_state_.next(draw(Stage::Reorder, copy));
  if (!delayed) {
    counter_ = 0;
    outcome.immediate = true;
    outcome.release = now;
    return;
  }
  Duration wait = delay(copy);
  outcome.delay = wait;
  TimePoint from = now;
  if (law_->impairment.rate.bytes_per_s > 0) {
    if (tail_ > now) {  // it comes behind the last one in the queue
      wait = std::max(wait - (tail_ - now), Duration{});
      from = tail_;
    }
    wait += line_time(law_->impairment.rate, outcome.length + kFrameHeaders);
  }
  outcome.release = std::max(from + wait, now);
  tail_ = std::max(tail_, outcome.release);
  ++counter_;
}

Duration KernelModel::delay(std::size_t copy) noexcept {
  const std::int64_t mean = law_->impairment.delay.mean.count();
  if (jitter_ == 0) return Duration{mean};
  const Share drawn = delay_state_.next(draw(Stage::Delay, copy));
  return Duration{kernel_delay(mean, jitter_, law_->table, drawn)};
}

}  // namespace palp::netem
