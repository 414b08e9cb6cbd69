#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "netem/fate.h"

/// Fates for tests.
namespace palp::netem {

inline constexpr std::size_t kRoom = 1'000'000;

/// The fates of one datagram and its copies.
struct Fate {
  std::size_t count{};
  std::array<CopyFate, kCopiesMax> copies{};
};

inline Fate fate_of(std::span<const CopyFate> copies) {
  Fate fate{.count = copies.size()};
  std::copy(copies.begin(), copies.end(), fate.copies.begin());
  return fate;
}

/// The fates of `count` datagrams, one each `period`.
inline std::vector<Fate> fates_of(const Impairment& impairment,
                                  std::size_t count,
                                  Duration period = std::chrono::milliseconds{1},
                                  std::uint64_t seed = 1,
                                  Direction direction = Direction::Up) {
  FateSequence sequence{impairment, seed, direction, TimePoint{}};
  std::vector<Fate> fates;
  fates.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const TimePoint at{period * static_cast<std::int64_t>(i)};
    fates.push_back(fate_of(sequence.next({.at = at, .length = 200, .room = kRoom})));
  }
  return fates;
}

inline bool lost(const Fate& fate) { return fate.copies[0].verdict == Verdict::Lost; }

inline double loss_share(const std::vector<Fate>& fates) {
  const auto count = std::count_if(fates.begin(), fates.end(), lost);
  return static_cast<double>(count) / static_cast<double>(fates.size());
}

}  // namespace palp::netem
