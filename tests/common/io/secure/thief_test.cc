// Goal: who sees all telegrams and sends copies of them from elsewhere, however fast and from
// however many addresses, gets nothing and keeps nobody from anything. Method: both sites in
// virtual time; the thief stands on the way.
#include <algorithm>
#include <deque>

#include <gtest/gtest.h>

#include "common/core/random.h"
#include "common/io/secure/roaming.h"
#include "tests/common/io/secure/secure_world.h"

namespace palp::io {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::begin;
using test::is_path;
using test::kElsewhere;
using test::kPatientAt;
using test::kSurgeonAt;
using test::Parcel;
using test::World;

/// Sees everything, drops nothing, and is faster than the way by `lead`. Sends copies of the
/// surgeon's words from its own address, and hands what comes there to the surgeon.
struct Thief {
  Thief(World& the_world, Duration its_lead, bool lies) : world{the_world}, lead{its_lead} {
    spoofs = lies;
    world.observer = [this](const Parcel& parcel) { see(parcel); };
  }
  void see(const Parcel& parcel) {
    if (parcel.from == world.surgeon_seen_at && active) {
      const TimePoint due = std::max(world.now, parcel.due - lead);
      world.throw_in({due, parcel.letter, kPatientAt, address, parcel.bytes});
    } else if (parcel.from == kPatientAt && parcel.to.same_host(address)) {
      const bool question = is_path(parcel.bytes);
      questions += question ? 1 : 0;
      telegrams += parcel.letter ? 0 : 1;
      if (question && last_question) pause_min = std::min(pause_min, world.now - *last_question);
      if (question) last_question = world.now;
      const Endpoint& from = spoofs ? kPatientAt : address;
      if (question) world.throw_in({world.now, true, world.surgeon_seen_at, from, parcel.bytes});
    }
  }

