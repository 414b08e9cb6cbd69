#pragma once

#include "common/message/port_sample.h"

namespace palp::coupling {

/// A surface that moves while no breath, or another one, is known: by its force, a slow tip in a
/// known tissue says where the surface is and how fast it goes. That is told as a swing, which goes
/// on at a hand that hears of it late. As the tip goes on, it is forgotten. Thread: rt. A value.
class SurfaceDrift {
 public:
  explicit SurfaceDrift(double period) noexcept : period_{period} {}  ///< [s], of step()

  /// In a tick, what a tip met.
  struct Met {
    double position{};  ///< [m], of the tip
    double speed{};     ///< [m/s] >= 0, of the tip, lately
    double force{};     ///< [N], measured
    double given{};     ///< [N], to a hand there, by the model as it is told
    bool touches{};     ///< it is felt: one reading may be noise
  };
  /// Once a tick, with `model` as moved() told it last.
  void step(const ModelPayload& model, const Met& met) noexcept;
  /// The surface is known to stand still: once a tick, what is left of the drift fades.
  void fade() noexcept;
  /// Another place.
  void forget() noexcept { drift_ = speed_ = 0; }

  [[nodiscard]] ModelPayload moved(ModelPayload model) const noexcept;

 private:
  void coast() noexcept;

  double period_;      ///< [s]
  double position_{};  ///< [m], of the tip, at the tick before
  double drift_{};     ///< [m]
  double speed_{};     ///< [m/s], of the surface
};

}  // namespace palp::coupling
