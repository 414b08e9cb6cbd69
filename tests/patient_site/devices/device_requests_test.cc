#include "patient_site/devices/device_requests.h"

#include <gtest/gtest.h>

namespace palp::patient {
namespace {

TEST(DeviceRequestsTest, HoldWhatAPersonAskedForAndWhatTheSiteExpects) {
  DeviceRequests requests;
  EXPECT_EQ(requests.newest().tares, 0U);
  requests.tare();
  requests.restart();
  requests.tare();
  requests.expect_touch(true);
  EXPECT_EQ(requests.newest().tares, 2U);
  EXPECT_EQ(requests.newest().restarts, 1U);
  EXPECT_TRUE(requests.newest().may_touch);
  requests.expect_touch(false);
  EXPECT_FALSE(requests.newest().may_touch);
  EXPECT_EQ(requests.newest().tares, 2U) << "not asked for again";
}

}  // namespace
}  // namespace palp::patient
