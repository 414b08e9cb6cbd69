#include "surgeon_site/settings_devices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::surgeon {
namespace {

using testing::HasSubstr;

std::string refusal(const char* master, const std::string& text) {
  const auto made = make_master_plan(*master_named(master), text, "master");
  return made ? "accepted" : made.error().text;
}

TEST(MasterSettingsTest, ABoardAsItIsBuiltIn) {
  const auto plan = make_master_plan(*master_named("openffboard"),
                                     "master { um_per_count: 2 mn_per_count: 0.1 zero_mm: 5 "
                                     "reversed: true force_max_n: 4 force_continuous_n: 2 "
                                     "pedal_button: 3 serial: \"A1\" }",
                                     "master");
  ASSERT_TRUE(plan) << plan.error().text;
  EXPECT_DOUBLE_EQ(plan->installation.position_unit, 2e-6);
  EXPECT_DOUBLE_EQ(plan->installation.force_unit, 1e-4);
  EXPECT_DOUBLE_EQ(plan->installation.zero, 5e-3);
  EXPECT_TRUE(plan->installation.reversed);
  EXPECT_EQ(plan->installation.silence, std::chrono::milliseconds{200});
  EXPECT_EQ(plan->installation.force_max, 4);
  EXPECT_EQ(plan->facts.force_peak, 4);
  EXPECT_EQ(plan->facts.force_continuous, 2);
  EXPECT_EQ(plan->facts.axes, 1U);
  EXPECT_EQ(plan->pedal_button, 3);
  EXPECT_EQ(plan->serial, "A1");
  EXPECT_FALSE(flaw_of(DeviceFacts{.hand = plan->facts, .stage = {}, .sensor = {}}));
}

TEST(MasterSettingsTest, WithoutCalibrationThereIsNoMaster) {
  EXPECT_THAT(refusal("openffboard", ""), HasSubstr("not calibrated: no um_per_count"));
  EXPECT_THAT(refusal("openffboard", "master { um_per_count: 1 }"),
              HasSubstr("not calibrated: no mn_per_count"));
  EXPECT_EQ(refusal("paddle", ""), "accepted") << "its firmware is calibrated";
  EXPECT_EQ(refusal("spacemouse", ""), "accepted") << "it has no motor";
}

TEST(MasterSettingsTest, BadInputNamesFileAndField) {
  EXPECT_THAT(refusal("paddle", "master { force_max_n: 400 }"), HasSubstr("master:1"));
  EXPECT_THAT(refusal("paddle", "master { travel_min_mm: 30 }"), HasSubstr("travel_m"));
  EXPECT_THAT(refusal("paddle", "master { force: 1 }"), HasSubstr("master:1"));
  EXPECT_FALSE(read_master_plan(*master_named("paddle"), "/no/such/file"));
}

TEST(MasterSettingsTest, AnswersAreButtonsThatItHasAndNotThePedal) {
  const std::string two = "answer { button: 1 } answer { button: 12 }";
  EXPECT_EQ(refusal("spacemouse", "master { " + two + " }"), "accepted");
  EXPECT_THAT(refusal("spacemouse", "master { answer { button: 16 } }"),
              HasSubstr("answer.button is 16, expected 0 to 15"));
  EXPECT_THAT(refusal("spacemouse", "master { pedal_button: 12 " + two + " }"),
              HasSubstr("button 12 is the pedal"));
  EXPECT_THAT(refusal("spacemouse", "master { " + two + " answer { button: 1 } }"),
              HasSubstr("button 1 stands for two answers"));
  EXPECT_THAT(refusal("paddle", "master { " + two + " }"), HasSubstr("no other button"));
  std::string many = "master { pedal_button: 15 ";
  for (int i = 0; i < 9; ++i) many += "answer { button: " + std::to_string(i) + " } ";
  EXPECT_THAT(refusal("spacemouse", many + "}"), HasSubstr("9 answers, expected 8 at most"));
}

TEST(MasterSettingsTest, ACapMovesAtItsRates) {
  const auto plan = make_master_plan(
      *master_named("spacemouse"), "master { rate_mm_per_s: 8 side_rate_mm_per_s: 30 }", "master");
  ASSERT_TRUE(plan);
  EXPECT_DOUBLE_EQ(plan->rates.speed_max, 8e-3);
  EXPECT_DOUBLE_EQ(plan->rates.side_speed_max, 30e-3);
  EXPECT_EQ(plan->facts.axes, 3U);
  EXPECT_EQ(plan->installation.silence, Duration{0});
}

}  // namespace
}  // namespace palp::surgeon
