#include "surgeon_site/advice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::surgeon {
namespace {

using testing::HasSubstr;

TEST(AdviceTest, OfDelayIsGivenAboveTheLimitOnly) {
  constexpr Duration kLimit = std::chrono::milliseconds{20};
  SurgeonStatus status;
  status.link.round_trip = std::chrono::milliseconds{60};
  EXPECT_FALSE(delay_advice(status, kLimit, false)) << "the link is down";
  status.link.state = LinkState::Live;
  EXPECT_THAT(delay_advice(status, kLimit, false).value(),
              testing::AllOf(testing::HasSubstr("60.0 ms"),
                             testing::HasSubstr("does not engage here unless --force-engage")));
  EXPECT_THAT(delay_advice(status, kLimit, true).value(), testing::HasSubstr("engages here"));
  status.link.round_trip = kLimit;
  EXPECT_FALSE(delay_advice(status, kLimit, false));
}

DeviceFacts devices(double stage_rate, double sensor_rate) {
  StageFacts stage;
  stage.rate = stage_rate;
  ForceSensorFacts sensor;
  sensor.rate = sensor_rate;
  return {.hand = {}, .stage = stage, .sensor = sensor};
}

TEST(AdviceTest, SlowDevicesOfThePatientAreToldOf) {
  EXPECT_FALSE(device_advice({})) << "nobody knows them yet";
  EXPECT_FALSE(device_advice(devices(200, 100)));
  EXPECT_THAT(device_advice(devices(50, 1000)).value(), HasSubstr("stage is read at 50 Hz"));
  EXPECT_THAT(device_advice(devices(1000, 50)).value(), HasSubstr("its force at 50 Hz"));
}

TEST(AdviceTest, EachSentenceIsSaidOnce) {
  Advice advice{{.coupling = "direct",
                 .direct_round_trip_max = std::chrono::milliseconds{20},
                 .engagement_forced = false}};
  SurgeonStatus status;
  EXPECT_TRUE(advice.news(status).empty());
  status.peer_devices = devices(50, 50);
  EXPECT_EQ(advice.news(status).size(), 1U);
  status.link.state = LinkState::Live;
  status.link.round_trip = std::chrono::milliseconds{60};
  ASSERT_EQ(advice.news(status).size(), 1U);
  EXPECT_TRUE(advice.news(status).empty());
}

TEST(AdviceTest, OtherCouplingsAreNotWarnedOfDelay) {
  Advice advice{{.coupling = "mmt",
                 .direct_round_trip_max = std::chrono::milliseconds{20},
                 .engagement_forced = false}};
  SurgeonStatus status;
  status.link.state = LinkState::Live;
  status.link.round_trip = std::chrono::milliseconds{60};
  EXPECT_TRUE(advice.news(status).empty());
}

}  // namespace
}  // namespace palp::surgeon
