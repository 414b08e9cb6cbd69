#include "lab/run/direct_touch.h"

#include <algorithm>
#include <memory>

#include "judge/drag_bump.h"
#include "judge/swing_finder.h"
#include "patient_site/phantom.h"
#include "review/phase_finder.h"
#include "surgeon_site/hand_plant.h"

namespace palp::lab {

std::vector<TouchTick> direct_touch(const Scenario& scenario) {
  constexpr Duration kStep = std::chrono::milliseconds{1};
  const patient::SimulatedPhantomConfig& tissue = scenario.tissue;
  const auto field = patient::make_field(scenario.phantom, tissue.viscous_factor);
  patient::RelaxingForce relaxing{scenario.phantom.relaxation};
  const surgeon::GestureScript& script = scenario.script;
  surgeon::HandPlant hand{scenario.hand.plant, script.at({}).position};
  double force = 0;
  std::vector<TouchTick> ticks;
  patient::Breath breath = patient::breath_of(tissue);
  double depth = -1;  // [m]
  for (Duration at{}; at < script.length(); at += kStep) {
    const surgeon::Intent begin = script.at(at);
    const surgeon::Intent end = script.at(at + kStep);
    hand.advance({begin.position, begin.velocity}, {end.position, end.velocity}, force, kStep);
    const double surface = field->surface(end.place) + breath.at(seconds(at + kStep)).position;
    const double before = depth;
    depth = hand.position() - surface;
    const double rate = (depth - before) / seconds(kStep);
    const double elastic = relaxing.step(field->elastic_force(end.place, depth), seconds(kStep));
    force = std::max(0.0, elastic * field->growth(before > 0 ? rate : 0));
    ticks.push_back({at + kStep, depth, force, end.place});
  }
  return ticks;
}

OwnFinger own_finger(const Scenario& scenario) {
  OwnFinger finger{.force = 0};
  // A little slower than what is looked for: what the finger does, hand and tip may do quicker.
  judge::SwingFinder swing{0.7 * judge::SwingFinder::kSlowest};
  judge::DragBump drag;
  review::PhaseFinder phases{scenario.script};
  for (const TouchTick& tick : direct_touch(scenario)) {
    finger.force = std::max(finger.force, tick.force);
    const judge::PhaseKind kind = phases.at(tick.at, tick.place).kind;
    if (kind == judge::PhaseKind::FreeAir) swing.restart();
    drag.look(seconds(tick.at), kind == judge::PhaseKind::Drag, tick.force, tick.force);
    swing.look({seconds(tick.at), tick.position});
  }
  finger.swing = swing.largest();
  finger.bump = drag.felt();
  return finger;
}

}  // namespace palp::lab
