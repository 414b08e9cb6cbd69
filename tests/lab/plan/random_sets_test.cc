#include "lab/plan/random_sets.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "lab/plan/set_case.h"

namespace palp::lab {
namespace {

using Fill = void (*)(Plan&, const PlanAsk&);

Plan filled(Fill fill, std::uint64_t count, std::uint64_t seed = 4) {
  Plan plan;
  fill(plan, {.count = count, .seed = seed});
  return plan;
}

bool equal(const Case& a, const Case& b) {
  if (a.seed != b.seed || a.labels != b.labels || a.settings.size() != b.settings.size()) {
    return false;
  }
  for (std::size_t i = 0; i < a.settings.size(); ++i) {
    if (a.settings[i].path != b.settings[i].path) return false;
    if (a.settings[i].value != b.settings[i].value) return false;
  }
  return true;
}

TEST(RandomSetsTest, ACaseIsThatOfItsSeedAndIndexWhateverTheCount) {
  for (const Fill fill :
       {fill_faults, fill_device_faults, fill_pauses, fill_devices, fill_wild, fill_first}) {
    const Plan few = filled(fill, 5);
    const Plan many = filled(fill, 30);
    const Plan others = filled(fill, 5, 5);
    ASSERT_EQ(few.cases.size(), 5U);
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_TRUE(equal(few.cases[i], many.cases[i]));
      EXPECT_FALSE(equal(few.cases[i], others.cases[i]));
    }
  }
}

TEST(RandomSetsTest, EveryWildCaseCanBeMadeAndHasAFingerToBeHeldAgainst) {
  Plan plan = filled(fill_wild, 20);
  EXPECT_TRUE(plan.direct_touch);
  for (const Case& one : plan.cases) {
    const auto scenario = make_case(plan, one);
    ASSERT_TRUE(scenario) << scenario.error().text;
    EXPECT_GT(scenario->finger.force, 0);
  }
}

TEST(RandomSetsTest, AFirstPressIsOfARandomTissueOrOfABallAndIsHeld) {
  Plan plan = filled(fill_first, 100);
  EXPECT_TRUE(plan.direct_touch);
  int balls = 0;
  int over = 0;
  for (const Case& one : plan.cases) {
    ASSERT_EQ(one.labels.size(), set_labels().size() + plan.label_names.size());
    const std::string& drawn = one.labels.back();
    const std::string& site = one.labels[one.labels.size() - 2];
    balls += drawn.starts_with("paper-") ? 1 : 0;
    over += site == "B" ? 1 : 0;
    EXPECT_EQ(site == "B", one.script.find("move to B") != std::string::npos);
    EXPECT_TRUE(drawn.starts_with("paper-") || site == "A");
  }
  EXPECT_GT(balls, 10);
  EXPECT_LT(balls, 30);
  EXPECT_GT(over, 2);
  EXPECT_LT(over, balls);
  for (std::size_t i = 0; i < 20; ++i) {
    const auto scenario = make_case(plan, plan.cases[i]);
    ASSERT_TRUE(scenario) << scenario.error().text;
    EXPECT_LE(seconds(scenario->up.delay.mean + scenario->down.delay.mean), 0.5);
    EXPECT_TRUE(std::ranges::any_of(scenario->script.stretches(), [](const surgeon::Stretch& one) {
      return one.kind == surgeon::StretchKind::PressHold;
    }));
  }
}

}  // namespace
}  // namespace palp::lab
