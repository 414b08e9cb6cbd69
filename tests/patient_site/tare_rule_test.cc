#include "patient_site/tare_rule.h"

#include <gtest/gtest.h>

namespace palp::patient {
namespace {

TEST(TareRuleTest, OnlyInFreeAirAndNotWhileEngaged) {
  PatientStatus status;
  status.position = -5e-3;
  EXPECT_FALSE(why_no_tare(status));
  status.state = SiteState::Engaged;
  EXPECT_EQ(why_no_tare(status), "the site is engaged");
  status.state = SiteState::Stopped;
  EXPECT_FALSE(why_no_tare(status));
  status.position = -2e-3;
  EXPECT_TRUE(why_no_tare(status));
  status.position = -5e-3;
  status.surface = -4e-3;
  EXPECT_FALSE(why_no_tare(status)) << "as long as nobody knows it";
  status.surface_known = true;
  EXPECT_TRUE(why_no_tare(status));
}

}  // namespace
}  // namespace palp::patient
