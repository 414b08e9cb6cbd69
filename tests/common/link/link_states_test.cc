#include <algorithm>
#include <stdexcept>

#include <gtest/gtest.h>

#include "common/link/link.h"
#include "tests/common/link/link_couple.h"

namespace palp::link {
namespace {

using std::chrono_literals::operator""s;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""us;

TEST(LinkStatesTest, WatchdogIsExactToTheTick) {
  Couple couple;
  couple.connect();
  couple.run(1s);
  ASSERT_EQ(couple.patient_health().state, LinkState::Live);
  couple.pipe.up->outcome = kCut;
  couple.tick();                             // takes what was sent in the tick before
  const TimePoint heard = couple.now - 2ms;  // the pipe has no delay: it arrived when it was sent
  ASSERT_EQ(couple.patient_health().gap, couple.now - 1ms - heard);
  const auto state_at = [&](Duration gap) {
    while (couple.now <= heard + gap) couple.tick();
    EXPECT_EQ(couple.patient_health().gap, gap);
    return couple.patient_health().state;
  };
  EXPECT_EQ(state_at(100ms), LinkState::Live);
  EXPECT_EQ(state_at(101ms), LinkState::Hold);
  EXPECT_EQ(state_at(500ms), LinkState::Hold);
  EXPECT_EQ(state_at(501ms), LinkState::Lost);
  EXPECT_EQ(state_at(30'000ms), LinkState::Lost);
  EXPECT_EQ(couple.patient_health().session_id, 1U);
  while (couple.now <= heard + 30'001ms) couple.tick();
  EXPECT_EQ(couple.patient_health().state, LinkState::Down);
  EXPECT_EQ(couple.patient_health().session_id, 0U);
}

TEST(LinkStatesTest, OutOfHoldAndLostWithTheFirstAcceptedTelegram) {
  for (const Duration blackout : {Duration{300ms}, Duration{5s}}) {
    Couple couple;
    couple.connect();
    couple.run(1s);
    couple.pipe.up->outcome = kCut;
    couple.run(blackout);
    ASSERT_NE(couple.patient_health().state, LinkState::Live);
    couple.pipe.up->outcome = after(0ms);
    couple.run(2ms);
    EXPECT_EQ(couple.patient_health().state, LinkState::Live);
  }
}

TEST(LinkStatesTest, AfterThirtySecondsOnlyAnotherLinkUpdateHelps) {
  Couple couple;
  couple.connect();
  couple.run(1s);
  couple.patient.sending = false;
  couple.surgeon.sending = false;
  couple.run(31s);
  couple.patient.sending = true;
  couple.surgeon.sending = true;
  couple.run(1s);
  EXPECT_EQ(couple.patient_health().state, LinkState::Down);
  EXPECT_EQ(couple.patient.last.peer_heard, false);
  couple.connect(2);
  couple.run(1s);
  EXPECT_EQ(couple.patient_health().state, LinkState::Live);
  EXPECT_EQ(couple.patient_health().session_id, 2U);
}

TEST(LinkStatesTest, WithoutASessionTheTransportIsStillDrained) {
  Couple couple;
  LinkConfig config;
  couple.connect();
  couple.run(1s);
  couple.patient.sending = false;
  couple.run(31s);
  ASSERT_EQ(couple.surgeon_health().session_id, 0U);
  const std::uint64_t foreign = couple.surgeon_health().foreign;
  couple.pipe.down->push(Bytes(80, std::byte{0x80}), couple.now);
  couple.pipe.down->push({}, couple.now);
  couple.run(2ms);
  EXPECT_TRUE(couple.pipe.down->empty());
  EXPECT_EQ(couple.surgeon_health().foreign, foreign);  // malformed, both
  EXPECT_GE(couple.surgeon_health().malformed, 2U);
}

TEST(LinkStatesTest, DownUntilEightExchanges) {
  Couple couple;
  couple.pipe.up->outcome = after(25ms);
  couple.pipe.down->outcome = after(25ms);
  couple.connect();
  // The surgeon's telegram of 0 ms is echoed in the patient's of 25 ms, which arrives at 50 ms.
  couple.run(57ms);
  EXPECT_EQ(couple.surgeon_health().state, LinkState::Down);
  couple.tick();
  EXPECT_EQ(couple.surgeon_health().state, LinkState::Live);
  EXPECT_EQ(couple.patient_health().state, LinkState::Live);
}

TEST(LinkStatesTest, DownAtMostTwoSecondsWhereEchoesAreRare) {
  Couple couple{LinkConfig{.sync_exchanges = 1'000'000}};
  couple.pipe.up->outcome = after(25ms);
  couple.connect();
  couple.run(2000ms);  // the first one arrived at 0 ms
  EXPECT_EQ(couple.surgeon_health().state, LinkState::Down);
  couple.tick();
  EXPECT_EQ(couple.surgeon_health().state, LinkState::Live);
}

TEST(LinkStatesTest, NeverLiveWithoutAWayBack) {
  Couple couple;
  couple.pipe.up->outcome = kCut;
  couple.connect();
  couple.run(20s);
  EXPECT_EQ(couple.surgeon_health().state, LinkState::Down);
  EXPECT_GT(couple.surgeon_health().accepted, 19'000U);
}

TEST(LinkStatesTest, NeverLiveWhereTheRoundTripIsTooLong) {
  for (const auto& [each_way, state] :
       {std::pair{Duration{1250ms}, LinkState::Live}, {Duration{1251ms}, LinkState::Down}}) {
    Couple couple;
    couple.pipe.up->outcome = after(each_way);
    couple.pipe.down->outcome = after(each_way);
    couple.connect();
    couple.run(8s);
    EXPECT_EQ(couple.surgeon_health().state, state);
  }
}

TEST(LinkStatesTest, ATelegramThatTookTooLongIsStaleAndFeedsNothing) {
  Couple couple;
  couple.pipe.up->outcome = after(10ms);
  couple.connect();
  couple.run(1s);
  couple.pipe.up->outcome = after(210ms);  // 200 ms more: just allowed
  couple.run(300ms);
  EXPECT_EQ(couple.patient_health().stale, 0U);
  EXPECT_EQ(couple.patient_health().state, LinkState::Live);
  const std::uint64_t accepted = couple.patient_health().accepted;
  couple.pipe.up->outcome = after(211ms);
  couple.surgeon.telegram.site.state = SiteState::Stopped;
  couple.run(350ms);
  EXPECT_NEAR(static_cast<double>(couple.patient_health().stale), 138, 1);
  EXPECT_LE(couple.patient_health().accepted, accepted + 211);
  EXPECT_EQ(couple.patient_health().state, LinkState::Hold);
  EXPECT_EQ(couple.patient.last.peer.state, SiteState::Parked);
  couple.run(17s);  // the longer way has become the usual one
  EXPECT_EQ(couple.patient_health().state, LinkState::Live);
}

TEST(LinkStatesTest, OnLongLinksHalfTheRoundTripIsAllowed) {
  Couple couple;
  couple.pipe.up->outcome = after(300ms);
  couple.pipe.down->outcome = after(300ms);
  couple.connect();
  couple.run(2s);
  couple.pipe.up->outcome = after(600ms);
  couple.run(2s);
  EXPECT_EQ(couple.patient_health().stale, 0U);
  EXPECT_EQ(couple.patient_health().state, LinkState::Live);
}

TEST(LinkStatesTest, ANewSessionStartsAnewAndCountersGoOn) {
  Couple couple;
  couple.pipe.up->outcome = losing({5, 6});
  couple.connect(1);
  couple.surgeon.telegram.site.epoch = 4;
  couple.run(1s);
  const LinkHealth before = couple.patient_health();
  ASSERT_EQ(before.lost, 2U);
  couple.connect(2);
  couple.patient.samples.clear();
  const LinkHealth after_adopt = couple.patient.link.health(couple.now);
  EXPECT_EQ(after_adopt.state, LinkState::Down);
  EXPECT_EQ(after_adopt.round_trip, Duration{0});
  EXPECT_EQ(after_adopt.accepted, before.accepted);
  EXPECT_EQ(after_adopt.lost, 2U);

  couple.surgeon.telegram.site.epoch = 0;
  couple.run(100ms);
  const LinkHealth health = couple.patient_health();
  EXPECT_EQ(couple.patient.samples.front().number, 0U);
  EXPECT_EQ(couple.patient.samples.size(), 99U);
  EXPECT_EQ(health.accepted, before.accepted + 99);
  EXPECT_EQ(health.foreign, before.foreign + 1);  // the last of the old session
  EXPECT_EQ(health.replayed + health.too_old + health.old_epoch, 0U);
  EXPECT_EQ(health.state, LinkState::Live);
}

TEST(LinkStatesTest, ANewWayForTheSameSessionResetsNothing) {
  Couple couple;
  couple.connect();
  couple.run(1s);
  const LinkHealth before = couple.patient_health();
  LinkUpdate way{.transport = couple.pipe.patient_end(),
                 .protection = nullptr,
                 .send_connection = 2,
                 .receive_connection = 3,
                 .session_id = 1};
  const LinkUpdate retired = couple.patient.link.adopt(std::move(way), couple.now);
  EXPECT_TRUE(retired.transport);
  EXPECT_FALSE(retired.protection);
  couple.run(10ms);
  EXPECT_EQ(couple.patient_health().accepted, before.accepted + 10);
  EXPECT_EQ(couple.patient_health().state, LinkState::Live);
  EXPECT_EQ(couple.patient.samples.back().number, 1008U);
}

TEST(LinkStatesTest, AnEmptyLinkUpdateEndsTheSessionAndGivesEverythingBack) {
  Couple couple;
  couple.connect();
  couple.run(1s);
  const LinkUpdate retired = couple.patient.link.adopt({}, couple.now);
  EXPECT_TRUE(retired.transport);
  EXPECT_TRUE(retired.protection);
  EXPECT_EQ(retired.session_id, 1U);
  EXPECT_EQ(couple.patient.link.health(couple.now).state, LinkState::Down);
  couple.run(10ms);
  EXPECT_FALSE(couple.patient.last.peer_heard);
}

}  // namespace
}  // namespace palp::link