  World& world;
  Duration lead;
  bool spoofs{};  ///< it can send in the patient's name
  bool active{true};
  Endpoint address{*resolve_endpoint("127.0.0.3:1000")};
  int questions{};
  int telegrams{};
  std::optional<TimePoint> last_question;
  Duration pause_min{Duration::max()};
};

TEST(ThiefTest, CopiesOfTheFirstWordsOfASessionKeepNobodyFromIt) {
  for (const int lead : {0, 20}) {
    World world{"first-words"};
    world.way = milliseconds{25};
    Thief thief{world, milliseconds{lead}, true};
    world.run(seconds{2});
    EXPECT_TRUE(world.live());
    EXPECT_TRUE(world.patient->hears == kSurgeonAt);
    EXPECT_EQ(world.patient->established.size(), 1U);
    EXPECT_EQ(thief.telegrams + thief.questions, 0);
  }
}

TEST(ThiefTest, WhoCopiesEachTelegramFasterThanItsSenderGetsNothingAndKeepsNobodyFromAnything) {
  for (const bool spoofs : {false, true}) {
    for (const int lead : {0, 1, 5, 20}) {
      World world{"thief"};
      begin(world, true);
      ASSERT_TRUE(world.live());
      Thief thief{world, milliseconds{lead}, spoofs};
      world.each_ms = [&] { ASSERT_TRUE(world.live()); };
      world.run(lead == 20 ? seconds{60} : seconds{5});
      EXPECT_EQ(thief.telegrams, 0);
      EXPECT_EQ(thief.questions, 0) << "where the surgeon is heard, nobody else is asked";
      EXPECT_TRUE(world.patient->moved_to.empty());
      EXPECT_EQ(world.patient->link.health(world.now).lost, 0U);
    }
  }
}

TEST(ThiefTest, WhoComesAndGoesUnderManyAddressesMovesNobody) {
  World world{"flapping"};
  begin(world, true);
  ASSERT_TRUE(world.live());
  Thief thief{world, milliseconds{20}, true};
  std::uint64_t draws = 0;
  world.each_ms = [&] {
    ASSERT_TRUE(world.live());
    const std::uint64_t bits = random_bits(5, 6, ++draws);
    thief.active = bits % 7 < 4;
    thief.address = *resolve_endpoint("127.0.0.3:" + std::to_string(1000 + bits % 50));
  };
  world.run(seconds{20});
  EXPECT_EQ(thief.telegrams + thief.questions, 0);
  EXPECT_TRUE(world.patient->moved_to.empty());
}

/// The straight way loses all for a while, again and again; copies are not lost.
TEST(ThiefTest, InGapsOfTheStraightWayHeIsAskedOnceASecondAndTheSurgeonIsFollowedBack) {
  for (const bool spoofs : {false, true}) {
    World world{"gaps"};
    begin(world, true);
    ASSERT_TRUE(world.live());
    Thief thief{world, milliseconds{20}, spoofs};
    const TimePoint began = world.now;
    world.lose_after_observer = [&](const Parcel& parcel) {
      return parcel.from == kSurgeonAt &&
             (world.now - began) % milliseconds{1500} < milliseconds{80};
    };
    world.each_ms = [&] { ASSERT_TRUE(world.live()); };
    world.run(seconds{30});
    EXPECT_GE(thief.questions, 5);
    EXPECT_GE(thief.pause_min, seconds{1});
    EXPECT_LE(world.patient->moved_to.size(), spoofs ? 30U : 0U);
    world.lose_after_observer = nullptr;
    world.run(seconds{3});
    const std::size_t moves = world.patient->moved_to.size();
    thief.telegrams = 0;
    world.run(seconds{3});
    EXPECT_EQ(thief.telegrams, 0);
    EXPECT_TRUE(world.patient->hears == kSurgeonAt);
    EXPECT_EQ(world.patient->moved_to.size(), moves);
    EXPECT_EQ(world.patient->established.size(), 1U);
  }
}

/// Sends copies of each of the surgeon's telegrams from many addresses, in turn sooner and later
/// than the surgeon itself.
struct Copier {
  Copier(World& the_world, int its_addresses, std::vector<int> its_leads_ms)
      : world{the_world}, leads_ms{std::move(its_leads_ms)} {
    for (int i = 0; i < its_addresses; ++i) {
      addresses.push_back(*resolve_endpoint("127.0.0.3:" + std::to_string(1000 + i)));
    }
    world.observer = [this](const Parcel& parcel) { see(parcel); };
  }
  void see(const Parcel& parcel) {
    if (!(parcel.from == world.surgeon_seen_at) || parcel.letter) return;
    for (std::size_t i = 0; i < addresses.size(); ++i) {
      const TimePoint due =
          std::max(world.now, parcel.due - milliseconds{leads_ms[i % leads_ms.size()]});
      world.throw_in({due, false, kPatientAt, addresses[i], parcel.bytes});
    }
  }

  World& world;
  std::vector<int> leads_ms;
  std::vector<Endpoint> addresses;
};

/// Within a round trip and 0.2 s of each change everything goes on.
TEST(ThiefTest, WhoCopiesEachTelegramFromManyAddressesKeepsNobodyFromFollowingTheSurgeon) {
  for (const int addresses : {4, 20}) {
    const int changes = addresses == 4 ? 20 : 5;
    World world{"copier"};
    begin(world, true);
    ASSERT_TRUE(world.live());
    Copier copier{world, addresses, {20, 5, 1, 0, -1, -5, -20}};
    for (int i = 0; i < changes; ++i) {
      world.surgeon_seen_at = *resolve_endpoint("127.0.0.1:" + std::to_string(3000 + i));
      world.run(2 * world.way + milliseconds{200});
      EXPECT_TRUE(world.live()) << addresses << " addresses, change " << i;
      EXPECT_TRUE(world.patient->hears == world.surgeon_seen_at) << i;
      world.run(seconds{1});
    }
    EXPECT_EQ(world.patient->moved_to.size(), static_cast<std::size_t>(changes));
    EXPECT_EQ(world.patient->established.size(), 1U);
  }
}

TEST(ThiefTest, ASurgeonThatIsSeenUnderItsOwnAddressAnswersForNoOther) {
  World world{"untranslated"};
  begin(world, false);
  ASSERT_TRUE(world.live());
  Thief thief{world, milliseconds{20}, true};
  world.lose_after_observer = [&](const Parcel& parcel) { return parcel.from == kSurgeonAt; };
  world.run(seconds{3});
  EXPECT_GE(thief.questions, 2);
  EXPECT_TRUE(world.patient->moved_to.empty());
}

}  // namespace
}  // namespace palp::io
