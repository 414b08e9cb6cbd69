// Goal: the patient follows a surgeon whose address changes, and nobody else: not who repeats,
// holds back or copies telegrams, however fast. Method: both sites in virtual time; somebody on the
// way who sees all and sends from elsewhere.
#include "common/io/secure/roaming.h"

#include <algorithm>
#include <deque>

#include <gtest/gtest.h>

#include "common/core/random.h"
#include "common/io/net/side_inbox.h"
#include "tests/common/io/secure/secure_world.h"

namespace palp::io {
namespace {

using link::Role;
using std::chrono::milliseconds;
using std::chrono::seconds;
using test::begin;
using test::is_path;
using test::kElsewhere;
using test::kPatientAt;
using test::kSurgeonAt;
using test::Parcel;
using test::World;

/// Seals so many zeros in place of a telegram, properly and of any length, and keeps them.
class LongWords final : public link::PacketProtection {
 public:
  LongWords(std::unique_ptr<link::PacketProtection> inner,
            const std::size_t& wanted,
            std::vector<std::byte>& kept)
      : inner_{std::move(inner)}, wanted_{wanted}, kept_{kept} {}
  [[nodiscard]] std::size_t overhead() const noexcept override { return inner_->overhead(); }
  std::size_t seal(const link::Header& header,
                   std::span<const std::byte> plain,
                   std::span<std::byte> out) noexcept override {
    if (wanted_ == 0) return inner_->seal(header, plain, out);
    kept_.resize(wanted_);
    const std::vector<std::byte> zeros(wanted_ - link::kHeaderSize - overhead());
    EXPECT_EQ(inner_->seal(header, zeros, kept_), wanted_);
    return 0;  // the link sends nothing
  }
  tl::expected<link::Header, link::Rejection> read_header(
      std::span<const std::byte> datagram) noexcept override {
    return inner_->read_header(datagram);
  }
  tl::expected<std::size_t, link::Rejection> open(const link::Header& header,
                                                  std::span<const std::byte> datagram,
                                                  std::span<std::byte> plain) noexcept override {
    return inner_->open(header, datagram, plain);
  }

