#pragma once

#include <algorithm>
#include <optional>

namespace palp::patient {

struct ForceCeilingConfig {
  double limit{3};      ///< [N], above it the tip retreats
  double margin{0.3};   ///< [N], below the limit: where a tip that is held comes to rest; at most
                        ///< half of the limit counts
  double creep{10e-3};  ///< [m/s], deeper at most, where there is no force at all
};

/// The memory of a retreat: the tip goes back no deeper than where the retreat ended, and from
/// there only as far as the force allows. A gate without it retreats, follows again and hammers at
/// its limit. Kept as long as the tip is in the tissue at that place. Thread: rt. A value.
class ForceCeiling {
 public:
  explicit ForceCeiling(const ForceCeilingConfig& config = {}) noexcept : config_{config} {}

  /// The retreat has come this far [m].
  void hit(double position) noexcept { deepest_ = position; }
  void forget() noexcept { deepest_.reset(); }

  /// Once a tick: how deep the tip may go, of what is asked for [m]. `force`: felt [N]; `dt` [s].
  [[nodiscard]] double bound(double asked, double force, double dt) noexcept {
    if (!deepest_ || asked <= *deepest_) return asked;
    // The closer to rest, the slower: sensor and stage lag behind what is commanded.
    const double rest = config_.limit - std::min(config_.margin, config_.limit / 2);
    const double room = std::clamp(1 - force / rest, 0.0, 1.0);
    *deepest_ = std::min(asked, *deepest_ + config_.creep * room * dt);
    return *deepest_;
  }

 private:
  ForceCeilingConfig config_;
  std::optional<double> deepest_;  ///< [m]
};

}  // namespace palp::patient
