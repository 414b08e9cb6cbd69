#include "common/io/secure/relay_member.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/io/secure/address_cookie.h"
#include "common/io/secure/session_news.h"

namespace palp::io {
namespace {

using link::Role;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

constexpr char kRoom[] = "K7Q2-a-long-name";

Endpoint place(const std::string& text) { return resolve_endpoint(text).value(); }

using SessionIs = RelayMember::SessionIs;

class RelayMemberTest : public testing::Test {
 protected:
  /// What the relay would say to that.
  [[nodiscard]] RelayMessage::Bytes answered(const RelayMessage::Bytes& said,
                                             RelayMessage::Kind kind,
                                             std::uint8_t detail = 0) const {
    RelayMessage message = *RelayMessage::parse(said);
    message.kind = kind;
    message.detail = detail;
    if (kind == RelayMessage::Kind::Cookie) message.cookie.fill(std::byte{7});
    return message.bytes();
  }
  void join(std::uint8_t others) {
    const auto ask = member_.tick(now_, SessionIs::Silent);
    ASSERT_TRUE(ask);
    const auto join = member_.hear(answered(*ask, RelayMessage::Kind::Cookie), relay_, now_);
    ASSERT_TRUE(join);
    (void)member_.hear(answered(*join, RelayMessage::Kind::Joined, others), relay_, now_);
  }

  Endpoint relay_{place("198.51.100.9:9100")};
  TimePoint now_{seconds{5}};
  RelayMember member_{RoomKey::from_name(kRoom).value(), Role::Surgeon, relay_, 3};
};

TEST_F(RelayMemberTest, TheProofOfAJoinIsTheRoomsOwn) {
  const auto ask = member_.tick(now_, SessionIs::None);
  const auto join = member_.hear(answered(*ask, RelayMessage::Kind::Cookie), relay_, now_);
  ASSERT_TRUE(join);
  RelayMessage message = *RelayMessage::parse(*join);
  EXPECT_TRUE(proves_room(message.room, message.claim(), message.proof));
  message.role = Role::Patient;
  EXPECT_FALSE(proves_room(message.room, message.claim(), message.proof));
}

TEST_F(RelayMemberTest, AskedOnceASecondAndInNeedFiveTimes) {
  EXPECT_TRUE(member_.tick(now_, SessionIs::None));
  EXPECT_FALSE(member_.tick(now_ + milliseconds{300}, SessionIs::None));
  EXPECT_TRUE(member_.tick(now_ + milliseconds{300}, SessionIs::Silent));
  EXPECT_TRUE(member_.tick(now_ + milliseconds{1300}, SessionIs::None));
}

TEST_F(RelayMemberTest, WhoIsInASessionAsksAgainAfterAQuarterOfAMinute) {
  join(1);
  EXPECT_TRUE(member_.take_news()->good);
  EXPECT_FALSE(member_.tick(now_ + RelayMember::kKeepEvery - milliseconds{1}, SessionIs::Live));
  EXPECT_TRUE(member_.tick(now_ + RelayMember::kKeepEvery, SessionIs::Live));
}

TEST_F(RelayMemberTest, WhoWaitsForASessionShowsEachSecondThatItIsThere) {
  join(1);
  EXPECT_TRUE(member_.tick(now_ + RelayMember::kAskEvery, SessionIs::None));
}

TEST_F(RelayMemberTest, WhoDoesNotSeeOurWordsIsNotBelieved) {
  const auto ask = member_.tick(now_, SessionIs::None);
  auto guessed = answered(*ask, RelayMessage::Kind::Cookie);
  guessed.back() ^= std::byte{1};
  EXPECT_FALSE(member_.hear(guessed, relay_, now_)) << "another nonce";
  const auto right = answered(*ask, RelayMessage::Kind::Cookie);
  EXPECT_FALSE(member_.hear(right, place("203.0.113.6:9100"), now_)) << "another address";
  (void)member_.hear(answered(*ask, RelayMessage::Kind::Joined, 1), relay_, now_);
  EXPECT_FALSE(member_.take_news()) << "no Join was sent yet";
  EXPECT_TRUE(member_.hear(right, relay_, now_));
  EXPECT_FALSE(member_.hear(right, relay_, now_)) << "one Join for a question";
}

TEST_F(RelayMemberTest, PeopleAreToldOnceOfEachChange) {
  join(0);
  EXPECT_THAT(member_.take_news()->sentence, HasSubstr("nobody else is in the room"));
  EXPECT_FALSE(member_.take_news());
  now_ += seconds{60};
  (void)member_.tick(now_, SessionIs::None);
  EXPECT_THAT(member_.take_news()->sentence, HasSubstr("does not answer"));
}

TEST_F(RelayMemberTest, WhyNobodyAnswersInARoomTheRelayKnowsBetter) {
  const link::Refused silence{"the handshake failed: no answer: let both meet at a relay", false};
  EXPECT_EQ(refusal_text(silence, true, std::nullopt), silence.text);
  std::optional<RelayMember> member{std::move(member_)};
  EXPECT_FALSE(refusal_text(silence, true, member)) << "the relay says that it is not there";
  EXPECT_EQ(refusal_text(silence, false, member), silence.text) << "the other site has spoken";
  member_ = std::move(*member);
  join(1);
  member.emplace(std::move(member_));
  const auto why = refusal_text(silence, true, member);
  ASSERT_TRUE(why);
  EXPECT_THAT(*why, HasSubstr("by way of the relay at 198.51.100.9:9100"));
  EXPECT_THAT(*why, testing::Not(HasSubstr("let both meet")));
}

TEST(RoomKeyTest, ShortOrBlankNamesAreRefused) {
  EXPECT_FALSE(RoomKey::from_name("short"));
  EXPECT_FALSE(RoomKey::from_name("with a blank inside"));
  EXPECT_FALSE(RoomKey::from_name(std::string(65, 'a')));
  EXPECT_NE(RoomKey::from_name(kRoom)->id(), RoomKey::from_name("K7Q2-a-long-namf")->id());
}

TEST(AddressCookieTest, IsGoodForItsAddressPurposeAndTime) {
  const AddressCookie cookies;
  const Endpoint here = place("198.51.100.1:4000");
  const std::array purpose{std::byte{1}};
  const std::array other{std::byte{2}};
  const TimePoint now{seconds{100}};
  const AddressCookie::Bytes cookie = cookies.make(here, purpose, now);
  EXPECT_EQ(cookies.made_at(cookie, here, purpose, now + AddressCookie::kLife), now);
  EXPECT_FALSE(cookies.made_at(cookie, place("198.51.100.1:4001"), purpose, now));
  EXPECT_FALSE(cookies.made_at(cookie, here, other, now));
  EXPECT_FALSE(
      cookies.made_at(cookie, here, purpose, now + AddressCookie::kLife + milliseconds{1}));
  AddressCookie::Bytes later = cookie;
  later[6] ^= std::byte{1};
  EXPECT_FALSE(cookies.made_at(later, here, purpose, now)) << "its time is sealed too";
}

TEST(SessionNewsTest, NamesThePeerItsBuildAndWhatWasProven) {
  link::Established session;
  session.peer_git = "abc1234";
  EXPECT_EQ(session_sentence(Role::Surgeon, place("198.51.100.1:4000"), session, "palp patient"),
            "session with the patient site at 198.51.100.1:4000, its build abc1234, proven by palp "
            "patient");
}

}  // namespace
}  // namespace palp::io
