#include "site_program/force_watch.h"

#include <gtest/gtest.h>

namespace palp::site_program {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr TimePoint kBegan{seconds{50}};

LinkHeard heard(std::uint64_t session, TimePoint at) {
  LinkHeard heard;
  heard.at = at;
  heard.state = LinkState::Live;
  heard.session_id = session;
  heard.round_trip = milliseconds{80};
  return heard;
}

SiteTick tick(TimePoint at, double depth, double x) {
  SiteTick tick;
  tick.at = at;
  tick.position = depth;
  tick.place.x = x;
  return tick;
}

/// A telegram a millisecond, each `way` on its way; the peer's session is 7 s older.
void carry(ForceWatch& watch, int from, int to, Duration way, bool repaired = false) {
  for (int i = from; i < to; ++i) {
    Incoming one;
    one.number = static_cast<std::uint64_t>(i);
    one.repaired = repaired;
    one.sent_at = PeerTimePoint{seconds{7} + milliseconds{i}};
    one.arrived_at = kBegan + milliseconds{i} + way;
    watch.take(Arrived{.at = one.arrived_at, .incoming = one});
  }
  watch.tell();
}

TEST(ForceWatchTest, ASessionBeginsWithTheTickThatNamesIt) {
  ForceWatch watch;
  watch.take(heard(0, kBegan - seconds{1}));
  watch.take(heard(9, kBegan));
  watch.take(heard(9, kBegan + seconds{1}));
  watch.tell();
  const ForceSeen& seen = watch.seen().get();
  EXPECT_EQ(seen.session_id, 9U);
  EXPECT_EQ(seen.began_at, kBegan);
  EXPECT_EQ(seen.round_trip, milliseconds{80});
}

TEST(ForceWatchTest, TheTipIsThatOfTheNewestTick) {
  ForceWatch watch;
  watch.take(tick(kBegan, 0.001, 0.02));
  watch.take(tick(kBegan + milliseconds{1}, 0.002, 0.03));
  const video::TipSeen& tip = watch.tip().get();
  EXPECT_EQ(tip.at, kBegan + milliseconds{1});
  EXPECT_EQ(tip.depth, 0.002);
  EXPECT_EQ(tip.x, 0.03);
}

TEST(ForceWatchTest, TelegramsThatStandInAQueueAreSeen) {
  ForceWatch watch;
  watch.take(heard(9, kBegan));
  carry(watch, 0, 3000, milliseconds{40});
  EXPECT_LT(watch.seen().get().telegrams.standing, milliseconds{1});
  carry(watch, 3000, 3500, milliseconds{60});
  EXPECT_GT(watch.seen().get().telegrams.standing, milliseconds{10});
}

TEST(ForceWatchTest, CopiesThatRodeInLaterTelegramsSayNothing) {
  ForceWatch watch;
  watch.take(heard(9, kBegan));
  carry(watch, 0, 3000, milliseconds{40});
  carry(watch, 3000, 3500, milliseconds{60}, true);
  EXPECT_LT(watch.seen().get().telegrams.standing, milliseconds{1});
}

TEST(ForceWatchTest, AnInstantOfThePeerIsLaidOnOurLine) {
  ForceWatch watch;
  watch.take(heard(9, kBegan));
  watch.tell();
  const TimePoint now = kBegan + seconds{100};
  EXPECT_EQ(watch.seen().get().own_line(seconds{8}, now), now) << "nothing is known yet";
  carry(watch, 0, 1, milliseconds{40});
  EXPECT_EQ(watch.seen().get().own_line(seconds{8}, now), kBegan + seconds{1})
      << "half a round trip is the first guess";
  LinkStatus status;
  status.at = kBegan + seconds{2};
  status.health.session_id = 9;
  status.health.peer_clock = ClockOffset{.offset = seconds{6}, .at = kBegan + seconds{2}};
  watch.take(status);
  carry(watch, 1, 2, milliseconds{40});
  EXPECT_EQ(watch.seen().get().own_line(seconds{8}, now), kBegan + seconds{2});
  EXPECT_EQ(watch.seen().get().own_line(seconds{800}, now), now) << "no picture is of later";
}

}  // namespace
}  // namespace palp::site_program
