// What strangers, liars and other versions can do to a Session.
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/core/random.h"
#include "tests/common/link/session_town.h"

namespace palp::link {
namespace {

using std::chrono_literals::operator""s;

TEST(SessionStrangersTest, ASecondSurgeonIsRefusedWhileTheLinkHolds) {
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

TEST(SessionStrangersTest, EverNewIdsOfRefusedSurgeonsDoNotFillTheLog) {
  Town town;
  int told = 0;
  for (std::uint64_t id = 1; id <= 30'000; ++id) {
    Hello hello;
    hello.role = Role::Surgeon;
    hello.session_id = id;
    hello.coupling = "another";
    const Bytes bytes = datagram_of(PacketType::Control, encode(hello));
    town.now += 1ms;
    told += town.patient->session.on_datagram(bytes, town.now).event ? 1 : 0;
  }
  EXPECT_GE(told, 1);
  EXPECT_LE(told, 4) << "in 30 s";
}

TEST(SessionStrangersTest, ByeOfAStrangerEndsNothing) {
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

TEST(SessionStrangersTest, SitesThatDifferRefuseEachOtherInOneSentence) {
  struct Case {
    SessionConfig surgeon;
    SessionConfig patient;
    std::string text;
  };
  std::vector<Case> cases(4, {config_of(Role::Surgeon), config_of(Role::Patient), {}});
  cases[0].patient.protocol_version = kProtocolVersion + 1;
  cases[0].text = "the sites speak different protocol versions: surgeon " +
                  std::to_string(kProtocolVersion) + ", patient " +
                  std::to_string(kProtocolVersion + 1);
  cases[1].surgeon.coupling = "wave";
  cases[1].text = "the sites use different couplings: surgeon wave, patient direct";
  cases[2].surgeon.settings_hash = 0xAB;
  cases[2].text =
      "the settings of the coupling or the control periods differ, by hash: surgeon "
      "00000000000000ab, "
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

TEST(SessionStrangersTest, DevicesThatCannotBeAreRefusedInOneSentence) {
  struct Case {
    DeviceFacts patient;
    std::string text;
  };
  const DeviceFacts sound{.hand = {}, .stage = StageFacts{}, .sensor = ForceSensorFacts{}};
  std::vector<Case> cases(4, {sound, {}});
  cases[0].patient.stage.reset();
  cases[0].text = "the patient's hello is malformed: it tells of no stage";
  cases[1].patient.sensor.reset();
  cases[1].text = "the patient's hello is malformed: it tells of no force sensor";
  cases[2].patient.stage->speed = -1;
  cases[2].text =
      "the patient's hello is malformed: the stage's speed of -1 m/s is not above 0 and at most "
      "100 m/s";
  cases[3].patient.sensor->pole = std::nan("");
  cases[3].text =
      "the patient's hello is malformed: the force sensor's pole of nan Hz is not 0.1 to 1e+05 Hz";
  for (const Case& one : cases) {
    SessionConfig patient = config_of(Role::Patient);
    patient.devices = one.patient;
    Town town{config_of(Role::Surgeon), patient};
    town.run(1s);
    EXPECT_TRUE(town.surgeon->established.empty());
    ASSERT_FALSE(town.surgeon->refused.empty());
    EXPECT_EQ(town.surgeon->refused[0].text, one.text);
  }
}

TEST(SessionStrangersTest, EachSiteLearnsTheDevicesOfTheOther) {
  SessionConfig surgeon = config_of(Role::Surgeon);
  surgeon.devices = {.hand = HandFacts{.force_peak = 3}, .stage = {}, .sensor = {}};
  SessionConfig patient = config_of(Role::Patient);
  patient.devices.stage->lag = 0.03;
  Town town{surgeon, patient};
  town.run(1s);
  ASSERT_EQ(town.surgeon->established.size(), 1U);
  ASSERT_EQ(town.patient->established.size(), 1U);
  EXPECT_EQ(town.surgeon->established[0].peer_devices.stage->lag, 0.03);
  EXPECT_EQ(town.patient->established[0].peer_devices.hand->force_peak, 3);
  EXPECT_FALSE(town.patient->established[0].peer_devices.stage);
}

TEST(SessionStrangersTest, APatientDoesNotAnswerAPatient) {
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

TEST(SessionStrangersTest, AMirrorIsNotTakenForAPeer) {
  Town town;
  std::vector<Bytes> answers;
  town.down.outcome = [&](std::uint64_t, const Bytes& bytes) {
    answers.push_back(bytes);
    return std::vector<Release>{{Duration{0}, bytes}};
  };
  town.run(100ms);
  ASSERT_FALSE(answers.empty());
  const auto out = town.patient->session.on_datagram(answers.back(), town.now);
  EXPECT_FALSE(out.event);
  EXPECT_TRUE(out.datagrams.empty());
}

TEST(SessionStrangersTest, AnotherPatientDoesNotDisturbASurgeonWhoseLinkWorks) {
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

TEST(SessionStrangersTest, AReplayOfAWholeSessionStartsNothing) {
  Town town;
  std::vector<Bytes> said;
  town.up.outcome = [&](std::uint64_t, const Bytes& bytes) {
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

TEST(SessionStrangersTest, AStrangerLeavesNoTrace) {
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

RC_GTEST_PROP(SessionStrangersTest, SurvivesSpoiledDatagrams, (std::uint64_t seed)) {
  Town town;
  const auto spoil = [seed](std::uint64_t stream) -> PacketOutcome {
    return [=](std::uint64_t index, const Bytes& bytes) {
      Bytes spoiled = bytes;
      const std::uint64_t place = random_bits(seed, stream, index);
      spoiled[place / 8 % bytes.size()] ^= static_cast<std::byte>(1U << place % 8);
      if (place % 7 == 0) spoiled.resize(place % bytes.size());
      return std::vector<Release>{{Duration{1ms}, place % 3 == 0 ? bytes : spoiled},
                                  {Duration{2ms}, spoiled}};
    };
  };
  town.up.outcome = spoil(1);
  town.down.outcome = spoil(2);
  town.run(5s);
  (void)town.surgeon->session.close("enough");
}

RC_GTEST_PROP(SessionStrangersTest, SurvivesRandomBytes, (const std::vector<std::uint8_t>& junk)) {
  Session session{config_of(Role::Patient), 1};
  RC_ASSERT(!session.on_datagram(std::as_bytes(std::span{junk}), TimePoint{}).event);
}

}  // namespace
}  // namespace palp::link