 private:
  std::unique_ptr<link::PacketProtection> inner_;
  const std::size_t& wanted_;
  std::vector<std::byte>& kept_;
};

TEST(RoamingTest, WhatIsLongerThanADatagramOfOursIsRefusedHoweverWellSealed) {
  for (const std::size_t size : {1199U, 1200U, 1201U, 1202U, 1500U, 9000U}) {
    World world{"long"};
    std::size_t wanted = 0;
    std::vector<std::byte> sealed;
    world.surgeon->wrap_protection = [&](auto inner) {
      return std::make_unique<LongWords>(std::move(inner), wanted, sealed);
    };
    world.run(seconds{1});
    ASSERT_TRUE(world.live());
    wanted = size;
    world.surgeon->tick(world.now);
    const auto out = world.patient->session_endpoint.hear(sealed, kElsewhere, world.now);
    EXPECT_EQ(out.detours, size <= link::kDatagramSizeMax) << size;
    const SideDatagram aside{sealed, kElsewhere, world.now};
    EXPECT_EQ(aside.datagram().size(), std::min(size, link::kDatagramSizeMax));
    EXPECT_TRUE(
        std::ranges::equal(aside.datagram(), std::span{sealed}.first(aside.datagram().size())));
  }
}

TEST(RoamingTest, ThePatientFollowsTheSurgeonToANewAddress) {
  World world{"roam"};
  world.run(seconds{1});
  world.surgeon_seen_at = kElsewhere;
  world.run(milliseconds{60});
  ASSERT_EQ(world.patient->moved_to.size(), 1U);
  EXPECT_TRUE(world.patient->moved_to[0] == kElsewhere);
  world.run(seconds{1});
  EXPECT_TRUE(world.live());
  EXPECT_EQ(world.patient->established.size(), 1U) << "no new session, no new handshake";
  EXPECT_EQ(world.patient->rekeyed, 0);
}

TEST(RoamingTest, AnOldTelegramFromElsewhereMovesNobody) {
  World world{"spoof"};
  world.run(seconds{1});
  world.patient->tick(world.now);  // takes what was on the way
  for (const auto& bytes : world.recorded) {
    const auto out = world.patient->session_endpoint.hear(bytes, kElsewhere, world.now);
    EXPECT_TRUE(out.letters.empty());
    EXPECT_FALSE(out.detours);
    EXPECT_FALSE(out.moved_to);
  }
}

TEST(RoamingTest, AnOldTelegramMovesNobodyAfterAChangeOfAddressEither) {
  World world{"after"};
  world.run(seconds{1});
  world.surgeon_seen_at = kElsewhere;
  world.run(milliseconds{100});
  ASSERT_EQ(world.patient->moved_to.size(), 1U);
  world.patient->tick(world.now);
  const Endpoint third = *resolve_endpoint("127.0.0.3:1000");
  for (const auto& bytes : world.recorded) {
    const auto out = world.patient->session_endpoint.hear(bytes, third, world.now);
    EXPECT_TRUE(out.letters.empty());
    EXPECT_FALSE(out.detours);
  }
}

TEST(RoamingTest, TelegramsTakenOffTheWayMoveNobodyAndDrawLittle) {
  World world{"steal"};
  world.run(seconds{1});
  world.elsewhere_watched = kElsewhere;
  std::size_t in = 0;
  // Somebody on the way takes telegrams off and sends them from elsewhere, but cannot answer.
  for (int i = 0; i < 10'000; ++i, world.now += milliseconds{1}) {
    world.surgeon->tick(world.now);
    world.patient->tick(world.now);
    if (i < 300) {
      for (auto& bytes : std::exchange(world.surgeon->wire.out, {})) {
        in += bytes.size();
        test::Parcel stolen{world.now, false, kPatientAt, kElsewhere, bytes};
        world.arrive(stolen, *world.patient);
      }
    }
    world.pass(*world.surgeon, *world.patient, kSurgeonAt);
    world.pass(*world.patient, *world.surgeon, kPatientAt);
  }
  std::size_t out = 0;
  for (const auto& bytes : world.watched) out += bytes.size();
  EXPECT_GT(out, 0U);
  EXPECT_LE(out, 3 * in);
  EXPECT_EQ(std::ranges::count_if(world.watched, is_path), 1);
  EXPECT_TRUE(world.patient->moved_to.empty());
  EXPECT_TRUE(world.live());
}

TEST(RoamingTest, AThiefWhoIsFasterThanTheSenderKeepsHimFromNothing) {
  const Endpoint thief = *resolve_endpoint("127.0.0.3:1000");
  for (const std::size_t ahead : {0U, 5U}) {  // telegrams
    World world{"faster"};
    world.run(seconds{1});
    world.surgeon_seen_at = kElsewhere;
    world.elsewhere_watched = thief;
    std::size_t in = 0;
    std::deque<std::vector<std::byte>> behind;
    for (int i = 0; i < 400; ++i, world.now += milliseconds{1}) {
      world.surgeon->tick(world.now);
      world.patient->tick(world.now);
      for (auto& bytes : std::exchange(world.surgeon->wire.out, {})) {
        in += bytes.size();
        test::Parcel stolen{world.now, false, kPatientAt, thief, bytes};
        world.arrive(stolen, *world.patient);
        behind.push_back(bytes);
      }
      for (; behind.size() > ahead; behind.pop_front()) {
        world.surgeon->wire.out.push_back(behind.front());
      }
      world.pass(*world.surgeon, *world.patient, kElsewhere);
      world.pass(*world.patient, *world.surgeon, kPatientAt);
    }
    ASSERT_EQ(world.patient->moved_to.size(), 1U) << ahead;
    EXPECT_TRUE(world.patient->moved_to[0] == kElsewhere);
    EXPECT_TRUE(world.live());
    std::size_t out = 0;
    for (const auto& bytes : world.watched) out += bytes.size();
    EXPECT_LE(out, 3 * in);
  }
}

TEST(RoamingTest, MovesAreASecondApartHoweverOftenTheAddressChanges) {
  World world{"pace"};
  begin(world, true);
  ASSERT_TRUE(world.live());
  TimePoint moved_at{};
  std::size_t moves = 0;
  world.each_ms = [&] {
    ASSERT_TRUE(world.live());
    if (world.patient->moved_to.size() == moves) return;
    EXPECT_TRUE(moves == 0 || world.now - moved_at >= seconds{1});
    moves = world.patient->moved_to.size();
    moved_at = world.now;
  };
  for (int i = 0; i < 100; ++i) {
    world.surgeon_seen_at = *resolve_endpoint("127.0.0.1:" + std::to_string(3000 + i % 50));
    world.run(milliseconds{150});
  }
  world.run(seconds{3});
  EXPECT_TRUE(world.patient->hears == world.surgeon_seen_at);
}

const Roaming::Straight kSilent{.newest_number = 10, .heard_at = TimePoint{}};

TEST(PathAnswersTest, QuestionsOfThePatientsAddressOnlyAreAnswered) {
  PathAnswers answers;
  const PathMessage question{PathMessage::Kind::Question, {std::byte{3}}, kSurgeonAt.bytes()};
  const auto answer = answers.answer(question, kPatientAt, kPatientAt);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->kind, PathMessage::Kind::Answer);
  EXPECT_EQ(answer->nonce, question.nonce);
  EXPECT_EQ(answer->asked, question.asked);
  EXPECT_FALSE(answers.answer(question, kElsewhere, kPatientAt));
  EXPECT_FALSE(answers.answer(question, kElsewhere, {}));
  EXPECT_FALSE(answers.answer(*answer, kPatientAt, kPatientAt)) << "an answer is no question";
}

TEST(PathMessageTest, IsReadAsItWasWrittenAndInNoOtherSize) {
  const PathMessage message{PathMessage::Kind::Answer, {std::byte{9}}, kElsewhere.bytes()};
  const auto framed = message.framed(7);
  const auto content = std::span{framed}.subspan(link::kHeaderSize);
  EXPECT_EQ(content.size(), PathMessage::kSize);
  const auto read = PathMessage::parse(content);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->kind, message.kind);
  EXPECT_EQ(read->nonce, message.nonce);
  EXPECT_EQ(read->asked, message.asked);
  EXPECT_FALSE(PathMessage::parse(content.first(content.size() - 1)));
  EXPECT_FALSE(PathMessage::parse({}));
  auto other = framed;
  other[link::kHeaderSize] = std::byte{2};
  EXPECT_FALSE(PathMessage::parse(std::span{other}.subspan(link::kHeaderSize)));
}

