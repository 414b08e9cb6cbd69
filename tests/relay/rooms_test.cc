// Goal: a relay leads two sites together, follows them, and nobody else gets anything of it.
// Method: its rooms without sockets, in virtual time; the sites' halves are the real ones.
#include "relay/rooms.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/io/secure/relay_member.h"

namespace palp::relay {
namespace {

using io::Endpoint;
using io::RelayMember;
using io::RelayMessage;
using link::Role;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr char kName[] = "K7Q2-a-long-name";

Endpoint at(const std::string& text) { return io::resolve_endpoint(text).value(); }

const Endpoint kRelay = at("198.51.100.9:9100");
const Endpoint kSurgeon = at("198.51.100.1:4000");
const Endpoint kPatient = at("198.51.100.2:5000");
const std::vector<std::byte> kTelegram(200, std::byte{0x80});

/// A site behind an address, and what its talk with the relay was.
struct Visitor {
  Visitor(Role role, Endpoint address, const std::string& name = kName)
      : from{address}, member{io::RoomKey::from_name(name).value(), role, kRelay, 11} {}

  /// Asks, shows the cookie, hears the answer; keeps the Join it sent.
  void enter(Rooms& rooms, TimePoint now) {
    const auto ask = member.tick(now, RelayMember::SessionIs::Silent);
    ASSERT_TRUE(ask);
    const auto cookie = rooms.hear(*ask, from, now);
    ASSERT_TRUE(cookie);
    ASSERT_EQ(cookie->to, from);
    const auto said = member.hear(cookie->bytes, kRelay, now);
    ASSERT_TRUE(said);
    join = *said;
    const auto answer = rooms.hear(join, from, now);
    if (answer) (void)member.hear(answer->bytes, kRelay, now);
    last = answer ? RelayMessage::parse(answer->bytes) : std::nullopt;
  }

  Endpoint from;
  RelayMember member;
  RelayMessage::Bytes join{};
  std::optional<RelayMessage> last;
};

class RoomsTest : public testing::Test {
 protected:
  [[nodiscard]] std::optional<Endpoint> way(const Endpoint& from) {
    const auto out = rooms_.hear(kTelegram, from, now_);
    if (!out) return std::nullopt;
    EXPECT_TRUE(std::ranges::equal(out->bytes, kTelegram)) << "forwarded unchanged";
    return out->to;
  }
  void pass(Duration span) { now_ += span; }
  void meet() {
    surgeon_.enter(rooms_, now_);
    patient_.enter(rooms_, now_);
  }

