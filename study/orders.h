#pragma once

#include <array>
#include <cstddef>
#include <string>

/// Orders of three intervals, from the softest to the stiffest: answers of the task `rank`. Pure.
namespace palp::study {

inline constexpr std::size_t kRanked = 3;  ///< intervals that are put in order
using Order = std::array<std::size_t, kRanked>;

/// Answers, by their numbers from 0.
inline constexpr std::array kOrders{
    Order{0, 1, 2}, Order{0, 2, 1}, Order{1, 0, 2}, Order{1, 2, 0}, Order{2, 0, 1}, Order{2, 1, 0}};

/// Where an interval stands in an order, from 0: the softest.
[[nodiscard]] constexpr std::size_t rank_in(std::size_t order, std::size_t interval) noexcept {
  std::size_t rank = 0;
  while (kOrders[order][rank] != interval) ++rank;
  return rank;
}

/// The number of the order in which values rise; of equal ones that of the lesser index first.
[[nodiscard]] constexpr std::size_t order_of(const std::array<double, kRanked>& values) noexcept {
  for (std::size_t order = 0; order < kOrders.size(); ++order) {
    const Order& one = kOrders[order];
    if (values[one[0]] <= values[one[1]] && values[one[1]] <= values[one[2]]) return order;
  }
  return 0;
}

/// Kendall's tau of two orders [-]: 1 the same, -1 the reverse, in steps of 2/3.
[[nodiscard]] constexpr double kendall_tau(std::size_t one, std::size_t other) noexcept {
  int agreeing = 0;
  for (std::size_t i = 0; i < kRanked; ++i) {
    for (std::size_t j = i + 1; j < kRanked; ++j) {
      const bool first = rank_in(one, i) < rank_in(one, j);
      agreeing += first == (rank_in(other, i) < rank_in(other, j)) ? 1 : -1;
    }
  }
  return agreeing / 3.0;
}

/// As a participant reads it: "2 1 3".
[[nodiscard]] inline std::string order_name(std::size_t order) {
  std::string text;
  for (const std::size_t interval : kOrders[order]) {
    text += (text.empty() ? "" : " ") + std::to_string(interval + 1);
  }
  return text;
}

}  // namespace palp::study
