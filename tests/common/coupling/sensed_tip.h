#pragma once

#include "common/core/filters.h"
#include "common/core/place.h"
#include "common/coupling/contact_estimator.h"
#include "common/coupling/contact_model.h"

namespace palp::coupling {

/// A contact estimator at a tip whose force it sees through the transducer's pole, without steps,
/// and a hand that is at the tip.
class SensedTip {
 public:
  /// A tick of 1 ms: the tip at `position` [m] meets `force` [N]. @returns what a hand there is
  /// told [N].
  double meets(double position, double force) {
    estimator_.step(position, pole_.step(force));
    const ModelPayload& told = estimator_.model();
    const double depth = position - told.surface - told.swing;
    given_.age_into(contact_model(told), told.relaxing, depth, config().period);
    return given_.force(depth);
  }
  void new_place(const Place& place) { estimator_.new_place(place); }
  [[nodiscard]] const ModelPayload& told() const { return estimator_.model(); }

 private:
  static ContactEstimatorConfig config() {
    ContactEstimatorConfig config;
    config.sensor.step = 0;
    return config;
  }

  ContactEstimator estimator_{config()};
  LowPass pole_{config().sensor.pole, config().period};  ///< [N]
  RelaxingContact given_;
};

}  // namespace palp::coupling
