#pragma once

#include <algorithm>
#include <cstdint>

#include "common/core/mailbox.h"
#include "surgeon_site/haptic_device.h"

namespace palp::surgeon {

/// Where somebody else than the hand wants the stage along the surface.
struct WantedPlace {
  Place place{};
  double reach{};          ///< [m], to all sides, by which the hand may leave it; 0: it stays there
  std::uint64_t number{};  ///< of the wish, from 1; 0: the hand's own place counts
};

/// A hand whose place along the surface is chosen by a study: the person presses, the study
/// travels. Where the study lets it, the hand moves on from there as it moves from where it was
/// when the wish came. All else is the hand's own. The session file has the place as the hand's, so
/// that its ticks are done again from it. Thread: rt.
class PlacedHand final : public HapticDevice {
 public:
  /// `hand` outlives it.
  explicit PlacedHand(HapticDevice& hand) noexcept : hand_{hand} {}

  /// Writer: main. Reader: rt.
  [[nodiscard]] Mailbox<WantedPlace>& places() noexcept { return places_; }

  [[nodiscard]] HandFacts hand_facts() const noexcept override { return hand_.hand_facts(); }
  HandState read(TimePoint now) noexcept override {
    HandState state = hand_.read(now);
    const WantedPlace& there = places_.get();
    if (there.number == 0) return state;
    if (there.number != number_) {
      number_ = there.number;
      origin_ = state.place;
    }
    const auto moved = [&](double from, double to) {
      return std::clamp(to - from, -there.reach, there.reach);
    };
    state.place = {there.place.x + moved(origin_.x, state.place.x),
                   there.place.y + moved(origin_.y, state.place.y)};
    return state;
  }
  void apply(double force) noexcept override { hand_.apply(force); }
  void show(const OperatorView& view) noexcept override { hand_.show(view); }
  void hold_in_plane(bool held) noexcept override { hand_.hold_in_plane(held); }
  [[nodiscard]] ScriptProgress progress() const noexcept override { return hand_.progress(); }

 private:
  HapticDevice& hand_;
  Mailbox<WantedPlace> places_;
  std::uint64_t number_{};  ///< of the wish that holds
  Place origin_{};          ///< of the hand as it came
};

}  // namespace palp::surgeon
