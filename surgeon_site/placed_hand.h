#pragma once

#include "common/core/mailbox.h"
#include "surgeon_site/haptic_device.h"

namespace palp::surgeon {

/// Where somebody else than the hand wants the stage along the surface.
struct WantedPlace {
  Place place{};
  bool wanted{};  ///< else the hand's own place counts
};

/// A hand whose place along the surface is chosen by a study: the person presses, the study
/// travels. All else is the hand's own. The session file has the place as the hand's, so that its
/// ticks are done again from it. Thread: rt.
class PlacedHand final : public HapticDevice {
 public:
  /// `hand` outlives it.
  explicit PlacedHand(HapticDevice& hand) noexcept : hand_{hand} {}

  /// Writer: main. Reader: rt.
  [[nodiscard]] Mailbox<WantedPlace>& places() noexcept { return places_; }

  [[nodiscard]] HandFacts hand_facts() const noexcept override { return hand_.hand_facts(); }
  HandState read(TimePoint now) noexcept override {
    HandState state = hand_.read(now);
    if (const WantedPlace& there = places_.get(); there.wanted) state.place = there.place;
    return state;
  }
  void apply(double force) noexcept override { hand_.apply(force); }
  void show(const OperatorView& view) noexcept override { hand_.show(view); }
  void hold_in_plane(bool held) noexcept override { hand_.hold_in_plane(held); }
  [[nodiscard]] ScriptProgress progress() const noexcept override { return hand_.progress(); }

 private:
  HapticDevice& hand_;
  Mailbox<WantedPlace> places_;
};

}  // namespace palp::surgeon
