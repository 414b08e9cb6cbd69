#include "common/link/session.h"

#include <set>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/core/random.h"
#include "tests/common/link/session_town.h"

namespace palp::link {
namespace {

using std::chrono_literals::operator""s;

TEST(SessionTest, TwoSitesAgreeInOneRoundTripAndAHalf) {
  Town town;
  town.up.outcome = after(20ms);
  town.down.outcome = after(20ms);
  town.run(41ms);
  EXPECT_EQ(town.surgeon->established.size(), 1U);
  EXPECT_EQ(town.patient->established.size(), 0U);
  town.run(20ms);
  EXPECT_EQ(town.patient->established.size(), 1U);
  town.expect_one_session();
  EXPECT_EQ(town.surgeon->established[0].peer_git, "abc");
}

TEST(SessionTest, AsksAgainEverMoreSlowlyUpToASecond) {
  Town town;
  std::vector<std::int64_t> asked;
  town.up.outcome = [&](std::uint64_t, const Bytes&) {
    asked.push_back(
        std::chrono::duration_cast<std::chrono::milliseconds>(town.now.time_since_epoch()).count());
    return std::vector<Release>{};
  };
  town.run(6s);
  EXPECT_EQ(asked,
            (std::vector<std::int64_t>{0, 100, 250, 475, 813, 1320, 2080, 3080, 4080, 5080}));
}

TEST(SessionTest, QuietWhileTheLinkWorks) {
  Town town;
  town.run(1s);
  town.both(LinkState::Live);
  town.run(1ms);
  const std::uint64_t said = town.up.pushed() + town.down.pushed();
  town.run(10s);
  town.both(LinkState::Hold);
  town.run(10s);
  EXPECT_EQ(town.up.pushed() + town.down.pushed(), said);
  EXPECT_EQ(town.surgeon->established.size() + town.patient->established.size(), 2U);
}

RC_GTEST_PROP(SessionTest, ComesTogetherThroughAPathThatLosesAndRepeats, (std::uint64_t seed)) {
  Town town;
  const auto bad = [seed](std::uint64_t stream) -> PacketOutcome {
    return [=](std::uint64_t index, const Bytes& bytes) {
      std::vector<Release> releases;
      if (random_uniform(seed, stream, index) < 0.2) return releases;
      const Duration delay = from_seconds(0.05 + 0.3 * random_uniform(seed, stream + 1, index));
      releases.push_back({delay, bytes});
      if (random_uniform(seed, stream + 2, index) < 0.2) releases.push_back({3 * delay, bytes});
      return releases;
    };
  };
  town.up.outcome = bad(1);
  town.down.outcome = bad(11);
  town.run(60s);
  RC_ASSERT(town.surgeon->session.established());
  RC_ASSERT(town.surgeon->session.session_id() == town.patient->session.session_id());
  // No id pair served twice.
  std::set<std::uint64_t> ids;
  for (const Established& event : town.surgeon->established) {
    RC_ASSERT(ids.insert(event.session_id).second);
  }
}

TEST(SessionTest, ARestartedPatientIsANewSession) {
  Town town;
  town.run(1s);
  const Established first = town.surgeon->established.back();
  town.both(LinkState::Live);
  town.run(1s);
  town.start_patient(3);
  town.run(200ms);
  EXPECT_EQ(town.surgeon->established.size(), 1U);  // nothing before the watchdog says so
  town.surgeon->state = LinkState::Lost;
  town.run(1s);
  ASSERT_EQ(town.surgeon->established.size(), 2U);
  town.expect_one_session();
  const Established& second = town.surgeon->established.back();
  EXPECT_NE(second.session_id, first.session_id);
  EXPECT_NE(second.send_connection, first.send_connection);
  EXPECT_NE(second.receive_connection, first.receive_connection);
}

TEST(SessionTest, ARestartedSurgeonIsANewSessionOnceTheOldLinkIsLost) {
  Town town;
  town.run(1s);
  town.both(LinkState::Live);
  const Established first = town.patient->established.back();
  town.start_surgeon(4);
  town.run(1s);
  EXPECT_EQ(town.patient->established.size(), 1U);
  ASSERT_EQ(town.surgeon->refused.size(), 1U);  // told once, asks on
  EXPECT_FALSE(town.surgeon->refused[0].final);
  EXPECT_EQ(town.surgeon->refused[0].text, "the patient site is busy with another surgeon site");
  town.patient->state = LinkState::Lost;
  town.run(2s);
  town.expect_one_session();
  EXPECT_NE(town.patient->established.back().session_id, first.session_id);
  EXPECT_NE(town.patient->established.back().receive_connection, first.receive_connection);
}

TEST(SessionTest, ALinkThatComesBackKeepsItsSession) {
  Town town;
  town.run(1s);
  town.both(LinkState::Live);
  town.run(1s);
  town.both(LinkState::Lost);
  town.run(5s);
  town.both(LinkState::Live);
  town.run(1s);
  EXPECT_EQ(town.surgeon->established.size(), 1U);
  EXPECT_EQ(town.patient->established.size(), 1U);
}

TEST(SessionTest, AfterALongGapBothFindANewSession) {
  Town town;
  town.run(1s);
  const std::uint64_t first = town.surgeon->session.session_id();
  town.both(LinkState::Lost);
  town.run(1s);
  town.patient->link_session = 0;  // its Link ended first
  town.patient->state = LinkState::Down;
  town.run(2s);
  EXPECT_EQ(town.patient->closed.size(), 1U);
  town.expect_one_session();
  EXPECT_NE(town.surgeon->session.session_id(), first);

  town.both(LinkState::Live);
  town.run(1s);
  const std::uint64_t second = town.surgeon->session.session_id();
  for (Party* party : {town.surgeon.get(), town.patient.get()}) {  // both at once
    party->link_session = 0;
    party->state = LinkState::Down;
  }
  town.run(2s);
  town.expect_one_session();
  EXPECT_NE(town.surgeon->session.session_id(), second);
}

TEST(SessionTest, WhatTheLinkSaysOfAnotherSessionDoesNotCount) {
  Town town;
  town.run(50ms);
  ASSERT_TRUE(town.surgeon->session.established());
  const std::uint64_t asked = town.up.pushed();
  town.surgeon->link_session = 12345;  // a word from before the link update
  town.surgeon->state = LinkState::Live;
  town.run(5s);
  EXPECT_TRUE(town.surgeon->session.established());
  EXPECT_GT(town.up.pushed(), asked);  // it asks on although some link is said to be Live
}

TEST(SessionTest, ByeIsSaidThreeTimesAndClosesTheOther) {
  Town town;
  town.run(1s);
  town.both(LinkState::Live);
  const SessionOutput bye = town.patient->session.close("the patient site shuts down");
  EXPECT_EQ(bye.datagrams.size(), 3U);
  town.patient->take(bye, town.now);
  town.run(10ms);
  ASSERT_EQ(town.surgeon->closed.size(), 1U);
  EXPECT_EQ(town.surgeon->closed[0].text,
            "the peer ended the session: the patient site shuts down");
  EXPECT_EQ(town.surgeon->session.counters().foreign, 2U);
  EXPECT_FALSE(town.surgeon->session.established());
  EXPECT_FALSE(town.patient->session.established());
  // One who left stays away; one who was left finds the next.
  town.run(2s);
  EXPECT_EQ(town.patient->established.size(), 1U);
  town.start_patient(5);
  town.run(2s);
  town.expect_one_session();
  EXPECT_EQ(town.surgeon->established.size(), 2U);
}

TEST(SessionTest, BeforeTheLinkUpdateIsDoneTheSessionIsNotTakenForEnded) {
  Town town;
  town.surgeon->hands_over = false;
  town.run(50ms);
  EXPECT_TRUE(town.surgeon->session.established());
  EXPECT_TRUE(town.surgeon->closed.empty());
}

}  // namespace
}  // namespace palp::link
