#include "lab/plan/gesture_set.h"

#include <string>

#include "lab/plan/set_case.h"

namespace palp::lab {

void fill_gestures(Plan& plan, const PlanAsk& ask) {
  plan.direct_touch = true;
  plan.label_names.emplace_back("gesture");
  for (std::size_t i = 0; i < kGestures.size(); ++i) {
    const Gesture& gesture = kGestures[i];
    if (i > 0 && gesture.script == kGestures[i - 1].script) continue;
    for (const double ms : {0, 20, 100, 200, 500}) {
      for (const std::string_view grip : kSetGrips) {
        add_case(plan, ask.seed, {.round_trip = ms * 1e-3, .grip = grip}, ask);
        plan.cases.back().script = gesture.script;
        plan.cases.back().labels.emplace_back(gesture.name);
      }
    }
  }
}

}  // namespace palp::lab
