#include "common/link/replay_window.h"

#include <algorithm>

#include "common/core/check.h"

namespace palp::link {

bool ReplayWindow::bit(std::uint64_t number) const noexcept {
  return (words_[number / kWordBits % kWords] >> number % kWordBits & 1U) != 0;
}

ReplayWindow::Verdict ReplayWindow::judge(std::uint64_t number) const noexcept {
  if (empty() || number > newest_) return Verdict::New;
  if (newest_ - number >= kSize) return Verdict::TooOld;
  return bit(number) ? Verdict::Seen : Verdict::New;
}

void ReplayWindow::mark(std::uint64_t number) noexcept {
  PALP_CHECK(judge(number) == Verdict::New, "a number is marked once");
  const std::uint64_t word_before = newest_ / kWordBits;
  const std::uint64_t word = number / kWordBits;
  if (word > word_before) {
    const std::uint64_t stale = std::min<std::uint64_t>(word - word_before, kWords);
    for (std::uint64_t i = 0; i < stale; ++i) words_[(word - i) % kWords] = 0;
  }
  words_[word % kWords] |= 1ULL << number % kWordBits;
  newest_ = std::max(newest_, number);
  ++marked_;
}

std::uint32_t ReplayWindow::before_newest() const noexcept {
  const std::uint64_t word = newest_ / kWordBits;
  const std::uint64_t place = newest_ % kWordBits;
  // The 64 numbers below the newest one, the nearest in the highest bit.
  std::uint64_t below = place == 0 ? 0 : words_[word % kWords] << (kWordBits - place);
  if (word > 0) below |= words_[(word - 1) % kWords] >> place;
  std::uint32_t bits = 0;
  for (std::uint32_t k = 0; k < 32; ++k, below <<= 1U) {
    bits |= static_cast<std::uint32_t>(below >> (kWordBits - 1)) << k;
  }
  return bits;
}

}  // namespace palp::link