  Rooms rooms_;
  TimePoint now_{seconds{1000}};
  Visitor surgeon_{Role::Surgeon, kSurgeon};
  Visitor patient_{Role::Patient, kPatient};
};

TEST_F(RoomsTest, TwoSitesOfARoomReachEachOther) {
  EXPECT_EQ(way(kSurgeon), std::nullopt);
  meet();
  EXPECT_EQ(way(kSurgeon), kPatient);
  EXPECT_EQ(way(kPatient), kSurgeon);
  ASSERT_TRUE(patient_.last);
  EXPECT_EQ(patient_.last->kind, RelayMessage::Kind::Joined);
  EXPECT_EQ(patient_.last->detail, 1);
  EXPECT_EQ(surgeon_.last->detail, 0) << "was alone when it came";
}

TEST_F(RoomsTest, WhoHasFallenSilentIsNotSaidToBeThereButKeepsItsSeat) {
  meet();
  pass(Rooms::kPresentMax);
  surgeon_.enter(rooms_, now_);
  EXPECT_EQ(surgeon_.last->detail, 1);
  pass(RelayMember::kAskEveryInNeed);
  surgeon_.enter(rooms_, now_);
  EXPECT_EQ(surgeon_.last->detail, 0) << "the patient's site has left";
  EXPECT_EQ(way(kSurgeon), kPatient) << "or its network pauses";
  (void)way(kPatient);
  pass(RelayMember::kAskEveryInNeed);
  surgeon_.enter(rooms_, now_);
  EXPECT_EQ(surgeon_.last->detail, 1) << "it is heard again";
}

TEST_F(RoomsTest, AnotherNameIsAnotherRoom) {
  Visitor other{Role::Patient, kPatient, "K7Q2-another-name"};
  surgeon_.enter(rooms_, now_);
  other.enter(rooms_, now_);
  EXPECT_EQ(way(kSurgeon), std::nullopt);
}

TEST_F(RoomsTest, NothingIsKeptOfWhoOnlyAsks) {
  for (int i = 0; i < 1000; ++i) {
    const RelayMessage ask{.kind = RelayMessage::Kind::Ask};
    const auto bytes = ask.bytes();
    const auto answer = rooms_.hear(bytes, at("198.51.100.7:" + std::to_string(1 + i)), now_);
    ASSERT_TRUE(answer);
    EXPECT_LE(answer->bytes.size(), bytes.size()) << "amplification";
  }
  EXPECT_EQ(rooms_.rooms(), 0U);
}

TEST_F(RoomsTest, ASiteThatMovesIsFollowedAndItsOldJoinBringsNobodyBack) {
  meet();
  const RelayMessage::Bytes old = surgeon_.join;
  const Endpoint elsewhere = at("198.51.100.1:4999");
  pass(seconds{1});
  surgeon_.from = elsewhere;
  surgeon_.enter(rooms_, now_);
  EXPECT_EQ(way(kPatient), elsewhere);
  EXPECT_EQ(way(kSurgeon), std::nullopt) << "the seat is one";
  (void)rooms_.hear(old, kSurgeon, now_);
  EXPECT_EQ(way(kPatient), elsewhere);
  EXPECT_EQ(rooms_.counts().stale, 1U);
}

TEST_F(RoomsTest, AJoinFromAnotherAddressMovesNobody) {
  meet();
  const Endpoint thief = at("203.0.113.66:6666");
  EXPECT_EQ(rooms_.hear(surgeon_.join, thief, now_), std::nullopt);
  EXPECT_EQ(way(kPatient), kSurgeon);
  EXPECT_EQ(way(thief), std::nullopt);
  EXPECT_EQ(rooms_.counts().forged, 1U);
}

TEST_F(RoomsTest, ACookieWithoutTheRoomsKeyMovesNobody) {
  meet();
  const Endpoint thief = at("203.0.113.66:6666");
  pass(milliseconds{1});
  RelayMessage ask{.kind = RelayMessage::Kind::Ask,
                   .role = Role::Surgeon,
                   .room = RelayMessage::parse(surgeon_.join)->room};
  const auto asked = ask.bytes();
  const auto cookie = rooms_.hear(asked, thief, now_);
  ASSERT_TRUE(cookie);
  RelayMessage forged = *RelayMessage::parse(cookie->bytes);
  forged.kind = RelayMessage::Kind::Join;
  forged.proof = RelayMessage::parse(surgeon_.join)->proof;
  pass(milliseconds{1});
  EXPECT_EQ(rooms_.hear(forged.bytes(), thief, now_), std::nullopt);
  EXPECT_EQ(way(kPatient), kSurgeon);
  EXPECT_EQ(rooms_.counts().forged, 1U);
}

TEST_F(RoomsTest, AnOldCookieIsNoneAndNeitherIsThatOfAnotherRelay) {
  const auto ask = surgeon_.member.tick(now_, RelayMember::SessionIs::Silent);
  const auto cookie = rooms_.hear(*ask, kSurgeon, now_);
  const auto join = surgeon_.member.hear(cookie->bytes, kRelay, now_);
  ASSERT_TRUE(join);
  Rooms other;
  EXPECT_EQ(other.hear(*join, kSurgeon, now_), std::nullopt);
  pass(io::AddressCookie::kLife + milliseconds{1});
  EXPECT_EQ(rooms_.hear(*join, kSurgeon, now_), std::nullopt);
}

TEST_F(RoomsTest, AMemberIsRationed) {
  meet();
  std::size_t let_through = 0;
  for (int i = 0; i < 10'000; ++i) {
    if (way(kSurgeon)) ++let_through;
    pass(std::chrono::microseconds{100});  // 10,000 a second
  }
  EXPECT_NEAR(static_cast<double>(let_through), Rooms::kRateMax + Rooms::kBurstMax, 10);
  EXPECT_EQ(way(kPatient), kSurgeon) << "the other has its own ration";
}

TEST_F(RoomsTest, ProofsAreRationedByHostAndOthersStillEnter) {
  surgeon_.enter(rooms_, now_);
  const std::string host = "203.0.113.66:";
  for (int i = 0; i < 100; ++i) {
    Visitor{Role::Surgeon, at(host + std::to_string(1 + i)), kName + std::to_string(i)}.enter(
        rooms_, now_);
  }
  EXPECT_GE(rooms_.counts().over_rate, 80U);
  EXPECT_LE(rooms_.rooms(), Rooms::kSeatsPerHostMax + 1);
  patient_.enter(rooms_, now_);
  EXPECT_EQ(way(kSurgeon), kPatient);
}

TEST_F(RoomsTest, AFullRelaySaysSo) {
  for (std::size_t i = 0; i < Rooms::kRoomsMax; ++i) {
    Visitor{Role::Surgeon, at("203.0.113." + std::to_string(i) + ":1"), kName + std::to_string(i)}
        .enter(rooms_, now_);
  }
  EXPECT_EQ(rooms_.rooms(), Rooms::kRoomsMax);
  surgeon_.enter(rooms_, now_);
  ASSERT_TRUE(surgeon_.last);
  EXPECT_EQ(surgeon_.last->kind, RelayMessage::Kind::Refused);
  EXPECT_THAT(surgeon_.member.take_news()->sentence, testing::HasSubstr("is full"));
}

TEST_F(RoomsTest, WhoIsSilentForAMinuteIsForgotten) {
  meet();
  pass(Rooms::kIdleMax / 2);
  EXPECT_EQ(way(kSurgeon), kPatient);
  pass(Rooms::kIdleMax / 2 + seconds{1});
  EXPECT_EQ(way(kSurgeon), std::nullopt) << "nobody is there";
  EXPECT_EQ(rooms_.rooms(), 1U);
  pass(Rooms::kIdleMax + seconds{1});
  (void)way(kPatient);
  EXPECT_EQ(rooms_.rooms(), 0U);
}

RC_GTEST_FIXTURE_PROP(RoomsTest, NoBytesOfAStrangerGoAnywhereElse, ()) {
  meet();
  auto bytes = *rc::gen::container<std::vector<std::uint8_t>>(rc::gen::arbitrary<std::uint8_t>());
  if (*rc::gen::arbitrary<bool>()) {
    bytes.resize(RelayMessage::kSize);
    bytes[0] = 0x84;
  }
  const Endpoint stranger = at("203.0.113.66:6666");
  const auto out = rooms_.hear(std::as_bytes(std::span{bytes}), stranger, now_);
  if (out) {
    RC_ASSERT(out->to == stranger);
    RC_ASSERT(out->bytes.size() <= bytes.size());
  }
}

}  // namespace
}  // namespace palp::relay
