#include "patient_site/display.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::patient {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(PatientDisplayTest, WithoutALinkItSaysSo) {
  EXPECT_EQ(status_line({}), "PARKED  no link  tip 0.00 mm  contact 0.00 N  depth -");
}

TEST(PatientDisplayTest, ShowsTheSiteInItsUnits) {
  PatientStatus status;
  status.state = SiteState::Engaged;
  status.link.state = LinkState::Live;
  status.link.round_trip = std::chrono::microseconds{5250};
  status.link.accepted = 60;
  status.link.late = 30;  // they came, and are not lost
  status.link.lost = 10;
  status.position = 3.456e-3;
  status.contact_force = 0.734;
  status.depth.number = 1;
  status.depth.verdict = DepthVerdict::Found;
  status.depth.depth = 10.2e-3;
  status.depth.hash = 0.07312;
  status.depth.place = kSiteB;
  EXPECT_EQ(status_line(status),
            "ENGAGED  rtt 5.2 ms  loss 10.0 %  tip 3.46 mm  contact 0.73 N  "
            "depth 10.2 mm (h 0.0731 N) at B");
}

TEST(PatientDisplayTest, InFewColumnsWhatMattersStays) {
  PatientStatus status;
  status.state = SiteState::Hold;
  status.reason = record::NoteCode::GapHold;
  status.depth.number = 1;
  status.depth.verdict = DepthVerdict::None;
  status.depth.depth_low = 12e-3;
  EXPECT_EQ(status_line(status, 60), "HOLD  no link  tip 0.00 mm  contact 0.00 N  no inclusion");
}

TEST(PatientDisplayTest, SaysWhyItIsNotAsUsual) {
  PatientStatus status;
  status.state = SiteState::Hold;
  status.reason = record::NoteCode::GapHold;
  status.link.state = LinkState::Hold;
  status.link.gap = std::chrono::milliseconds{300};
  EXPECT_THAT(status_line(status), StartsWith("HOLD (nothing arrived: hold)"));
  EXPECT_THAT(status_line(status), HasSubstr("silent 0.3 s"));
  status.state = SiteState::Engaged;
  EXPECT_THAT(status_line(status), Not(HasSubstr("(")));
}

TEST(PatientDisplayTest, AnEstimateWithoutADepthSaysWhatItSays) {
  PatientStatus status;
  status.depth.number = 1;
  status.depth.verdict = DepthVerdict::None;
  status.depth.hash = 0.06;
  EXPECT_THAT(status_line(status), HasSubstr("no inclusion (h 0.0600 N) at A"));
  status.depth.verdict = DepthVerdict::Invalid;
  status.depth.reason = DepthReason::StrokeTooShort;
  EXPECT_THAT(status_line(status), HasSubstr("depth ? (stroke too short)"));
}

TEST(PatientDisplayTest, AMapSaysMoreThanTheLastTouch) {
  PatientStatus status;
  status.depth = {.number = 9, .place = {}, .verdict = DepthVerdict::Found, .depth = 7.7e-3};
  status.map = {.number = 9, .places = 9, .verdict = DepthVerdict::None};
  EXPECT_THAT(status_line(status), HasSubstr("no inclusion found at 9 places"));
  EXPECT_THAT(status_line(status), Not(HasSubstr("7.7")));
}

}  // namespace
}  // namespace palp::patient
