#include "review/time_line.h"

#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/review/session_samples.h"

namespace palp::review {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using test::at_ms;

LinkPoint told(Duration offset, Duration uncertainty, TimePoint at) {
  LinkPoint point;
  point.at = at;
  point.peer_clock = ClockOffset{.offset = offset, .uncertainty = uncertainty, .at = at};
  return point;
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

/// One clock, and the patient's side begins the session 400 ms later: the link tells of -400 ms.
TEST(TimeLineTest, AnOffsetCountsFromWhereEachSideBeganTheSession) {
  SiteData surgeon;
  SiteData patient;
  surgeon.sessions = {{7, at_ms(50)}, {8, at_ms(100)}};
  patient.sessions = {{6, at_ms(0)}, {8, at_ms(500)}};
  surgeon.links = {told(-400ms, 2ms, at_ms(600))};
  EXPECT_EQ(time_line_of(surgeon, patient).surgeons(at_ms(900)), at_ms(900));
  patient.links = {told(400ms, 1ms, at_ms(700))};
  surgeon.links.clear();
  const TimeLine line = time_line_of(surgeon, patient);
  EXPECT_EQ(line.surgeons(at_ms(900)), at_ms(900));
  EXPECT_EQ(line.at, at_ms(700));
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
  const auto pair = pair_of(std::move(surgeon), std::move(patient));
  ASSERT_FALSE(pair);
  EXPECT_THAT(pair.error().text, testing::HasSubstr("0000000000000abc"));
  EXPECT_THAT(pair.error().text, testing::HasSubstr("0000000000000def"));
}

TEST(SessionPairTest, SessionsOfOtherSurgeonsAreLeftOut) {
  SiteData surgeon;
  surgeon.sessions = {{2, at_ms(500)}};
  SiteData patient;
  patient.sessions = {{1, at_ms(0), 1}, {2, at_ms(100), 2}, {3, at_ms(200), 4}};
  patient.ticks = 6;
  for (const std::int64_t ms : {50, 100, 150, 200, 250}) patient.notes.push_back({at_ms(ms)});
  const auto pair = pair_of(std::move(surgeon), std::move(patient));
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->session_id, "0000000000000002");
  ASSERT_EQ(pair->patient.notes.size(), 2U);
  EXPECT_EQ(pair->patient.notes.front().at, at_ms(100));
  EXPECT_EQ(pair->patient.ticks, 2U);
  EXPECT_EQ(pair->patient.from, at_ms(100));
  EXPECT_EQ(pair->patient.to, at_ms(200));
}

TEST(SessionPairTest, FilesThatNameNoSessionAreTakenAsTheyAre) {
  auto loaded = test::load(test::sample_session());
  const std::uint64_t ticks = loaded.surgeon.ticks;
  const auto pair = pair_of(std::move(loaded.surgeon), std::move(loaded.patient));
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->session_id, "");
  EXPECT_EQ(pair->surgeon.ticks, ticks);
}

}  // namespace
}  // namespace palp::review
