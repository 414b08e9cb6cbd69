#include "patient_site/settings_devices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::patient {
namespace {

using testing::HasSubstr;

constexpr const char* kThreeAxes = R"(
normal { profile: "orca" address: "serial:/dev/ttyUSB0" zero_mm: 40 travel_max_mm: 12 }
x { profile: "iai" address: "tcp:127.0.0.1:5020" station: 2 travel_min_mm: -40
    speed_max_m_per_s: 0.05 }
y { profile: "az" address: "serial:/dev/ttyUSB1" um_per_count: 5 baud: 115200 travel_max_mm: 30 }
cell { profile: "tlb4" address: "tcp:127.0.0.1:5021" mn_per_count: 20 lag_ms: 12
       yield_um_per_n: 30 }
)";

std::string refusal(const std::string& text) {
  const auto made = make_device_plans(text, "rig");
  return made ? "accepted" : made.error().text;
}

TEST(DevicePlansTest, AStageOfThreeMakersAndACell) {
  const auto plans = make_device_plans(kThreeAxes, "rig");
  ASSERT_TRUE(plans) << plans.error().text;
  EXPECT_EQ(plans->normal->profile.name, "Iris ORCA");
  EXPECT_EQ(plans->normal->address.parity, 'E');
  EXPECT_EQ(plans->normal->address.baud, 115'200U);
  EXPECT_EQ(plans->normal->installation.zero, 0.04);
  EXPECT_EQ(plans->x->address.station, 2);
  EXPECT_EQ(plans->y->address.baud, 115'200U);
  const StageFacts facts = stage_facts_of(*plans);
  EXPECT_EQ(facts.axes, 3U);
  EXPECT_EQ(facts.speed, 0.05);
  EXPECT_EQ(facts.rate, 200);
  EXPECT_EQ(facts.travel_max, 0.012);
  EXPECT_DOUBLE_EQ(facts.travel_side, 0.02);
  EXPECT_FALSE(flaw_of(DeviceFacts{.hand = {}, .stage = facts, .sensor = {}}));
  const ForceSensorFacts sensor = sensor_facts_of(*plans->cell);
  EXPECT_EQ(sensor.step, 0.02);
  EXPECT_EQ(sensor.lag, 0.012);
  EXPECT_DOUBLE_EQ(sensor.yield, 30e-6);
  EXPECT_EQ(sensor.rate, 100);
}

TEST(DevicePlansTest, ASlowLineMakesASlowDevice) {
  const auto rate = [](const std::string& words) {
    const std::string text = "normal { profile: \"orca\" " + words + " }";
    const auto plans = make_device_plans(text, "rig");
    EXPECT_TRUE(plans) << plans.error().text;
    return std::pair{stage_facts_of(*plans).rate, seconds(plans->normal->profile.silence)};
  };
  EXPECT_EQ(rate("address: \"serial:/dev/a\"").first, 200);
  EXPECT_EQ(rate("address: \"serial:/dev/a\" baud: 1000000").first, 200);
  // 38 bytes of 11 bits and 1 ms of the device.
  const auto [slow, silence] = rate("address: \"serial:/dev/a\" baud: 19200");
  EXPECT_NEAR(slow, 1 / (38 * 11 / 19'200.0 + 1e-3), 0.01);
  EXPECT_GT(silence, 0.13);
  EXPECT_EQ(rate("address: \"tcp:1.2.3.4:5\" baud: 19200").first, 200);
  EXPECT_EQ(rate("address: \"serial:/dev/a\" baud: 19200 silence_ms: 60").second, 0.06);
}

TEST(DevicePlansTest, AForceThatStaysTheSameIsStuckWhereTheProductsNever) {
  const std::string axis = "normal { profile: \"iai\" address: \"tcp:1.2.3.4:5\" } ";
  const auto after = [&](const std::string& words) {
    const std::string cell = "cell { profile: \"tlb4\" address: \"tcp:1.2.3.4:6\" " + words + "}";
    return make_device_plans(axis + cell, "rig").value().cell->installation.stuck_after;
  };
  EXPECT_EQ(after(""), std::chrono::seconds{2});
  EXPECT_EQ(after("stuck_after_s: 7"), std::chrono::seconds{7});
}

TEST(DevicePlansTest, SaysWhatIsWrongAndWhere) {
  EXPECT_THAT(refusal("normal { profile: \"robot\" address: \"tcp:1.2.3.4:5\" }"),
              HasSubstr("rig: normal: unknown profile 'robot'; there are: az, iai"));
  EXPECT_THAT(refusal("normal { profile: \"iai\" address: \"COM1\" }"), HasSubstr("'COM1'"));
  EXPECT_THAT(refusal("normal { profile: \"iai\" station: 300 }"), HasSubstr("rig:1:"));
  EXPECT_THAT(refusal("normal { profile: \"tlb4\" address: \"tcp:1.2.3.4:5\" }"),
              HasSubstr("is no axis"));
  EXPECT_THAT(refusal("cell { profile: \"iai\" address: \"tcp:1.2.3.4:5\" }"),
              HasSubstr("is no force sensor"));
  EXPECT_THAT(refusal("x { profile: \"iai\" address: \"tcp:1.2.3.4:5\" }"),
              HasSubstr("x and y, or neither"));
  EXPECT_THAT(refusal("normal { profile: \"iai\" address: \"serial:/dev/a\" }"
                      "cell { profile: \"tlb4\" address: \"serial:/dev/a\" }"),
              HasSubstr("line of its own"));
  EXPECT_THAT(refusal("normal { profile: \"orca\" yield_um_per_n: 1001 }"),
              HasSubstr("yield_um_per_n"));
  EXPECT_THAT(refusal("normal { profile: \"file:/no/such\" address: \"tcp:1.2.3.4:5\" }"),
              HasSubstr("/no/such"));
}

TEST(DevicePlansTest, AFileThatCannotBeReadIsUnreachable) {
  EXPECT_FALSE(read_device_plans("/no/such/file"));
}

TEST(DevicePlansTest, AllProfilesOfTheHouseAreSound) {
  for (const char* name : {"az", "iai", "orca", "tlb4", "z-sg"}) {
    const auto profile = find_profile(name);
    ASSERT_TRUE(profile) << name << ": " << profile.error().text;
    EXPECT_GE(profile->silence, 3 * profile->period) << name;
  }
}

TEST(DevicePlansTest, ACardTakesThePlaceOfTheCell) {
  const std::string axis = "normal { profile: \"iai\" address: \"tcp:127.0.0.1:502\" } ";
  const auto plans =
      make_device_plans(axis + "card { n_per_v: 5 range: 1 channel: 3 yield_um_per_n: 7 }", "rig");
  ASSERT_TRUE(plans) << plans.error().text;
  EXPECT_EQ(plans->card->installation.channel, 3);
  const ForceSensorFacts sensor = facts_of(*plans).sensor;
  EXPECT_NEAR(sensor.step, 0.76e-3, 0.01e-3);
  EXPECT_EQ(sensor.rate, 1000);
  EXPECT_DOUBLE_EQ(sensor.yield, 7e-6);
  EXPECT_EQ(sensor_silence_of(*plans), std::chrono::milliseconds{5});
  EXPECT_THAT(refusal(axis + "card { channel: 1 }"), HasSubstr("not calibrated: no n_per_v"));
  EXPECT_THAT(refusal(std::string{kThreeAxes} + "card { n_per_v: 5 }"), HasSubstr("not both"));
  EXPECT_THAT(refusal(axis + "card { n_per_v: 5 channel: 8 }"), HasSubstr("rig:1"));
}

}  // namespace
}  // namespace palp::patient
