#include "netem/model/kernel_slots.h"

#include <algorithm>
#include <limits>

#include "netem/model/kernel_model.h"

namespace palp::netem {
namespace {

std::int64_t budget(std::uint64_t most) noexcept {
  constexpr std::int64_t kNone = std::numeric_limits<std::int32_t>::max();
  return most == 0 ? kNone : static_cast<std::int64_t>(most);
}

}  // namespace

KernelSlots::KernelSlots(const PreparedLaw& law, RandomStream stream, TimePoint start) noexcept
    : law_{&law},
      stream_{stream},
      next_{start},
      packets_left_{budget(law.impairment.slot.packets)},
      bytes_left_{budget(law.impairment.slot.bytes)} {}

bool KernelSlots::opens(TimePoint due, TimePoint now) noexcept {
  if (next_ < due) begin_next(now);
  return due <= now && next_ <= now;
}

void KernelSlots::left(std::uint64_t frame, TimePoint now) noexcept {
  --packets_left_;
  bytes_left_ -= static_cast<std::int64_t>(frame);
  if (packets_left_ <= 0 || bytes_left_ <= 0) begin_next(now);
}

void KernelSlots::begin_next(TimePoint now) noexcept {
  const SlotLaw& law = law_->impairment.slot;
  const std::uint64_t draw = stream_.bits(number_++) >> 32U;
  std::int64_t span = 0;
  if (law.spacing) {
    constexpr std::int64_t kJitterMax = std::numeric_limits<std::int32_t>::max();
    const auto jitter =
        static_cast<std::int32_t>(std::min(law.spacing->jitter.count(), kJitterMax));
    span = kernel_delay(
        law.spacing->mean.count(), jitter, law_->slot_table, static_cast<std::uint32_t>(draw));
  } else {
    const auto width = static_cast<std::uint64_t>((law.max - law.min).count());
    // Linux multiplies in 64 bits; the widths that fit there need no more care.
    span = law.min.count() + static_cast<std::int64_t>((draw * width) >> 32U);
  }
  next_ = now + Duration{span};
  packets_left_ = budget(law.packets);
  bytes_left_ = budget(law.bytes);
}

}  // namespace palp::netem
