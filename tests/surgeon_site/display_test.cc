#include "surgeon_site/display.h"

#include <algorithm>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::surgeon {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""us;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

SurgeonStatus engaged() {
  SurgeonStatus status;
  status.state = SiteState::Engaged;
  status.link.state = LinkState::Live;
  status.link.round_trip = 12300us;
  status.link.accepted = 500;
  status.link.late = 480;  // they came, and are not lost
  status.link.lost = 20;
  status.force = 0.482;
  status.depth.number = 3;
  status.depth.verdict = DepthVerdict::Found;
  status.depth.depth = 9.7e-3;
  status.depth.hash = 0.0712;
  status.depth.place = kSiteB;
  status.script.scripted = true;
  status.script.begun = true;
  status.script.done = 0.62;
  const std::string_view name = "taps B";
  std::copy(name.begin(), name.end(), status.script.phase_name.begin());
  return status;
}

TEST(DisplayTest, SaysStateLinkForceDepthAndProgressInOneLine) {
  const std::string line = status_line(engaged());
  EXPECT_EQ(line,
            "ENGAGED  rtt 12.3 ms  loss 2.0 %  force 0.48 N  depth 9.7 mm (h 0.0712 N) at B"
            "  [######----] 62 %  taps B");
}

TEST(DisplayTest, StateForceDepthAndProgressStandIn80ColumnsWhateverElseIsSaid) {
  SurgeonStatus status = engaged();
  status.link.peer_clock = ClockOffset{};
  status.link.round_trip = 1234567us;
  status.depth.depth_low = 9.3e-3;
  status.depth.depth_high = 10.2e-3;
  EXPECT_THAT(status_line(status, 79),
              AllOf(StartsWith("ENGAGED  "),
                    HasSubstr("force 0.48 N"),
                    HasSubstr("depth 9.7 mm"),
                    HasSubstr("62 %")));
  status.peer_heard = true;
  status.peer_place = {-50e-3, -30e-3};
  status.shortage = record::NoteCode::TissueTooStiff;
  status.short_by = 0.31;
  status.force = -10.25;
  status.script.done = 1;
  for (const SiteState state : {SiteState::Parked,
                                SiteState::Clutched,
                                SiteState::Engaged,
                                SiteState::Hold,
                                SiteState::Retract,
                                SiteState::Stopped}) {
    for (const DepthVerdict verdict :
         {DepthVerdict::Found, DepthVerdict::None, DepthVerdict::Invalid}) {
      status.state = state;
      status.reason = record::NoteCode::GapHold;
      status.depth.verdict = verdict;
      const std::string line = status_line(status, 79);
      EXPECT_LE(line.size(), 79U) << line;
      EXPECT_THAT(line,
                  AllOf(StartsWith(std::string{to_string(state)}),
                        HasSubstr("force -10.25 N"),
                        HasSubstr("100 %")));
      EXPECT_THAT(
          line, AnyOf(HasSubstr("depth 9.7 mm"), HasSubstr("no inclusion"), HasSubstr("depth ?")));
    }
  }
}

TEST(DisplayTest, SaysThatTheHandFeelsLessThanTheTissue) {
  SurgeonStatus status = engaged();
  status.force_missing = status.short_by = 0.31;
  EXPECT_THAT(status_line(status), Not(HasSubstr("lift"))) << "the model is coming in";
  status.shortage = record::NoteCode::ForceIncomplete;
  EXPECT_THAT(status_line(status), HasSubstr("LESS THAN THE TISSUE'S BY 0.31 N: lift once"));
}

TEST(DisplayTest, SaysWhyTheHandFeelsLess) {
  SurgeonStatus status = engaged();
  status.short_by = 0.31;
  status.shortage = record::NoteCode::TissueTooStiff;
  EXPECT_THAT(status_line(status),
              HasSubstr("LESS THAN THE TISSUE'S BY 0.31 N: it is stiffer than can be shown"));
  status.shortage = record::NoteCode::TipFeelsMore;
  EXPECT_THAT(status_line(status), HasSubstr("THE TIP FEELS 0.31 N MORE THAN YOU"));
  status.shortage = record::NoteCode::TipElsewhere;
  status.place = {20e-3, 0};
  status.peer_place = {13e-3, 0};
  EXPECT_THAT(
      status_line(status),
      AllOf(HasSubstr("YOU FEEL ANOTHER PLACE: the tip is 7 mm behind"), Not(HasSubstr("0.31"))));
}

TEST(DisplayTest, SaysWhereTheStageIsWhereItDoesNotGoAlong) {
  SurgeonStatus status = engaged();
  status.peer_heard = true;
  status.place = {-100e-3, -30e-3};
  status.peer_place = {-99.5e-3, -30e-3};
  EXPECT_THAT(status_line(status), Not(HasSubstr("stage")));
  status.peer_place = {-50e-3, -30e-3};
  EXPECT_THAT(status_line(status), HasSubstr("stage not at -100,-30 but at -50,-30"));
  status.state = SiteState::Clutched;
  EXPECT_THAT(status_line(status), Not(HasSubstr("stage")));
}

TEST(DisplayTest, SaysWhatIsNotKnown) {
  EXPECT_EQ(status_line({}), "PARKED  no link  force 0.00 N  depth -");
}

TEST(DisplayTest, SaysWhyTheForceIsGone) {
  SurgeonStatus status = engaged();
  status.state = SiteState::Hold;
  status.reason = record::NoteCode::GapHold;
  status.link.state = LinkState::Hold;
  status.link.gap = 240ms;
  EXPECT_THAT(status_line(status), AllOf(HasSubstr("HOLD ("), HasSubstr("silent 0.2 s")));
}

TEST(DisplayTest, SaysTheVerdictOfADepth) {
  SurgeonStatus status = engaged();
  status.depth.verdict = DepthVerdict::None;
  EXPECT_THAT(status_line(status), HasSubstr("no inclusion (h 0.0712 N) at B"));
  status.depth.verdict = DepthVerdict::Invalid;
  status.depth.reason = DepthReason::StrokeTooShort;
  EXPECT_THAT(status_line(status), HasSubstr("depth ? (stroke too short)"));
}

TEST(DisplayTest, SaysTheOutcomeOfAFinishedScript) {
  SurgeonStatus status = engaged();
  status.script.done = 1;
  status.script.finished = true;
  status.script.outcome = ScriptOutcome::Completed;
  EXPECT_THAT(status_line(status),
              AllOf(HasSubstr("[##########] 100 %  completed"), Not(HasSubstr("taps"))));
}

TEST(DisplayTest, AMapSaysMoreThanTheLastTouch) {
  SurgeonStatus status;
  status.depth = {.number = 9, .verdict = DepthVerdict::Found, .depth = 7.7e-3};
  status.map = {.number = 9, .places = 9, .verdict = DepthVerdict::None};
  EXPECT_THAT(status_line(status), HasSubstr("no inclusion found at 9 places"));
  EXPECT_THAT(status_line(status), Not(HasSubstr("7.7")));
}

}  // namespace
}  // namespace palp::surgeon
