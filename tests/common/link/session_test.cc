#include "common/link/session.h"

#include <set>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/core/random.h"
#include "common/link/packet_protection.h"
#include "tests/common/link/test_pipe.h"

namespace palp::link {
namespace {

using std::chrono_literals::operator""s;
using std::chrono_literals::operator""ms;

SessionConfig config_of(Role role) {
  return {.role = role, .settings_hash = 77, .coupling = "direct", .git = "abc"};
}

/// A Session, what its Link is said to be, and what it told.
struct Party {
  Session session;
  LinkState state{LinkState::Down};
  std::uint64_t link_session{};
  std::vector<Established> established;
  std::vector<Refused> refused;
  std::vector<Closed> closed;
  Lane* out{};
  bool hands_over{true};  ///< false: its Link has not heard of the session yet

  Party(const SessionConfig& config, std::uint64_t entropy) : session{config, entropy} {}

  void take(const SessionOutput& output, TimePoint now) {
    for (const ControlBytes& datagram : output.datagrams) out->push(datagram.view(), now);
    if (!output.event) return;
    if (const auto* event = std::get_if<Established>(&*output.event)) {
      established.push_back(*event);
      if (hands_over) link_session = event->session_id;  // as io does with the Link
      state = LinkState::Down;
    } else if (const auto* refusal = std::get_if<Refused>(&*output.event)) {
      refused.push_back(*refusal);
    } else {
      closed.push_back(std::get<Closed>(*output.event));
      link_session = 0;
      state = LinkState::Down;
    }
  }
};

/// One patient, surgeons that come and go; each surgeon has its own way to the patient.
class Town {
 public:
  TimePoint now{};
  Lane up;
  Lane down;
  std::unique_ptr<Party> surgeon;
  std::unique_ptr<Party> patient;

  explicit Town(const SessionConfig& surgeon_config = config_of(Role::Surgeon),
                const SessionConfig& patient_config = config_of(Role::Patient)) {
    start_surgeon(1, surgeon_config);
    start_patient(2, patient_config);
  }
  void start_surgeon(std::uint64_t entropy,
                     const SessionConfig& config = config_of(Role::Surgeon)) {
    surgeon = std::make_unique<Party>(config, entropy);
    surgeon->out = &up;
  }
  void start_patient(std::uint64_t entropy,
                     const SessionConfig& config = config_of(Role::Patient)) {
    patient = std::make_unique<Party>(config, entropy);
    patient->out = &down;
  }

