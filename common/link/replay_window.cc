#include "common/link/replay_window.h"

#include <algorithm>

#include "common/core/check.h"

namespace palp::link {
namespace {

/// The bits in the other order: neighbours change places, then pairs, and so on.
constexpr std::uint32_t mirrored(std::uint32_t bits) noexcept {
  bits = (bits >> 1U & 0x55555555U) | (bits & 0x55555555U) << 1U;
  bits = (bits >> 2U & 0x33333333U) | (bits & 0x33333333U) << 2U;
  bits = (bits >> 4U & 0x0F0F0F0FU) | (bits & 0x0F0F0F0FU) << 4U;
  bits = (bits >> 8U & 0x00FF00FFU) | (bits & 0x00FF00FFU) << 8U;
  return bits >> 16U | bits << 16U;
}
static_assert(mirrored(0x80000001U) == 0x80000001U && mirrored(0x00000002U) == 0x40000000U);

}  // namespace

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
  return mirrored(static_cast<std::uint32_t>(below >> 32U));
}

}  // namespace palp::link
