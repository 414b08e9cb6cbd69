#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "common/core/device_facts.h"
#include "common/core/filters.h"

namespace palp::patient {

struct ForceForesightConfig {
  double margin{0.15};        ///< [N], below a limit the tip comes to rest, at half of a small one
  double beyond{0.4};         ///< [N], above it: as far as a kink may take the force
  double steeper{2.5};        ///< [-], than the tissue that was felt last a kink may be
  double stiffness_min{600};  ///< [N/m], of what is touched, whatever the first readings say
  double window{12e-3};       ///< [s], of readings that say how steep the tissue is
  double span{0.1e-3};        ///< [m], no less of the tip's way says it
  double braking{9.5e-3};     ///< [s], of the stage's lag: what brakes spare
  double share_min{1.0 / 3};  ///< [-], of its lead, that the tip goes on when its target stands
};

/// A force is late: behind the sensor's pole and pace, and the tip behind its target. Knows from
/// the readings of the last way how steep the tissue is, and so how deep the tip may be sent that
/// its force will be within the limit when it stands there. Needs no surface, no model and no
/// network. Thread: rt. A value.
class ForceForesight {
 public:
  explicit ForceForesight(const PatientDevices& devices = {},
                          double period = 1e-3,  ///< [s], of the calls of feel()
                          const ForceForesightConfig& config = {}) noexcept;

  /// The tip stands here.
  void begin(double tip) noexcept;
  /// Once a tick. `age` [s] of the force where it is a new reading, else nullopt.
  void feel(double tip, double force, std::optional<double> age) noexcept;
  /// The deepest target [m] that brakes in time for a `limit` > 0 [N] of the force.
  [[nodiscard]] double bound(double tip, double limit) const noexcept;
  /// Once it was braked: how much deeper the target may go per tick [m]. What is missing of the
  /// `limit` > 0 [N] is to come no sooner than it can be known: on a slow stage the tip would run
  /// into its limit again and again.
  [[nodiscard]] double step_most(double limit) const noexcept;
  /// Of the tissue that was felt last [N/m], >= 0.
  [[nodiscard]] double stiffness() const noexcept { return stiffness_; }
  /// [m], of the tip behind the sensor's pole.
  [[nodiscard]] double felt_tip() const noexcept { return tip_filter_.value(); }

 private:
  struct Reading {
    double tip{};    ///< [m], behind the same pole as the force
    double force{};  ///< [N]
    double at{};     ///< [s]
  };
  [[nodiscard]] double rest(double limit) const noexcept;
  void learn() noexcept;
  void fit(std::size_t used, bool moved) noexcept;
  [[nodiscard]] const Reading& reading(std::size_t back) const noexcept {
    return readings_[(count_ - 1 - back) % readings_.size()];
  }

  ForceForesightConfig config_;
  double period_;   ///< [s]
  double hidden_;   ///< [s], of a reading behind its stamp, without the pole
  double late_;     ///< [s], from a target to the force that says what it did
  double share_;    ///< [-], of its lead, that the tip goes on
  double touched_;  ///< [N], felt as contact
  double doubt_;    ///< [N], by which one reading may be wrong
  LowPass tip_filter_;
  std::array<double, 128> tips_{};  ///< [m], of the last ticks, behind the pole
  std::size_t ticks_{};
  std::array<Reading, 16> readings_{};
  std::size_t count_{};
  double stiffness_{};  ///< [N/m]
  double force_{};      ///< [N], at the newest reading, by all of the window
};

}  // namespace palp::patient
