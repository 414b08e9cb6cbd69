#include "review/time_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/review/session_samples.h"

namespace palp::review {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using test::at_ms;

LinkStatus told(Duration offset, Duration uncertainty, TimePoint at) {
  LinkStatus status;
  status.at = at;
  status.health.peer_clock = ClockOffset{.offset = offset, .uncertainty = uncertainty, .at = at};
  return status;
}

TEST(TimeLineTest, TheMostCertainOffsetCounts) {
  SiteData surgeon;
  surgeon.links = {told(5s, 9ms, at_ms(0)), told(7s, 2ms, at_ms(1)), told(8s, 4ms, at_ms(2))};
  const TimeLine line = time_line_of(surgeon, {});
  EXPECT_TRUE(line.known);
  EXPECT_EQ(line.uncertainty, 2ms);
  EXPECT_EQ(line.surgeons(at_ms(7100)), at_ms(100));
}

TEST(TimeLineTest, ThePatientsOffsetServesWhereTheSurgeonHasNone) {
  SiteData patient;
  patient.links = {told(-7s, 2ms, at_ms(7000))};
  EXPECT_EQ(time_line_of({}, patient).surgeons(at_ms(7100)), at_ms(100));
}

TEST(TimeLineTest, WallClocksServeWhereNoOffsetWasLogged) {
  SiteData surgeon;
  SiteData patient;
  surgeon.clock.ahead = 100s;
  patient.clock.ahead = 93s;
  const TimeLine line = time_line_of(surgeon, patient);
  EXPECT_FALSE(line.known);
  EXPECT_EQ(line.surgeons(at_ms(7100)), at_ms(100));
}

TEST(TimeLineTest, NoOffsetOfAFileIsTooLargeToBeRead) {
  SiteData surgeon;
  surgeon.links = {told(Duration::min(), 1ms, at_ms(0))};
  EXPECT_FALSE(time_line_of(surgeon, {}).known);
  TimeLine line;
  line.offset = 1s;
  EXPECT_EQ(line.surgeons(TimePoint::min()), TimePoint::min());
}

TEST(SessionPairTest, FilesOfDifferentSessionsAreRefusedWithBothIds) {
  SiteData surgeon;
  SiteData patient;
  surgeon.sessions = {{0xabc, at_ms(0)}};
  patient.sessions = {{0xdef, at_ms(0)}};
  const auto pair = pair_of(surgeon, patient);
  ASSERT_FALSE(pair);
  EXPECT_THAT(pair.error().text, testing::HasSubstr("0000000000000abc"));
  EXPECT_THAT(pair.error().text, testing::HasSubstr("0000000000000def"));
}

TEST(SessionPairTest, SessionsOfOtherSurgeonsAreLeftOut) {
  SiteData surgeon;
  surgeon.sessions = {{2, at_ms(500)}};
  SiteData patient;
  patient.sessions = {{1, at_ms(0)}, {2, at_ms(100)}, {3, at_ms(200)}};
  for (const std::int64_t ms : {50, 100, 150, 200, 250}) {
    judge::Motion motion;
    motion.at = at_ms(ms);
    patient.motion.push_back(motion);
    patient.states.push_back(SiteState::Engaged);
  }
  const auto pair = pair_of(surgeon, patient);
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->session_id, "0000000000000002");
  ASSERT_EQ(pair->patient.motion.size(), 2U);
  EXPECT_EQ(pair->patient.motion.front().at, at_ms(100));
}

TEST(SessionPairTest, FilesThatNameNoSessionAreTakenAsTheyAre) {
  const auto loaded = test::load(test::sample_session());
  const auto pair = pair_of(loaded.surgeon, loaded.patient);
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->session_id, "");
  EXPECT_EQ(pair->surgeon.motion.size(), loaded.surgeon.motion.size());
}

}  // namespace
}  // namespace palp::review
