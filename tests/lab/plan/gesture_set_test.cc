#include "lab/plan/gesture_set.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "judge/metric_table.h"
#include "lab/report/run_report.h"
#include "lab/run/run.h"

namespace palp::lab {
namespace {

TEST(GestureSetTest, EveryScriptIsPerformedByEachGripAtEachRoundTripAndJudged) {
  const Plan plan = make_set("gestures", {}).value();
  std::set<std::string_view> scripts;
  for (const Gesture& gesture : kGestures) {
    scripts.insert(gesture.script);
    EXPECT_TRUE(judge::metric_index(gesture.metric)) << gesture.name;
  }
  EXPECT_EQ(plan.cases.size(), scripts.size() * 5 * 4);
  EXPECT_TRUE(plan.direct_touch);
  for (const Case& one : plan.cases) {
    EXPECT_EQ(one.labels.size(), plan.label_names.size());
    const auto scenario = make_case(plan, one);
    ASSERT_TRUE(scenario) << scenario.error().text;
    EXPECT_EQ(scenario->script.phases().front().name, "hold");
  }
}

TEST(GestureSetTest, ACaseHasTheScriptOfItsGesture) {
  const Plan plan = make_set("gestures", {}).value();
  const auto drags = [](const Scenario& scenario) {
    for (const surgeon::Stretch& stretch : scenario.script.stretches()) {
      if (stretch.kind == surgeon::StretchKind::Drag) return true;
    }
    return false;
  };
  EXPECT_FALSE(drags(*make_case(plan, plan.cases.front())));
  EXPECT_TRUE(drags(*make_case(plan, plan.cases.back())));
  EXPECT_TRUE(make_case(plan, plan.cases.back())->finger.bump > 0.1) << "an inclusion is met";
}

/// Over an inclusion 5 mm deep, at 20 mm/s, a round trip of 200 ms away. The tip may press harder
/// than the hand is given, by 0.02 N and 3 %: of what a light hand feels that is more than 5 %.
TEST(GestureSetTest, WithMmtADragFeelsTheBumpThatAFingerTouches) {
  const Plan plan = make_set("gestures", {.seed = 2}).value();
  std::size_t drags = 0;
  for (const Case& one : plan.cases) {
    if (one.script != kDragOver || one.labels[0] != "200") continue;
    SCOPED_TRACE(one.labels[1]);
    ++drags;
    const bool light = std::ranges::find(one.labels, "light") != one.labels.end();
    const RunResult result = simulate(*make_case(plan, one));
    EXPECT_FALSE(result.metrics.unstable) << result.metrics.unstable_reason;
    const judge::ContactMetrics& felt = result.metrics.contact;
    EXPECT_NEAR(felt.drag_felt / felt.drag_direct, 1, 0.05) << "of the same hand's finger";
    EXPECT_NEAR(felt.drag_error, 0, light ? 0.09 : 0.05) << "of the tip";
    EXPECT_LE(felt.drag_shift, 0.3) << "a round trip and 0.1 s";
    EXPECT_LE(result.metrics.energy_operator, 1e-3);
    EXPECT_NE(trace_csv(result).find(",drag,"), std::string::npos);
  }
  EXPECT_EQ(drags, 4U) << "one of each grip";
}

TEST(GestureSetTest, AScriptThatIsNoneIsASentence) {
  const Plan plan = make_set("gestures", {}).value();
  Case broken = plan.cases.front();
  broken.script = "wave\n";
  const auto refused = make_case(plan, broken);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text.find("wave"), std::string::npos) << refused.error().text;
}

}  // namespace
}  // namespace palp::lab