  void run(Duration span) {
    for (const TimePoint end = now + span; now < end; now += 1ms) {
      if (patient) {
        while (auto datagram = up.pop(now)) {
          patient->take(patient->session.on_datagram(datagram->second, now), now);
        }
        patient->take(patient->session.tick(now, patient->state, patient->link_session), now);
      }
      if (surgeon) {
        while (auto datagram = down.pop(now)) {
          surgeon->take(surgeon->session.on_datagram(datagram->second, now), now);
        }
        surgeon->take(surgeon->session.tick(now, surgeon->state, surgeon->link_session), now);
      }
    }
  }
  /// As the Links would after their exchanges.
  void both(LinkState state) {
    if (surgeon->session.established()) surgeon->state = state;
    if (patient->session.established()) patient->state = state;
  }
  void expect_one_session() const {
    ASSERT_FALSE(surgeon->established.empty());
    ASSERT_FALSE(patient->established.empty());
    const Established& s = surgeon->established.back();
    const Established& p = patient->established.back();
    EXPECT_EQ(s.session_id, p.session_id);
    EXPECT_EQ(s.send_connection, p.receive_connection);
    EXPECT_EQ(p.send_connection, s.receive_connection);
    EXPECT_NE(s.send_connection, s.receive_connection);
    EXPECT_NE(s.session_id, 0U);
    EXPECT_NE(s.send_connection, 0U);
    EXPECT_NE(s.receive_connection, 0U);
  }
};

TEST(SessionTest, TwoSitesAgreeInOneRoundTripAndAHalf) {
  Town town;
  town.up.fate = after(20ms);
  town.down.fate = after(20ms);
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
  town.up.fate = [&](std::uint64_t, const Bytes&) {
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
  const auto bad = [seed](std::uint64_t stream) -> Fate {
    return [=](std::uint64_t index, const Bytes& bytes) {
      std::vector<Release> releases;
      if (random_uniform(seed, stream, index) < 0.2) return releases;
      const Duration delay = from_seconds(0.05 + 0.3 * random_uniform(seed, stream + 1, index));
      releases.push_back({delay, bytes});
      if (random_uniform(seed, stream + 2, index) < 0.2) releases.push_back({3 * delay, bytes});
      return releases;
    };
  };
  town.up.fate = bad(1);
  town.down.fate = bad(11);
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

TEST(SessionTest, ASecondSurgeonIsRefusedWhileTheLinkHolds) {
  for (const LinkState state : {LinkState::Live, LinkState::Hold}) {
    Town town;
    town.run(1s);
    town.both(state);
    town.run(1ms);
    Session second{config_of(Role::Surgeon), 9};
    const auto hello = second.tick(town.now, LinkState::Down, 0);
    const auto answer = town.patient->session.on_datagram(hello.datagrams.at(0).view(), town.now);
    ASSERT_EQ(answer.datagrams.size(), 1U);
    ASSERT_TRUE(answer.event);
    EXPECT_TRUE(std::holds_alternative<Refused>(*answer.event));
    const auto heard = second.on_datagram(answer.datagrams[0].view(), town.now);
    EXPECT_FALSE(std::get<Refused>(heard.event.value()).final);
    EXPECT_TRUE(town.patient->session.established());

    const auto again = second.tick(town.now + 2s, LinkState::Down, 0);
    const auto same = town.patient->session.on_datagram(again.datagrams.at(0).view(), town.now);
    EXPECT_EQ(same.datagrams.size(), 1U);
    EXPECT_FALSE(same.event);  // people were told
  }
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
  town.surgeon->link_session = 12345;  // a word from before the handover
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

Bytes datagram_of(PacketType type, const ControlBytes& message) {
  Bytes bytes(kControlSizeMax + kHeaderSize);
  bytes.resize(PlainProtection{}.seal({.type = type}, message.view(), bytes));
  return bytes;
}

TEST(SessionTest, ByeOfAStrangerEndsNothing) {
  Town town;
  town.run(1s);
  town.both(LinkState::Live);
  town.run(1ms);
  const Established& session = town.surgeon->established.back();
  for (const Bye& bye :
       {Bye{session.peer_session_id, 0, ByeReason::Leaving, ""},
        Bye{session.peer_session_id, 12345, ByeReason::Mismatch, ""},
        Bye{12345, town.patient->established.back().peer_session_id, ByeReason::Busy, ""},
        Bye{12345, 67890, ByeReason::Leaving, ""}}) {
    const Bytes bytes = datagram_of(PacketType::Close, encode(bye));
    EXPECT_FALSE(town.surgeon->session.on_datagram(bytes, town.now).event);
  }
  EXPECT_TRUE(town.surgeon->session.established());
}

TEST(SessionTest, SitesThatDifferRefuseEachOtherInOneSentence) {
  struct Case {
    SessionConfig surgeon;
    SessionConfig patient;
    std::string text;
  };
  std::vector<Case> cases(4, {config_of(Role::Surgeon), config_of(Role::Patient), {}});
  cases[0].patient.protocol_version = 2;
  cases[0].text = "the sites speak different protocol versions: surgeon 1, patient 2";
  cases[1].surgeon.coupling = "wave";
  cases[1].text = "the sites use different couplings: surgeon wave, patient direct";
  cases[2].surgeon.settings_hash = 0xAB;
  cases[2].text =
      "the settings that both sites must share differ, by hash: surgeon 00000000000000ab, "
      "patient 000000000000004d";
  cases[3].patient = config_of(Role::Surgeon);
  cases[3].patient.git = "other";
  cases[3].text = "";
  for (const Case& one : cases) {
    Town town{one.surgeon, one.patient};
    town.run(3s);
    EXPECT_TRUE(town.surgeon->established.empty());
    EXPECT_TRUE(town.patient->established.empty());
    if (one.text.empty()) continue;  // two surgeons ask past each other, for ever
    ASSERT_EQ(town.surgeon->refused.size(), 1U);
    ASSERT_EQ(town.patient->refused.size(), 1U);
    EXPECT_EQ(town.surgeon->refused[0].text, one.text);
    EXPECT_EQ(town.patient->refused[0].text, one.text);
    EXPECT_TRUE(town.surgeon->refused[0].final);
    EXPECT_FALSE(town.patient->refused[0].final);
    // The patient waits for another surgeon.
    town.start_surgeon(6, [&] {
      SessionConfig good = one.patient;
      good.role = Role::Surgeon;
      return good;
    }());
    town.run(1s);
    EXPECT_EQ(town.patient->established.size(), 1U);
  }
}

TEST(SessionTest, APatientDoesNotAnswerAPatient) {
  Session one{config_of(Role::Patient), 1};
  Session two{config_of(Role::Surgeon), 2};
  Hello stray;
  stray.role = Role::Patient;
  stray.session_id = 5;
  stray.settings_hash = 77;
  stray.coupling = "direct";
  const Bytes hello = datagram_of(PacketType::Control, encode(stray));
  const auto out = one.on_datagram(hello, TimePoint{});
  EXPECT_EQ(std::get<Refused>(out.event.value()).text, "both sites are patient sites");
  // And nobody talks to himself through a mirror.
  const auto own = two.tick(TimePoint{}, LinkState::Down, 0);
  const auto mirrored = two.on_datagram(own.datagrams.at(0).view(), TimePoint{});
  EXPECT_FALSE(mirrored.event);
  EXPECT_TRUE(mirrored.datagrams.empty());
}

TEST(SessionTest, AMirrorIsNotTakenForAPeer) {
  Town town;
  std::vector<Bytes> answers;
  town.down.fate = [&](std::uint64_t, const Bytes& bytes) {
    answers.push_back(bytes);
    return std::vector<Release>{{Duration{0}, bytes}};
  };
  town.run(100ms);
  ASSERT_FALSE(answers.empty());
  const auto out = town.patient->session.on_datagram(answers.back(), town.now);
  EXPECT_FALSE(out.event);
  EXPECT_TRUE(out.datagrams.empty());
}

TEST(SessionTest, BeforeTheHandoverIsDoneTheSessionIsNotTakenForEnded) {
  Town town;
  town.surgeon->hands_over = false;
  town.run(50ms);
  EXPECT_TRUE(town.surgeon->session.established());
  EXPECT_TRUE(town.surgeon->closed.empty());
}

TEST(SessionTest, AnotherPatientDoesNotDisturbASurgeonWhoseLinkWorks) {
  Town town;
  town.run(1s);
  const ControlBytes question =
      town.surgeon->session.tick(town.now + 2s, LinkState::Lost, town.surgeon->link_session)
          .datagrams.at(0);
  Session other{config_of(Role::Patient), 8};
  const auto answer = other.on_datagram(question.view(), town.now);
  ASSERT_EQ(answer.datagrams.size(), 1U);
  for (const LinkState state : {LinkState::Live, LinkState::Hold, LinkState::Lost}) {
    town.surgeon->state = state;
    town.run(1ms);
    const auto out = town.surgeon->session.on_datagram(answer.datagrams[0].view(), town.now);
    EXPECT_FALSE(out.event);
    EXPECT_EQ(out.datagrams.size(), state == LinkState::Lost ? 1U : 0U);  // offers a new session
  }
}

TEST(SessionTest, AReplayOfAWholeConversationStartsNothing) {
  Town town;
  std::vector<Bytes> said;
  town.up.fate = [&](std::uint64_t, const Bytes& bytes) {
    said.push_back(bytes);
    return std::vector<Release>{{Duration{0}, bytes}};
  };
  town.run(1s);
  town.both(LinkState::Lost);
  town.run(1s);
  town.patient->link_session = 0;
  town.patient->state = LinkState::Down;
  town.surgeon.reset();
  town.run(1s);
  ASSERT_FALSE(town.patient->session.established());
  const std::size_t before = town.patient->established.size();
  for (const Bytes& bytes : said) {
    EXPECT_FALSE(town.patient->session.on_datagram(bytes, town.now).event);
  }
  EXPECT_EQ(town.patient->established.size(), before);
}

TEST(SessionTest, AStrangerLeavesNoTrace) {
  Town town;
  Session stranger{config_of(Role::Surgeon), 50};
  const auto hello = stranger.tick(town.now, LinkState::Down, 0);
  for (int i = 0; i < 100; ++i) {
    const auto answer = town.patient->session.on_datagram(hello.datagrams.at(0).view(), town.now);
    EXPECT_EQ(answer.datagrams.size(), 1U);
    EXPECT_LE(answer.datagrams[0].size, hello.datagrams[0].size);
    EXPECT_FALSE(answer.event);
  }
  town.run(100ms);
  town.expect_one_session();
}

RC_GTEST_PROP(SessionTest, SurvivesSpoiledDatagrams, (std::uint64_t seed)) {
  Town town;
  const auto spoil = [seed](std::uint64_t stream) -> Fate {
    return [=](std::uint64_t index, const Bytes& bytes) {
      Bytes spoiled = bytes;
      const std::uint64_t place = random_bits(seed, stream, index);
      spoiled[place / 8 % bytes.size()] ^= static_cast<std::byte>(1U << place % 8);
      if (place % 7 == 0) spoiled.resize(place % bytes.size());
      return std::vector<Release>{{Duration{1ms}, place % 3 == 0 ? bytes : spoiled},
                                  {Duration{2ms}, spoiled}};
    };
  };
  town.up.fate = spoil(1);
  town.down.fate = spoil(2);
  town.run(5s);
  (void)town.surgeon->session.close("enough");
}

RC_GTEST_PROP(SessionTest, SurvivesRandomBytes, (const std::vector<std::uint8_t>& junk)) {
  Session session{config_of(Role::Patient), 1};
  RC_ASSERT(!session.on_datagram(std::as_bytes(std::span{junk}), TimePoint{}).event);
}

}  // namespace
}  // namespace palp::link
