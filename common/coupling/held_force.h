#pragma once

#include "common/coupling/contact_model.h"
#include "common/message/port_sample.h"

namespace palp::coupling {

/// What a model leaves at a tip that rests: a tissue relaxes, comes up or is of no known shape, and
/// the fit, which remembers seconds, learns it late. Where the tip stands the measured force is
/// known, so all of the model is told stronger or weaker, until a hand there is given that force.
/// As the tip goes on, that is forgotten. Thread: rt. A value.
class HeldForce {
 public:
  explicit HeldForce(double period) noexcept : period_{period} {}  ///< [s], of step()

  /// Once a tick: the tip at `position` [m], half of its way in this tick on average, meets `force`
  /// [N], both through the same filter. The force may be off by `doubt` [N].
  void step(const ModelPayload& model, double position, double force, double doubt = 0) noexcept;
  /// From here on `model` is told, corrected.
  void tell(const ModelPayload& model) noexcept { told_ = corrected(model); }
  [[nodiscard]] const ModelPayload& told() const noexcept { return told_; }
  /// [N], of a tip there, as it is told.
  [[nodiscard]] double force() const noexcept { return force_; }
  [[nodiscard]] double speed() const noexcept { return speed_; }  ///< [m/s], of the tip, lately
  /// Another place.
  void forget() noexcept { share_ = 0; }

 private:
  [[nodiscard]] ModelPayload corrected(ModelPayload model) const noexcept;

  double period_;          ///< [s]
  double position_{};      ///< [m], at the tick before
  double speed_{};         ///< [m/s], of the tip, lately
  RelaxingContact given_;  ///< what a hand at the tip would be given
  double force_{};         ///< [N], of it
  double share_{};         ///< [-], that the model is told stronger
  ModelPayload told_;
};

}  // namespace palp::coupling
