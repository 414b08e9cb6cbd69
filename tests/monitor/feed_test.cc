#include "monitor/feed.h"

#include <map>

#include <gtest/gtest.h>

#include "common/record/file_bytes.h"
#include "common/record/mcap_reader.h"
#include "common/record/notes.h"
#include "common/record/session_writer.h"

namespace palp::monitor {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

TimePoint at(int tick) { return TimePoint{5s} + tick * 1ms; }

record::WallClock some_clock() {
  record::WallClock clock;
  clock.ahead = 1000s;
  return clock;
}

SiteTick tick_at(TimePoint at, double force = 0) {
  SiteTick tick;
  tick.at = at;
  tick.force = force;
  return tick;
}

/// The records of a tick, in a node's order.
std::vector<Record> records_of(int tick) {
  std::vector<Record> all;
  Arrived arrived;
  arrived.at = at(tick);
  arrived.incoming.fresh = tick % 3 != 0;
  arrived.incoming.sample.force = tick;
  all.emplace_back(arrived);
  all.emplace_back(tick_at(at(tick), 0.1 * (tick % 7)));
  if (tick % 100 == 0) all.emplace_back(LinkStatus{.at = at(tick), .health = {}});
  if (tick % 50 == 7) all.emplace_back(Note{.at = at(tick), .code = 49, .detail = 1.0 * tick});
  if (tick % 90 == 9) {
    DepthArrived depth;
    depth.at = at(tick);
    depth.report.number = 1;
    depth.report.depth = 0.01;
    all.emplace_back(depth);
  }
  HandReading hand;
  hand.at = at(tick);
  all.emplace_back(hand);
  LinkHeard heard;
  heard.at = at(tick);
  all.emplace_back(heard);
  return all;
}

struct Said {
  std::uint64_t stamp{};
  std::vector<std::byte> bytes;
  bool operator==(const Said&) const = default;
};

std::map<std::string, std::vector<Said>> drain(Feed& feed) {
  std::map<std::string, std::vector<Said>> all;
  const auto topics = record::topics_of(feed.site());
  for (LiveMessage message; feed.next(message);) {
    for (const auto& topic : topics) {
      if (topic.topic != message.topic) continue;
      const auto bytes = message.payload();
      all[topic.name].push_back({message.stamp, {bytes.begin(), bytes.end()}});
    }
  }
  return all;
}

TEST(FeedTest, EveryMessageOnTheScreenIsThatOfTheSessionFile) {
  record::MemorySink sink;
  record::SessionInfo info;
  info.clock = some_clock();
  Feed feed{link::Role::Surgeon, info.clock, 1ms};
  {
    record::SessionWriter writer{sink, info};
    for (int tick = 0; tick < 500; ++tick) {
      for (const Record& record : records_of(tick)) {
        feed.take(record);
        (void)writer.write(record);
      }
    }
  }
  std::map<std::string, std::vector<Said>> file;
  const record::FileBytes bytes{sink.bytes()};
  record::McapReader reader{bytes};
  while (const auto item = reader.next()) {
    if (const auto* one = std::get_if<record::McapMessage>(&*item)) {
      file[one->channel->topic].push_back(
          {one->publish_time, {one->payload.begin(), one->payload.end()}});
    }
  }
  const auto screen = drain(feed);
  ASSERT_EQ(screen.size(), 4U) << "view, link, event, depth";
  for (const auto& [topic, said] : screen) {
    std::vector<Said> written = file[topic];
    // The file's last view is cut off by its end.
    if (topic == "surgeon/tick_view") written.pop_back();
    EXPECT_EQ(said, written) << topic;
    EXPECT_GT(said.size(), 4U) << topic;
  }
}

TEST(FeedTest, TheStatusIsTheNewestAndKeepsThePeersExtremes) {
  Feed feed{link::Role::Surgeon, some_clock(), 1ms};
  feed.tell(true);
  EXPECT_EQ(feed.status().ticks, 0U) << "nothing to tell before the first tick";
  for (int tick = 1; tick <= 20; ++tick) {
    for (const Record& record : records_of(tick)) feed.take(record);
  }
  feed.tell(true);
  const LiveStatus status = feed.status();
  EXPECT_EQ(status.stamp, some_clock().stamp(at(20)));
  EXPECT_EQ(status.ticks, 20U);
  EXPECT_EQ(status.ticks_missed, 0U);
  EXPECT_EQ(status.peer_force, 20);
  EXPECT_EQ(status.peer_force_min, 1);
  EXPECT_EQ(status.peer_force_max, 20);
  EXPECT_TRUE(status.recording);
  for (const Record& record : records_of(22)) feed.take(record);
  feed.tell(false);
  EXPECT_EQ(feed.status().ticks_missed, 1U);
  EXPECT_EQ(feed.status().peer_force_min, 22) << "of this time alone";
}

TEST(FeedTest, ARefusalStandsUntilAnEngagement) {
  Feed feed{link::Role::Surgeon, {}, 1ms};
  const auto refused = static_cast<std::uint16_t>(record::NoteCode::RoundTripTooLong);
  const auto told = [&feed] {
    feed.take(tick_at(at(1)));
    feed.tell(false);
    return feed.status().refused;
  };
  feed.take(Note{.at = at(1), .code = refused});
  feed.take(Note{.at = at(1), .code = 49});
  EXPECT_EQ(told(), refused);
  feed.take(Transition{.at = at(1), .from = SiteState::Clutched, .to = SiteState::Engaged});
  EXPECT_EQ(told(), 0);
}

TEST(FeedTest, WhenNobodyReadsMessagesAreDroppedAndCounted) {
  Feed feed{link::Role::Patient, {}, 1ms};
  for (int i = 0; i < 5000; ++i) feed.take(Note{.at = at(i), .code = 49});
  std::size_t there = 0;
  for (LiveMessage message; feed.next(message);) ++there;
  feed.take(tick_at(at(1)));
  feed.tell(false);
  EXPECT_EQ(there + feed.status().dropped, 5000U);
  EXPECT_LT(there, 3000U);
}

}  // namespace
}  // namespace palp::monitor
