#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "common/core/random.h"
#include "common/core/time.h"
#include "netem/model/nearest.h"
#include "netem/model/prepared_law.h"

namespace palp::netem {

/// The instants at which datagrams may leave: a grid of its own, each step drawn by its number.
/// Thread: its owner's, fit for rt.
class SlotGrid {
 public:
  SlotGrid(RandomStream stream, TimePoint start) noexcept : stream_{stream}, at_{start} {}

  void change(const PreparedLaw& law) noexcept {
    const SlotLaw& slot = law.impairment.slot;
    curve_ = slot.spacing ? &law.slot_curve : nullptr;
    on_ = slot.max > Duration{};
    least_ = static_cast<double>(slot.min.count());
    width_ = static_cast<double>((slot.max - slot.min).count());
    counts_ = slot.packets > 0 || slot.bytes > 0;
    packets_max_ = slot.packets > 0 ? slot.packets : kEndless;
    bytes_max_ = slot.bytes > 0 ? slot.bytes : kEndless;
    ahead_end_ = number_;
    mean_step_ = std::max(nearest(least_ + width_ / 2), Duration{1});
  }
  [[nodiscard]] bool on() const noexcept { return on_; }

  /// The slot that has room for a frame of `length` bytes that could leave at `release`; never one
  /// before the last one's.
  [[nodiscard]] TimePoint fit(TimePoint release, std::uint64_t length) noexcept {
    const auto full = [&] {
      return counts_ && (packets_ >= packets_max_ || (bytes_ > 0 && bytes_ + length > bytes_max_));
    };
    if (release - at_ > kGapMax * mean_step_) skip(release);
    for (int walked = 0; at_ < release || full(); ++walked) {
      step(walked < kStepsPerGapMax ? at_ : std::max(at_, release));
    }
    if (counts_) {
      ++packets_;
      bytes_ += length;
    }
    return at_;
  }

 private:
  static constexpr auto kEndless = std::numeric_limits<std::uint64_t>::max();
  /// A gap of so many slots is not walked through: most of it is passed in whole mean steps, so
  /// that an even grid stays itself and an uneven one is met at any place, as after a walk.
  static constexpr std::int64_t kGapMax = 256;
  static constexpr std::int64_t kWalked = 64;
  static constexpr int kStepsPerGapMax = 2 * kGapMax;  ///< then the grid is entered afresh

  void skip(TimePoint release) noexcept {
    at_ += ((release - at_) / mean_step_ - kWalked) * mean_step_;
    packets_ = 0;
    bytes_ = 0;
  }

  void step(TimePoint from) noexcept {
    if (number_ == ahead_end_) look_ahead();
    at_ = from + ahead_[number_++ % kAhead];
    packets_ = 0;
    bytes_ = 0;
  }

  /// One after the other each step would wait for its draw; many at once wait together.
  void look_ahead() noexcept {
    for (; ahead_end_ < number_ + kAhead; ++ahead_end_) {
      const double draw = random_middle(stream_.bits(ahead_end_));
      double span = least_ + draw * width_;
      if (curve_ != nullptr) span += curve_->jitter() * curve_->at_share(draw);
      ahead_[ahead_end_ % kAhead] = nearest(std::max(span, 1.0));
    }
  }

  RandomStream stream_;
  const DelayCurve* curve_{};  ///< of the steps, on top of the least; null: even
  bool on_{};
  bool counts_{};   ///< a slot has not room for all
  double least_{};  ///< [ns], from one slot to the next
  double width_{};  ///< [ns], from the least to the most of it
  Duration mean_step_{1};
  std::uint64_t packets_max_{};
  std::uint64_t bytes_max_{};  ///< [bytes]
  std::uint64_t number_{};     ///< of the next step
  static constexpr std::size_t kAhead = 32;
  std::array<Duration, kAhead> ahead_{};  ///< the next steps, a ring ...
  std::uint64_t ahead_end_{};             ///< ... below this number
  TimePoint at_;
  std::uint64_t packets_{};
  std::uint64_t bytes_{};  ///< [bytes]
};

}  // namespace palp::netem
