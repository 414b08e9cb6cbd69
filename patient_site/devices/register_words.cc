#include "patient_site/devices/register_words.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace palp::patient {
namespace {

template <class Whole>
Whole within_whole(double counts) noexcept {
  constexpr double kLeast = static_cast<double>(std::numeric_limits<Whole>::min());
  constexpr double kMost = static_cast<double>(std::numeric_limits<Whole>::max());
  return std::isnan(counts) ? Whole{0}
                            : static_cast<Whole>(std::clamp(std::round(counts), kLeast, kMost));
}

std::array<std::uint16_t, 2> halves(std::uint32_t bits, WordOrder order) noexcept {
  const auto high = static_cast<std::uint16_t>(bits >> 16);
  const auto low = static_cast<std::uint16_t>(bits & 0xffffU);
  if (order == WordOrder::HighFirst) return {high, low};
  return {low, high};
}

}  // namespace

std::array<std::uint16_t, 2> to_words(double counts, WordKind kind, WordOrder order) noexcept {
  switch (kind) {
    case WordKind::U16:
      return {within_whole<std::uint16_t>(counts), 0};
    case WordKind::I16:
      return {std::bit_cast<std::uint16_t>(within_whole<std::int16_t>(counts)), 0};
    case WordKind::U32:
      return halves(within_whole<std::uint32_t>(counts), order);
    case WordKind::I32:
      return halves(std::bit_cast<std::uint32_t>(within_whole<std::int32_t>(counts)), order);
    case WordKind::F32:
      return halves(std::bit_cast<std::uint32_t>(static_cast<float>(counts)), order);
  }
  return {};
}

double from_words(std::span<const std::uint16_t> words, WordKind kind, WordOrder order) noexcept {
  if (kind == WordKind::U16) return words[0];
  if (kind == WordKind::I16) return std::bit_cast<std::int16_t>(words[0]);
  const bool high_first = order == WordOrder::HighFirst;
  const std::uint32_t high = words[high_first ? 0 : 1];
  const std::uint32_t low = words[high_first ? 1 : 0];
  const std::uint32_t bits = (high << 16U) | low;
  if (kind == WordKind::U32) return bits;
  if (kind == WordKind::I32) return std::bit_cast<std::int32_t>(bits);
  return static_cast<double>(std::bit_cast<float>(bits));
}

}  // namespace palp::patient
