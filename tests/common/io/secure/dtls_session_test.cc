// Goal: what strangers, liars and a bad network can do to a session under keys.
// Method: both sessions in one thread and virtual time, letters passed by hand; a real
// handshake with real certificates at the beginning of each test.
#include "common/io/secure/dtls_session.h"

#include <algorithm>
#include <deque>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/core/random.h"
#include "common/link/codec_wire.h"
#include "common/link/link.h"
#include "tests/common/io/net/loopback.h"
#include "tests/common/io/secure/keys_folder.h"
#include "tests/common/io/secure/secure_world.h"

namespace palp::io {
namespace {

using link::Role;
using std::chrono::milliseconds;
using std::chrono::seconds;
using test::kElsewhere;
using test::KeysFolder;
using test::kPatientAt;
using test::kSurgeonAt;
using test::session_of;
using test::Site;
using test::World;
using testing::HasSubstr;

TEST(DtlsSessionTest, SitesMeetUnderKeysAndSayByeUnderThem) {
  World world{"meet"};
  world.run(milliseconds{300});
  ASSERT_TRUE(world.live());
  EXPECT_EQ(world.surgeon->established.size(), 1U);
  EXPECT_EQ(world.surgeon->session_endpoint.proof(), "test patient site");
  EXPECT_EQ(world.patient->session_endpoint.proof(), "test surgeon site");
  world.surgeon->take(world.surgeon->session_endpoint.close("enough"), world.now);
  world.run(milliseconds{5});
  EXPECT_EQ(world.patient->closed, 1);
}

TEST(DtlsSessionTest, NewKeysCostNoTelegram) {
  World world{"rekey", seconds{4}};
  world.run(seconds{30});
  EXPECT_TRUE(world.live());
  EXPECT_GE(world.surgeon->rekeyed, 8) << "two link updates for each changeover";
  EXPECT_GE(world.patient->rekeyed, 8);
  for (const Site* site : {world.surgeon.get(), world.patient.get()}) {
    const LinkHealth health = site->link.health(world.now);
    EXPECT_EQ(health.lost + health.forged + health.replayed, 0U);
    EXPECT_EQ(site->established.size(), 1U) << "the same session all the time";
    EXPECT_GT(health.accepted, 29'000U);
  }
}

TEST(DtlsSessionTest, NewKeysComeAboutOverABadNetworkToo) {
  World world{"rekey-loss", seconds{4}};
  std::uint64_t index = 0;
  world.lose = [&] { return random_bits(3, 4, index++) % 5 == 0; };
  world.run(seconds{40});
  EXPECT_GE(world.patient->rekeyed, 2);
  world.lose = nullptr;
  world.run(seconds{5});
  EXPECT_TRUE(world.live());
  EXPECT_EQ(world.patient->established.size(), 1U);
}

TEST(DtlsSessionTest, ABlackoutOfTenSecondsKeepsTheSession) {
  World world{"blackout"};
  world.run(seconds{1});
  world.cut = true;
  world.run(seconds{10});
  EXPECT_EQ(world.state(*world.patient), LinkState::Lost);
  world.cut = false;
  world.run(milliseconds{100});
  EXPECT_TRUE(world.live());
  world.run(seconds{20});
  EXPECT_TRUE(world.live());
  EXPECT_EQ(world.patient->established.size(), 1U);
  EXPECT_EQ(world.patient->closed, 0);
}

TEST(DtlsSessionTest, ABlackoutThatEndsTheSessionIsFollowedByANewOneWithNewKeys) {
  World world{"long-blackout"};
  world.run(seconds{1});
  world.cut = true;
  world.run(seconds{40});
  world.cut = false;
  world.run(seconds{20});  // a call made in the dark first has to be given up
  EXPECT_TRUE(world.live());
  EXPECT_EQ(world.patient->established.size(), 2U);
}

TEST(DtlsSessionTest, ARestartedSiteIsANewSession) {
  for (const Role role : {Role::Surgeon, Role::Patient}) {
    World world{"restart"};
    world.run(seconds{1});
    world.start(role);
    world.run(seconds{6});
    EXPECT_TRUE(world.live());
    Site& other = role == Role::Surgeon ? *world.patient : *world.surgeon;
    EXPECT_EQ(other.established.size(), 2U);
  }
}

TEST(DtlsSessionTest, PlainHellosAndByesAreNotHeard) {
  World world{"plain"};
  world.run(seconds{1});
  link::Session liar{session_of(Role::Surgeon), 9};
  const auto hello = liar.tick(world.now, LinkState::Down, 0).datagrams.at(0);
  const auto& session = world.patient->established.at(0);
  const link::ControlBytes bye =
      encode(link::Bye{.session_id = session.peer_session_id,
                       .peer_session_id = world.surgeon->established.at(0).peer_session_id,
                       .reason = link::ByeReason::Leaving,
                       .text = "trust me"});
  std::vector<std::byte> close(link::kHeaderSize + bye.size);
  link::PlainProtection{}.seal({.type = link::PacketType::Close}, bye.view(), close);
  for (const auto datagram : {hello.view(), std::span<const std::byte>{close}}) {
    const auto out = world.patient->session_endpoint.hear(datagram, kSurgeonAt, world.now);
    EXPECT_FALSE(out.event);
    EXPECT_TRUE(out.letters.empty());
  }
  world.run(seconds{1});
  EXPECT_TRUE(world.live());
}

TEST(DtlsSessionTest, AForgedAlertEndsNothing) {
  World world{"alert"};
  world.run(seconds{1});
  for (const unsigned epoch : {0U, 1U}) {
    test::Bytes alert = test::bytes_of(21, 15);  // fatal, handshake failure
    const std::array<std::uint8_t, 15> bytes{
        21, 254, 253, 0, static_cast<std::uint8_t>(epoch), 0, 0, 0, 0, 0, 9, 0, 2, 2, 40};
    std::ranges::copy(std::as_bytes(std::span{bytes}), alert.begin());
    (void)world.patient->session_endpoint.hear(alert, kSurgeonAt, world.now);
    (void)world.surgeon->session_endpoint.hear(alert, kPatientAt, world.now);
  }
  world.run(seconds{1});
  EXPECT_TRUE(world.live());
  EXPECT_EQ(world.patient->established.size(), 1U);
}

TEST(DtlsSessionTest, ARecordedSessionPlayedAgainChangesNothing) {
  World world{"replay"};
  world.run(seconds{1});
  const auto control = world.control;
  for (const auto& bytes : control) {
    for (Site* site : {world.surgeon.get(), world.patient.get()}) {
      const Endpoint& from = site->at == kSurgeonAt ? kPatientAt : kSurgeonAt;
      auto out = site->session_endpoint.hear(bytes, from, world.now);
      EXPECT_FALSE(out.event);
      EXPECT_FALSE(out.protection);
      EXPECT_TRUE(out.letters.empty() || looks_like_dtls(bytes)) << "it was answered once";
      site->take(std::move(out), world.now);
    }
  }
  world.run(seconds{1});
  EXPECT_TRUE(world.live());
  EXPECT_EQ(world.patient->established.size(), 1U);
}

TEST(DtlsSessionTest, ASecondSurgeonWithAGoodCertificateIsToldThatThePatientIsBusy) {
  World world{"second"};
  world.run(seconds{1});
  Site second{Role::Surgeon, *world.surgeon_credentials, std::chrono::hours{1}, 9};
  for (int i = 0; i < 300; ++i, world.now += milliseconds{1}) {
    second.take(second.session_endpoint.tick(world.now, {}), world.now);
    for (Letter& letter : std::exchange(second.letters, {})) {
      auto out = world.patient->session_endpoint.hear(letter.bytes, kElsewhere, world.now);
      EXPECT_FALSE(out.protection);
      for (Letter& answer : out.letters) {
        if (!(answer.to == kElsewhere)) continue;
        second.take(second.session_endpoint.hear(answer.bytes, kPatientAt, world.now), world.now);
      }
    }
    world.surgeon->tick(world.now);
    world.patient->tick(world.now);
    world.pass(*world.surgeon, *world.patient, kSurgeonAt);
    world.pass(*world.patient, *world.surgeon, kPatientAt);
  }
  EXPECT_TRUE(world.live());
  EXPECT_TRUE(second.established.empty());
  ASSERT_FALSE(second.refused.empty());
  EXPECT_THAT(second.refused[0], HasSubstr("busy"));
}

TEST(FailureTest, AForeignCertificateIsToldOnceAndNotForEachAttempt) {
  World world{"told"};
  const KeysFolder foreign{"told-foreign"};
  const auto credentials = foreign.credentials(Role::Surgeon);
  world.surgeon = std::make_unique<Site>(Role::Surgeon, *credentials, std::chrono::hours{1}, 9);
  world.run(seconds{12});
  EXPECT_TRUE(world.patient->established.empty());
  ASSERT_FALSE(world.patient->refused.empty());
  EXPECT_THAT(world.patient->refused[0], HasSubstr("127.0.0.1:1000"));
  EXPECT_LE(world.patient->refused.size(), 3U);
  EXPECT_THAT(world.surgeon->refused.at(0), HasSubstr("certificate"));
}

}  // namespace
}  // namespace palp::io
