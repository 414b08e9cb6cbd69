#pragma once

#include "common/core/time.h"
#include "surgeon_site/haptic_device.h"

namespace palp::surgeon {

/// A session as an operator sees it: engages on the pedal's edge at once, or refuses.
class FakeSession {
 public:
  explicit FakeSession(double tip_position) : tip{tip_position} {}  ///< [m]

  void step(bool pedal) {
    const bool edge = pedal && !pedal_;
    pedal_ = pedal;
    if (edge) ++presses;
    if (state == SiteState::Clutched && edge && willing) state = SiteState::Engaged;
    if (state == SiteState::Engaged && !pedal) state = SiteState::Clutched;
  }
  [[nodiscard]] OperatorView view() const { return {state, peer_state, link, tip, tip_known}; }

  SiteState state{SiteState::Clutched};
  SiteState peer_state{SiteState::Clutched};
  LinkState link{LinkState::Live};
  double tip;  ///< [m]
  bool tip_known{true};
  bool willing{true};
  int presses{};

 private:
  bool pedal_{};
};

}  // namespace palp::surgeon
