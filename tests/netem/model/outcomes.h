#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "netem/model/impairment_model.h"

/// Outcomes for tests.
namespace palp::netem {

inline constexpr std::size_t kRoom = 1'000'000;

/// The outcomes of one datagram and its copies.
struct PacketOutcome {
  std::size_t count{};
  std::array<CopyOutcome, kCopiesMax> copies{};
};

inline PacketOutcome outcome_of(std::span<const CopyOutcome> copies) {
  PacketOutcome outcome{.count = copies.size()};
  std::copy(copies.begin(), copies.end(), outcome.copies.begin());
  return outcome;
}

/// The outcomes of `count` datagrams, one each `period`.
inline std::vector<PacketOutcome> outcomes_of(const Impairment& impairment,
                                              std::size_t count,
                                              Duration period = std::chrono::milliseconds{1},
                                              std::uint64_t seed = 1,
                                              Direction direction = Direction::Up) {
  ImpairmentModel sequence{impairment, seed, direction, TimePoint{}};
  std::vector<PacketOutcome> outcomes;
  outcomes.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const TimePoint at{period * static_cast<std::int64_t>(i)};
    outcomes.push_back(outcome_of(sequence.next({.at = at, .length = 200, .room = kRoom})));
  }
  return outcomes;
}

inline bool lost(const PacketOutcome& outcome) {
  return outcome.copies[0].verdict == Verdict::Lost;
}

inline double loss_share(const std::vector<PacketOutcome>& outcomes) {
  const auto count = std::count_if(outcomes.begin(), outcomes.end(), lost);
  return static_cast<double>(count) / static_cast<double>(outcomes.size());
}

}  // namespace palp::netem
