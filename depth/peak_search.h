#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

/// The maximum of a smooth function of one number that costs something to evaluate.
namespace palp::depth {

inline constexpr std::size_t kPeakScan = 12;  // places looked at first
inline constexpr int kPeakSteps = 24;
inline constexpr int kPeakHalvings = 13;    // towards an end, to a ten-thousandth of a scan's step
inline constexpr double kPeakExact = 0.01;  // [-], of a log-likelihood

/// Maximum of `value` between the first and the last of three places, the middle one above both:
/// parabolas, golden sections where they lead nowhere.
struct Peak {
  double at{};     ///< [as the argument]
  double value{};  ///< [as the function]
};
template <typename Value>
[[nodiscard]] Peak climb(std::array<Peak, 3> bracket, const Value& value) {
  for (int i = 0; i < kPeakSteps; ++i) {
    auto& [left, middle, right] = bracket;
    const double a = middle.at - left.at;
    const double b = right.at - middle.at;
    const double rise = (middle.value - left.value) / a;
    const double fall = (middle.value - right.value) / b;
    const double curvature = (rise + fall) / (a + b);  // half of it, negative
    // Vertex of the parabola.
    double step = curvature > 0 ? 0.5 * (rise * b - fall * a) / (rise + fall) : 0;
    const double gain = curvature * step * step;
    const bool exact =
        gain < kPeakExact && std::max(left.value, right.value) > middle.value - 1 / kPeakExact;
    if (exact) return {middle.at, middle.value};
    const bool slow = std::abs(step) < 0.02 * std::min(a, b);
    if (slow) step = 0.3 * (a > b ? -a : b);
    if (!(step > -a && step < b)) step = 0.4 * (a > b ? -a : b);
    const Peak next{middle.at + step, value(middle.at + step)};
    if (next.value > middle.value) {
      (step > 0 ? left : right) = middle;
      middle = next;
    } else {
      (step > 0 ? right : left) = next;
    }
  }
  return bracket[1];
}

/// The place where `value` is largest between `low` and `high`: sought from evenly spread places,
/// or round a guess.
template <typename Value>
[[nodiscard]] Peak scan(double low, double high, const Value& value) {
  const double step = (high - low) / static_cast<double>(kPeakScan - 1);
  std::array<Peak, kPeakScan> places;
  for (std::size_t i = 0; i < kPeakScan; ++i) {
    const double at = low + step * static_cast<double>(i);
    places[i] = {at, value(at)};
  }
  const auto top = std::max_element(
      places.begin(), places.end(), [](const Peak& a, const Peak& b) { return a.value < b.value; });
  if (top != places.begin() && top + 1 != places.end()) {
    return climb({*(top - 1), *top, *(top + 1)}, value);
  }
  // The peak may lie just inside the end.
  const double inward = top == places.begin() ? step : -step;
  double part = 1;
  for (int i = 0; i < kPeakHalvings; ++i) {
    part *= 0.5;
    const Peak inside{top->at + part * inward, value(top->at + part * inward)};
    if (inside.value <= top->value) continue;
    const Peak beyond{top->at + 2 * part * inward, value(top->at + 2 * part * inward)};
    return inward > 0 ? climb({*top, inside, beyond}, value) : climb({beyond, inside, *top}, value);
  }
  return *top;
}

/// Where a peak is sought.
struct PeakRange {
  double low{};   ///< [as the argument]
  double high{};  ///< [as the argument]
};
struct PeakGuess {
  double at{};      ///< [as the argument], within the range
  double width{};   ///< [as the argument], of the peak
  int doublings{};  ///< of the width, on the way to the peak
};

/// The same, near a guess; nothing if it is not. `value` is asked within the range, no farther from
/// the guess than 2^(doublings + 1) - 1 widths.
template <typename Value>
[[nodiscard]] std::optional<Peak> search(const PeakRange& range,
                                         const PeakGuess& guess,
                                         const Value& value) {
  // Beyond the range all looks as at its end.
  const auto held = [&](double at) { return value(std::clamp(at, range.low, range.high)); };
  double width = guess.width;
  std::array<Peak, 3> places{{{guess.at - width, held(guess.at - width)},
                              {guess.at, held(guess.at)},
                              {guess.at + width, held(guess.at + width)}}};
  for (int i = 0;; ++i) {
    auto& [left, middle, right] = places;
    if (middle.value >= left.value && middle.value >= right.value) break;
    if (i == guess.doublings) return std::nullopt;
    width *= 2;
    if (right.value > left.value) {
      const double at = right.at + width;
      places = {middle, right, {at, held(at)}};
    } else {
      const double at = left.at - width;
      places = {Peak{at, held(at)}, left, middle};
    }
  }
  const Peak peak = climb(places, held);
  const double near = 0.05 * guess.width;
  if (peak.at > range.low + near && peak.at < range.high - near) return peak;
  // The peak is an end of the range, or lies just inside.
  const bool first = !(peak.at > range.low + near);
  const double end = first ? range.low : range.high;
  const Peak last{end, value(end)};
  double step = 0.25 * std::min(guess.width, range.high - range.low);
  if (!first) step = -step;
  Peak inside{end + step, value(end + step)};
  if (inside.value <= last.value) return last;
  Peak beyond{end + 2 * step, value(end + 2 * step)};
  if (beyond.value > inside.value) {
    inside = beyond;
    beyond = {end + 4 * step, value(end + 4 * step)};
  }
  if (beyond.value > inside.value) return std::nullopt;
  return first ? climb({last, inside, beyond}, value) : climb({beyond, inside, last}, value);
}

}  // namespace palp::depth
