#include "lab/run/scenario.h"

#include <algorithm>

namespace palp::lab {

HandFacts hand_facts_of(const Scenario& scenario) noexcept {
  HandFacts facts = surgeon::facts_of(scenario.hand);
  const DeviceTiming& timing = scenario.timings.hand;
  if (timing.at_once()) return facts;
  facts.rate = timing.rate;
  facts.lag = seconds(timing.lag);
  return facts;
}

PatientDevices patient_devices_of(const Scenario& scenario) noexcept {
  PatientDevices facts = patient::facts_of(scenario.tissue);
  const DeviceTiming& stage = scenario.timings.stage;
  if (!stage.at_once()) {
    facts.stage.rate = stage.rate;
    // A target waits for its turn for half a period, and stands for one.
    facts.stage.lag += seconds(stage.lag) + 0.5 / stage.rate;
  }
  const DeviceTiming& sensor = scenario.timings.sensor;
  if (!sensor.at_once()) {
    facts.sensor.rate = sensor.rate;
    facts.sensor.lag += seconds(sensor.lag);
  }
  return facts;
}

}  // namespace palp::lab
