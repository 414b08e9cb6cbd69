#include "common/record/sequence_count.h"

#include <algorithm>

namespace palp::record {

void SequenceCount::see(std::uint32_t sequence) {
  if (sequence < next_) {
    ++disordered_;
    fill(sequence);
    return;
  }
  if (sequence > next_) {
    missing_ += sequence - next_;
    if (gaps_.size() < kGapsMax) gaps_.push_back({static_cast<std::uint32_t>(next_), sequence});
  }
  next_ = std::uint64_t{sequence} + 1;
}

void SequenceCount::fill(std::uint32_t sequence) {
  const auto gap = std::ranges::find_if(
      gaps_, [&](const Gap& one) { return one.from <= sequence && sequence < one.to; });
  if (gap == gaps_.end()) return;
  --missing_;
  const Gap behind{sequence + 1, gap->to};
  gap->to = sequence;
  if (gap->from != gap->to) {
    if (behind.from != behind.to && gaps_.size() < kGapsMax) gaps_.push_back(behind);
  } else {
    *gap = behind;  // empty, it holds nothing
  }
}

}  // namespace palp::record