PathMessage answer_to(const PathQuestion& question) {
  PathMessage answer = question.message;
  answer.kind = PathMessage::Kind::Answer;
  return answer;
}

TEST(RoamingTest, AnAnswerCountsOnlyFromTheAddressThatItNames) {
  const TimePoint now{seconds{1}};
  Roaming roaming;
  roaming.begin(kSurgeonAt);
  EXPECT_FALSE(roaming.note(11, kElsewhere, 20, kSilent, now))
      << "longer than what came from there";
  const auto question = roaming.note(12, kElsewhere, 200, kSilent, now);
  ASSERT_TRUE(question);
  ASSERT_TRUE(question->to == kElsewhere);
  PathMessage answer = answer_to(*question);
  EXPECT_FALSE(roaming.answer(answer, kSurgeonAt, now));
  EXPECT_FALSE(roaming.move(kSilent, now));
  answer.asked = kSurgeonAt.bytes();
  EXPECT_FALSE(roaming.answer(answer, kElsewhere, now));
  EXPECT_FALSE(roaming.answer(answer, kSurgeonAt, now));
  EXPECT_FALSE(roaming.answer(question->message, kElsewhere, now)) << "a question is no answer";
  answer.asked = kElsewhere.bytes();
  EXPECT_TRUE(roaming.answer(answer, kElsewhere, now));
  EXPECT_FALSE(roaming.move({.newest_number = 10, .heard_at = now - milliseconds{49}}, now));
  EXPECT_TRUE(roaming.move(kSilent, now));
}

TEST(RoamingTest, AnAnswerIsGoodForSomeSecondsAndForNoOtherSession) {
  for (const int asked_ms : {12'000, 12'001, 15'999, 16'000}) {
    const TimePoint asked_at{milliseconds{asked_ms}};
    Roaming roaming;
    roaming.begin(kSurgeonAt);
    const auto question = roaming.note(11, kElsewhere, 200, kSilent, asked_at);
    ASSERT_TRUE(question);
    const PathMessage answer = answer_to(*question);
    Roaming later = roaming;
    EXPECT_TRUE(later.answer(answer, kElsewhere, asked_at + seconds{4}));
    EXPECT_FALSE(later.answer(answer, kElsewhere, asked_at + seconds{8}));
    later.begin(kSurgeonAt);
    EXPECT_FALSE(later.answer(answer, kElsewhere, asked_at));
  }
}

TEST(RoamingTest, ManyAddressesTakeNobodysTurnToBeAsked) {
  Roaming roaming;
  roaming.begin(kSurgeonAt);
  TimePoint now{seconds{1}};
  std::uint64_t number = 20;
  const auto from_others = [&] {
    for (int port = 0; port < 500; ++port) {
      const Endpoint other = *resolve_endpoint("127.0.0.3:" + std::to_string(1000 + port));
      (void)roaming.note(number, other, 200, kSilent, now);
    }
  };
  from_others();
  const auto question = roaming.note(++number, kElsewhere, 200, kSilent, now);
  ASSERT_TRUE(question);
  from_others();
  EXPECT_TRUE(roaming.answer(answer_to(*question), kElsewhere, now + milliseconds{75}));
  from_others();
  const auto moved = roaming.move(kSilent, now + milliseconds{75});
  ASSERT_TRUE(moved);
  EXPECT_TRUE(*moved == kElsewhere);
}

}  // namespace
}  // namespace palp::io
