// A person and a drive, in virtual time.
#include "patient_site/axis_check.h"

#include <cmath>
#include <functional>
#include <sstream>
#include <stdexcept>

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
    const TimePoint patience = drive_.clock.at + std::chrono::minutes{10};
    const auto pass = [&](Duration span) {
      drive_.pass(span);
      if (during_) during_();
      if (drive_.clock.at > patience) throw std::runtime_error{"it never ends"};
    };
    return AxisCheck{plan_, drive_.port, drive_.clock, pass, talk}.run();
  }
  [[nodiscard]] bool was_told(const char* words) const {
    return out_.str().find(words) != std::string::npos;
  }

  DriveModel drive_{"iai"};
  DevicePlan plan_;
  std::ostringstream out_;
  std::function<void()> during_;
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

TEST_F(AxisCheckTest, AStopInItsWayEndsItBeforeItIsLeftAlone) {
  during_ = [this] {
    if (was_told("um per count")) drive_.stop_at = std::abs(drive_.place());
  };
  EXPECT_EQ(check("yes\nout\n2\nyes\n").error().text, "it does not move");
  EXPECT_TRUE(drive_.port.coils[0x42C]) << "nothing pushes on";
}

TEST_F(AxisCheckTest, ANoisyPositionComesToRestWithinItsNoise) {
  drive_.wobble = 30e-6;
  const auto found = check("yes\nout\n2\nno\n");
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_TRUE(was_told("left alone it stopped"));
}

TEST_F(AxisCheckTest, OneThatNeverRestsOrGoesOnIsTold) {
  during_ = [this] { drive_.wobble = was_told("um per count") ? 3e-4 : 0; };
  EXPECT_EQ(check("yes\nout\n2\nno\n").error().text,
            "it does not come to rest although nobody commands it");
  drive_.wobble = 0;
  out_.str("");
  during_ = [this] { drive_.runs_on = was_told("um per count"); };
  EXPECT_EQ(check("yes\nout\n2\nno\n").error().text, "it goes on although nobody commands it");
  EXPECT_GT(drive_.place(), -6e-3) << "stopped at once";
}

TEST_F(AxisCheckTest, OneThatSwingsAboutDoesNotArrive) {
  during_ = [this] {  // slower than a jump, and never where it was sent
    if (!was_told("it moved after")) return;
    drive_.offset = 1.2e-3 + 0.5e-3 * std::sin(3 * seconds(drive_.clock.at.time_since_epoch()));
  };
  const auto found = check("yes\nout\n2\nno\n");
  ASSERT_FALSE(found) << out_.str();
  EXPECT_EQ(found.error().text.find("it stands at "), 0) << found.error().text;
}

TEST(AxisThatFeelsTest, ItsUnloadedForceIsNoTouchForTheCheck) {
  DriveModel drive{"orca"};
  drive.force = 3;
  DevicePlan plan;
  plan.profile = drive.profile();
  plan.installation = DriveModel::installation();
  std::istringstream in{"no\n"};
  std::ostringstream out;
  site_program::Dialogue talk{in, out};
  AxisCheck check{plan, drive.port, drive.clock, [&](Duration span) { drive.pass(span); }, talk};
  EXPECT_EQ(check.run().error().text, "it was not moved: without that it is not calibrated");
}

}  // namespace
}  // namespace palp::patient
