// A person and a drive, in virtual time.
#include "patient_site/axis_check.h"

#include <sstream>

#include <gtest/gtest.h>

#include "tests/patient_site/devices/drive_model.h"

namespace palp::patient {
namespace {

class AxisCheckTest : public testing::Test {
 protected:
  AxisCheckTest() {
    plan_.profile = find_profile("iai").value();
    plan_.installation = DriveModel::installation();
    plan_.installation.travel_min = -0.03;
    plan_.installation.travel_max = 0.02;
    plan_.address.line = "none";
  }
  Result<DevicePlan> check(const std::string& answers) {
    std::istringstream in{answers};
    site_program::Dialogue talk{in, out_};
    return AxisCheck{
        plan_, drive_.port, drive_.clock, [this](Duration span) { drive_.pass(span); }, talk}
        .run();
  }

  DriveModel drive_{"iai"};
  DevicePlan plan_;
  std::ostringstream out_;
};

TEST_F(AxisCheckTest, ADriveThatDoesAsItsFileSaysKeepsItsNumbers) {
  const auto found = check("yes\nout\n2\nyes\n");
  ASSERT_TRUE(found) << found.error().text << out_.str();
  EXPECT_FALSE(found->installation.reversed);
  EXPECT_EQ(found->installation.position_unit, 0) << "the profile's";
  EXPECT_NEAR(found->installation.zero, 0.05, 1e-9);
  EXPECT_EQ(found->installation.travel_min, -0.03);
  EXPECT_LT(found->lag, 0.04);
  EXPECT_NEAR(drive_.place(), 0, 2e-4) << "where it stood before";
}

TEST_F(AxisCheckTest, APersonWithARulerTurnsItRoundAndScalesIt) {
  const auto found = check("yes\nin\n4\nno\n");
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_TRUE(found->installation.reversed);
  EXPECT_NEAR(found->installation.position_unit, 2e-5, 1e-12);
  EXPECT_NEAR(found->installation.zero, 0.1, 1e-3) << "0.05 of what it reads, in twice its unit";
}

TEST_F(AxisCheckTest, AStopIsFoundBeforeTheEndOfItsTravel) {
  drive_.stop_at = 0.012;
  const auto found = check("yes\nout\n2\nyes\n");
  ASSERT_TRUE(found) << found.error().text << out_.str();
  EXPECT_NEAR(found->installation.travel_min, -0.011, 2e-4);
  EXPECT_NEAR(found->installation.travel_max, 0.011, 2e-4);
}

TEST_F(AxisCheckTest, WithoutAYesItDoesNotMove) {
  EXPECT_EQ(check("no\n").error().text, "it was not moved: without that it is not calibrated");
  EXPECT_EQ(drive_.place(), 0);
  EXPECT_EQ(check("yes\n").error().text, "nobody answered: the check was left");
}

TEST_F(AxisCheckTest, OneThatStandsStillAndOneThatIsAbsentAreTold) {
  drive_.stop_at = 0;
  EXPECT_EQ(check("yes\nout\n2\nyes\n").error().text, "it does not move");
  drive_.port.words[0x9005] = 0xB010;
  EXPECT_EQ(check("yes\n").error().text, "it is fault: the device reports: emergency stop");
}

}  // namespace
}  // namespace palp::patient
