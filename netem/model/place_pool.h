#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "netem/model/decision.h"

namespace palp::netem {

/// Places for the decisions on datagrams that are on their way, or due and not collected. A place
/// that was left is taken first, so that few places stay warm.
/// Thread: its owner's, fit for rt: all memory is taken by the constructor.
class PlacePool {
 public:
  explicit PlacePool(std::size_t capacity) : capacity_{capacity} {
    held_.reserve(capacity);
    free_.reserve(capacity);
  }
  [[nodiscard]] std::size_t capacity() const noexcept { return capacity_; }

  /// Gives it a place and keeps it there. @returns false: all are taken, nothing happens.
  [[nodiscard]] bool enter(Decision& decision) noexcept {
    if (!free_.empty()) {
      decision.place = free_.back();
      free_.pop_back();
      held_[decision.place] = decision;
      return true;
    }
    if (held_.size() == capacity_) return false;
    decision.place = static_cast<std::uint32_t>(held_.size());
    held_.push_back(decision);
    return true;
  }
  /// @pre `place` is taken.
  [[nodiscard]] Decision& operator[](std::uint32_t place) noexcept { return held_[place]; }
  /// What is there stays until another enters.
  void leave(std::uint32_t place) noexcept { free_.push_back(place); }

 private:
  std::size_t capacity_;
  std::vector<Decision> held_;  ///< by place; grows as they are used
  std::vector<std::uint32_t> free_;
};

}  // namespace palp::netem
