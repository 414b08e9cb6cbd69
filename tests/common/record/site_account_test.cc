#include "common/record/site_account.h"

#include <gtest/gtest.h>

#include "common/core/user_command.h"
#include "tests/support/fake_recorder.h"

namespace palp::record {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""us;

TimePoint at(Duration since) { return TimePoint{since}; }

TEST(SiteAccountTest, TimePassesInWholePeriodsAndMissedOnesAreCounted) {
  test::NullRecorder recorder;
  SiteAccount account{{}, recorder};
  EXPECT_EQ(account.begin_tick(at(5ms)), 1ms) << "the first";
  EXPECT_EQ(account.begin_tick(at(6100us)), 1ms) << "a little late";
  EXPECT_EQ(account.begin_tick(at(9000us)), (Lapse{1ms, 3})) << "two were missed";
  EXPECT_EQ(account.begin_tick(at(1ms)), 1ms) << "a clock that jumps back";
  EXPECT_EQ(account.counts().ticks, 4U);
  EXPECT_EQ(account.counts().ticks_missed, 2U);
}

TEST(SiteAccountTest, WhatTheRecorderRefusesIsCounted) {
  test::FullRecorder full;
  SiteAccount account{{}, full};
  (void)account.begin_tick(at(1ms));
  account.note(NoteCode::NotFinite);
  EXPECT_EQ(account.counts().records, 0U);
  EXPECT_EQ(account.counts().records_lost, 1U);
}

TEST(SiteAccountTest, TheLinksStatusIsWrittenAtTimesAndItsEventsAtOnce) {
  test::KeepingRecorder recorder;
  SiteAccount account{{.link_status_every = 10ms}, recorder};
  LinkHealth health;
  for (int i = 1; i <= 25; ++i) {
    (void)account.begin_tick(at(i * 1ms));
    if (i == 5) health.state = LinkState::Live;
    account.link(health);
  }
  EXPECT_EQ(recorder.all<LinkStatus>().size(), 3U);
  ASSERT_EQ(recorder.all<Note>().size(), 1U);
  EXPECT_EQ(recorder.all<Note>()[0].at, at(5ms));
}

TEST(SiteAccountTest, TheUsersCommandsAreWrittenFirstAndWhereTheyChange) {
  test::KeepingRecorder recorder;
  SiteAccount account{{}, recorder};
  for (int i = 1; i <= 10; ++i) {
    (void)account.begin_tick(at(i * 1ms));
    account.user({.emergency_stop = i == 4, .resets = i < 8 ? 0U : 1U});
  }
  std::vector<Duration> when;
  for (const UserAsked& one : recorder.all<UserAsked>()) when.push_back(one.at.time_since_epoch());
  EXPECT_EQ(when, (std::vector<Duration>{1ms, 4ms, 5ms, 8ms}));
}

TEST(SiteAccountTest, DevicesAreWrittenFirstAndThePeersWhereASessionChanges) {
  test::KeepingRecorder recorder;
  SiteAccount account{{}, recorder};
  const DeviceFacts own{.hand = HandFacts{}, .stage = {}, .sensor = {}};
  const DeviceFacts peer{.hand = {}, .stage = StageFacts{}, .sensor = ForceSensorFacts{}};
  for (int i = 1; i <= 10; ++i) {
    (void)account.begin_tick(at(i * 1ms));
    account.devices(own, peer, i == 6);
  }
  const std::vector<DevicesTold> told = recorder.all<DevicesTold>();
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[0].at, at(1ms));
  EXPECT_FALSE(told[0].of_peer);
  EXPECT_TRUE(told[0].facts.hand);
  EXPECT_EQ(told[1].at, at(6ms));
  EXPECT_TRUE(told[1].of_peer);
  EXPECT_TRUE(told[1].facts.stage);
}

TEST(SiteAccountTest, AReasonThatIsNoneIsNoTransition) {
  test::KeepingRecorder recorder;
  SiteAccount account{{}, recorder};
  (void)account.begin_tick(at(1ms));
  account.transition(SiteState::Parked, SiteState::Parked, NoteCode::None);
  EXPECT_TRUE(recorder.records().empty());
  account.transition(SiteState::Parked, SiteState::Clutched, NoteCode::LinkReady);
  ASSERT_EQ(recorder.all<Transition>().size(), 1U);
  EXPECT_EQ(recorder.all<Transition>()[0].to, SiteState::Clutched);
}

}  // namespace
}  // namespace palp::record
