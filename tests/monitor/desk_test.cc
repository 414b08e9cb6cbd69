#include "monitor/desk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/config/json.h"
#include "tests/monitor/next_frame.h"

namespace palp::monitor {
namespace {

using config::Json;
using std::chrono_literals::operator""ms;
using testing::HasSubstr;
using namespace std::string_literals;

constexpr Duration kSecond = std::chrono::seconds{1};
constexpr TimePoint kNow{100 * kSecond};

/// A desk with all there is to ask for, and what came of it.
struct Rig {
  SpscQueue<Request> requests{64};
  Mailbox<std::uint32_t> stops;
  Mailbox<PointerReport> pointer;
  CameraFeed camera;
  Desk desk{{.site = link::Role::Surgeon, .program = "palp-surgeon", .run = "r"},
            {.requests = &requests, .stops = &stops, .pointer = &pointer, .camera = &camera}};

  std::string next(std::uint32_t client) { return next_frame(desk, client); }
  /// Past the greeting.
  std::uint32_t join(Right right) {
    const std::uint32_t client = desk.join(right, kNow);
    while (!next(client).empty()) {
    }
    return client;
  }
  Json call(std::uint32_t client, char service, const std::string& request = "{}") {
    const std::string bytes = "\x02"s + service + "\0\0\0\x07\0\0\0\x04\0\0\0json"s + request;
    EXPECT_TRUE(desk.hear_bytes(client, bytes, kNow));
    const std::string answer = next(client);
    return Json::parse(answer.starts_with('{') ? answer : answer.substr(17));
  }
  Request asked() {
    Request request;
    EXPECT_TRUE(requests.try_dequeue(request));
    return request;
  }
  void publish_pointer(std::uint32_t client) {
    EXPECT_TRUE(desk.hear_text(
        client,
        R"({"op":"advertise","channels":[{"id":9,"topic":"monitor/pointer","encoding":"json"}]})",
        kNow));
  }
  bool point(std::uint32_t client, const std::string& json) {
    return desk.hear_bytes(client, "\x01\x09\0\0\0"s + json, kNow);
  }
};

video::CameraFrame frame_of(bool key, char content) {
  return {.captured_at = kNow, .key = key, .jpeg = false, .bytes = {std::byte(content)}};
}
constexpr const char* kLook = R"({"op":"subscribe","subscriptions":[{"id":5,"channelId":102}]})";

TEST(DeskTest, PicturesBeginWithOneThatRefersToNothing) {
  Rig rig;
  const std::uint32_t client = rig.join(Right::View);
  EXPECT_FALSE(rig.camera.wishes.get().watched);
  EXPECT_TRUE(rig.desk.hear_text(client, kLook, kNow));
  EXPECT_TRUE(rig.camera.wishes.get().watched);
  EXPECT_EQ(rig.camera.wishes.get().keys, 1U);
  rig.desk.publish(frame_of(false, 'd'), 7);
  EXPECT_EQ(rig.next(client), "");
  rig.desk.publish(frame_of(true, 'k'), 8);
  rig.desk.publish(frame_of(false, 'e'), 9);
  EXPECT_THAT(rig.next(client), HasSubstr("k"));
  EXPECT_THAT(rig.next(client), HasSubstr("e"));
  EXPECT_TRUE(rig.desk.hear_text(client, R"({"op":"unsubscribe","subscriptionIds":[5]})", kNow));
  EXPECT_FALSE(rig.camera.wishes.get().watched);
}

TEST(DeskTest, AClientThatMissedAPictureGetsNoneThatRestsOnIt) {
  Rig rig;
  const std::uint32_t client = rig.join(Right::View);
  EXPECT_TRUE(rig.desk.hear_text(client, kLook, kNow));
  rig.desk.publish(frame_of(true, 'k'), 1);
  for (std::size_t i = 0; i < Outbox::kChainedMax; ++i) rig.desk.publish(frame_of(false, 'd'), 2);
  EXPECT_EQ(rig.next(client), "") << "all of them gave way";
  rig.desk.publish(frame_of(false, 'd'), 3);
  EXPECT_EQ(rig.next(client), "");
  EXPECT_EQ(rig.camera.wishes.get().keys, 2U);
  rig.desk.publish(frame_of(true, 'k'), 4);
  EXPECT_THAT(rig.next(client), HasSubstr("k"));
}

TEST(DeskTest, NobodyLooksOnceTheLastWhoDidHasGone) {
  Rig rig;
  const std::uint32_t client = rig.join(Right::View);
  EXPECT_TRUE(rig.desk.hear_text(client, kLook, kNow));
  rig.desk.leave(client, kNow);
  EXPECT_FALSE(rig.camera.wishes.get().watched);
}

TEST(DeskTest, WhyNoPictureComesIsTold) {
  Rig rig;
  const std::uint32_t client = rig.join(Right::View);
  EXPECT_TRUE(rig.desk.hear_text(
      client, R"({"op":"subscribe","subscriptions":[{"id":6,"channelId":104}]})", kNow));
  rig.desk.publish(VideoShown{.at = kNow, .state = video::VideoState::PathFull}, 3);
  EXPECT_THAT(rig.next(client), HasSubstr("the path carries force only"));
}

const std::string kHeld = R"({"press":1,"held":true,"into_m":0.001,"x_m":0,"y_m":0})";

TEST(DeskTest, AClientIsToldWhoServesAndWhat) {
  Rig rig;
  const std::uint32_t client = rig.desk.join(Right::Control, kNow);
  const Json greeting = Json::parse(rig.next(client));
  EXPECT_EQ(greeting["op"].text(), "serverInfo");
  EXPECT_EQ(greeting["metadata"]["right"].text(), "control");
  const Json topics = Json::parse(rig.next(client));
  std::vector<std::string> names;
  for (const Json& one : topics["channels"].parts()) {
    names.emplace_back(*one.at_or_null("topic").text());
  }
  EXPECT_THAT(names,
              testing::UnorderedElementsAre("surgeon/tick_view",
                                            "surgeon/link",
                                            "surgeon/event",
                                            "surgeon/depth",
                                            "surgeon/map",
                                            "surgeon/map_cell",
                                            "surgeon/status",
                                            "surgeon/client",
                                            "surgeon/camera",
                                            "surgeon/camera_jpeg",
                                            "surgeon/video"));
  EXPECT_THAT(rig.next(client), HasSubstr("pointer/take"));
}

TEST(DeskTest, WhoOnlyLooksMayAskForNothing) {
  Rig rig;
  const std::uint32_t client = rig.join(Right::View);
  for (const char service : {'\1', '\2', '\3', '\4', '\5', '\6'}) {
    EXPECT_EQ(rig.call(client, service)["message"].text(), "this client may only look");
  }
  rig.publish_pointer(client);
  EXPECT_THAT(rig.next(client), HasSubstr("may not publish there"));
  EXPECT_TRUE(rig.point(client, kHeld));
  Request request;
  EXPECT_FALSE(rig.requests.try_dequeue(request));
  EXPECT_EQ(rig.stops.get(), 0U);
  EXPECT_FALSE(rig.pointer.get().held);
}

TEST(DeskTest, WithoutAControlledSiteNobodyIsInControl) {
  Desk desk{{.site = link::Role::Patient, .program = "p", .run = "r"}, {}};
  const std::uint32_t client = desk.join(Right::Control, kNow);
  EXPECT_THAT(desk.outbox(client).begin_first().body, HasSubstr(R"("right":"view")"));
  desk.outbox(client).pop();
  EXPECT_TRUE(desk.hear_bytes(client, "\x02\x02\0\0\0\x07\0\0\0\x04\0\0\0json{}"s, kNow));
}

TEST(DeskTest, AStopReachesTheLoopAtOnceAndTheProgram) {
  Rig rig;
  const std::uint32_t client = rig.join(Right::Control);
  EXPECT_EQ(rig.call(client, '\2')["ok"].truth(), true);
  EXPECT_EQ(rig.stops.get(), 1U);
  const Request request = rig.asked();
  EXPECT_EQ(request.kind, Request::Kind::Stop);
  EXPECT_EQ(request.client, client);
}

TEST(DeskTest, OnePilotAtATimeAndTheSecondIsToldWho) {
  Rig rig;
  const std::uint32_t first = rig.join(Right::Control), second = rig.join(Right::Control);
  EXPECT_EQ(rig.call(first, '\5', R"({"name":"Ann"})")["ok"].truth(), true);
  const Json refusal = rig.call(second, '\5');
  EXPECT_EQ(refusal["ok"].truth(), false);
  EXPECT_EQ(refusal["why"].text(), "client 1 (Ann) has the pointer");
  EXPECT_EQ(rig.call(second, '\6')["ok"].truth(), false) << "nor may it give what is not its own";
  EXPECT_EQ(rig.call(first, '\6')["ok"].truth(), true);
  EXPECT_EQ(rig.call(second, '\5')["ok"].truth(), true);
}

TEST(DeskTest, APilotThatGoesLetsGo) {
  Rig rig;
  const std::uint32_t client = rig.join(Right::Control);
  rig.publish_pointer(client);
  (void)rig.call(client, '\5');
  rig.desk.heard_pong(client, 1ms, kNow);
  ASSERT_TRUE(rig.point(client, kHeld));
  EXPECT_TRUE(rig.pointer.get().held);
  EXPECT_EQ(rig.pointer.get().into, 0.001);
  rig.desk.leave(client, kNow + kSecond);
  EXPECT_FALSE(rig.pointer.get().held);
  EXPECT_EQ(rig.desk.pilot(), 0U);
}

TEST(DeskTest, WhoIsNotThePilotMovesNothing) {
  Rig rig;
  const std::uint32_t pilot = rig.join(Right::Control), other = rig.join(Right::Control);
  rig.publish_pointer(other);
  (void)rig.call(pilot, '\5');
  rig.desk.heard_pong(other, 1ms, kNow);
  EXPECT_TRUE(rig.point(other, kHeld));
  EXPECT_FALSE(rig.pointer.get().held);
}

TEST(DeskTest, AQueueThatGrowsInAPressEndsItAndItsOwnerIsTold) {
  Rig rig;
  const std::uint32_t client = rig.join(Right::Control);
  rig.publish_pointer(client);
  (void)rig.call(client, '\5');
  rig.desk.heard_pong(client, 1ms, kNow);
  ASSERT_TRUE(rig.point(client, kHeld));
  ASSERT_TRUE(rig.pointer.get().held);
  rig.desk.awaits_pong(client, 60ms, kNow + 60ms);
  EXPECT_FALSE(rig.pointer.get().held);
  EXPECT_THAT(rig.next(client), HasSubstr("the hand was let go of"));
  ASSERT_TRUE(rig.point(client, kHeld));
  EXPECT_FALSE(rig.pointer.get().held);
}

TEST(DeskTest, EachClientIsToldOfItsOwnWay) {
  Rig rig;
  const std::uint32_t near = rig.join(Right::View), far = rig.join(Right::View);
  const std::string ask = R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":101}]})";
  for (const std::uint32_t one : {near, far}) EXPECT_TRUE(rig.desk.hear_text(one, ask, kNow));
  rig.desk.heard_pong(near, 2ms, kNow);
  EXPECT_THAT(rig.next(near), HasSubstr("\"round_trip_ms\":2.0"));
  EXPECT_EQ(rig.next(far), "");
  rig.desk.awaits_pong(far, 50ms, kNow);
  EXPECT_EQ(rig.next(far), "");
  rig.desk.awaits_pong(far, 110ms, kNow);
  EXPECT_THAT(rig.next(far), HasSubstr("\"round_trip_ms\":110.0"));
  rig.desk.awaits_pong(far, 120ms, kNow);
  EXPECT_EQ(rig.next(far), "") << "told ten times a second at most";
}

TEST(DeskTest, WhatTheProgramDoesNotTakeIsNotSaidToBeDone) {
  Rig rig;
  const std::uint32_t client = rig.join(Right::Control);
  while (rig.requests.try_enqueue({})) {
  }
  for (const char service : {'\1', '\3', '\4'}) {
    const Json answer = rig.call(client, service);
    EXPECT_EQ(answer["ok"].truth(), false);
    EXPECT_THAT(std::string{*answer["why"].text()}, HasSubstr("nothing was done"));
  }
  EXPECT_EQ(rig.call(client, '\2')["ok"].truth(), true) << "a stop goes to the loop by itself";
  EXPECT_EQ(rig.stops.get(), 1U);
}

LiveMessage event(std::uint64_t stamp) {
  LiveMessage message{.topic = record::Topic::Event, .stamp = stamp, .size = 1};
  message.bytes[0] = std::byte{1};
  return message;
}

TEST(DeskTest, WhoComesLateIsToldWhatHappened) {
  Rig rig;
  rig.desk.publish(event(1));
  rig.desk.publish(event(2));
  const std::uint32_t client = rig.join(Right::View);
  const std::string ask = R"({"op":"subscribe","subscriptions":[{"id":7,"channelId":)" +
                          std::to_string(static_cast<int>(record::Topic::Event) + 1) + "}]}";
  EXPECT_TRUE(rig.desk.hear_text(client, ask, kNow));
  EXPECT_EQ(rig.next(client), message_bytes(7, 1, event(1).payload()));
  EXPECT_EQ(rig.next(client), message_bytes(7, 2, event(2).payload()));
  rig.desk.publish(event(3));
  EXPECT_EQ(rig.next(client), message_bytes(7, 3, event(3).payload()));
  EXPECT_TRUE(rig.desk.hear_text(client, R"({"op":"unsubscribe","subscriptionIds":[7]})", kNow));
  rig.desk.publish(event(4));
  EXPECT_EQ(rig.next(client), "");
}

TEST(DeskTest, WhoComesLateGetsTheWholeStiffnessMapAndOldEvents) {
  Rig rig;
  rig.desk.publish(event(1));
  for (std::uint32_t i = 0; i < 2 * kMapCellsMax; ++i) {
    LiveMessage cell{.topic = record::Topic::MapCell, .stamp = 10 + i, .size = 1};
    rig.desk.publish(cell);
  }
  const std::uint32_t client = rig.join(Right::View);
  const auto ask = [](record::Topic topic) {
    return R"({"op":"subscribe","subscriptions":[{"id":)" +
           std::to_string(static_cast<int>(topic)) + R"(,"channelId":)" +
           std::to_string(static_cast<int>(topic) + 1) + "}]}";
  };
  EXPECT_TRUE(rig.desk.hear_text(client, ask(record::Topic::MapCell), kNow));
  std::uint32_t cells = 0;
  while (!rig.next(client).empty()) ++cells;
  EXPECT_EQ(cells, kMapCellsMax);
  EXPECT_TRUE(rig.desk.hear_text(client, ask(record::Topic::Event), kNow));
  EXPECT_FALSE(rig.next(client).empty()) << "cells crowd out no event";
}

TEST(DeskTest, AStalledClientKeepsTheNewestAndDisturbsNoOther) {
  Rig rig;
  const std::uint32_t stalled = rig.join(Right::View), quick = rig.join(Right::View);
  const std::string ask = R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":100}]})";
  for (const std::uint32_t one : {stalled, quick}) {
    EXPECT_TRUE(rig.desk.hear_text(one, ask, kNow));
  }
  LiveStatus status;
  for (int i = 1; i <= 5000; ++i) {
    status.stamp = static_cast<std::uint64_t>(i);
    rig.desk.publish(status);
    EXPECT_FALSE(rig.next(quick).empty());
  }
  EXPECT_LE(rig.desk.outbox(stalled).waiting(), Desk::kWaitingMax);
  EXPECT_GT(rig.desk.outbox(stalled).dropped(), 1000U);
  EXPECT_EQ(rig.desk.outbox(quick).dropped(), 0U);
  std::string last;
  for (std::string one = rig.next(stalled); !one.empty(); one = rig.next(stalled)) last = one;
  EXPECT_EQ(last.substr(1 + 4, 2), "\x88\x13"s) << "5000, the newest";
}

TEST(DeskTest, ThereAreSoManyClientsAndNoMore) {
  Rig rig;
  for (std::size_t i = 0; i < Desk::kClientsMax; ++i) {
    EXPECT_NE(rig.desk.join(Right::View, kNow), 0U);
  }
  EXPECT_EQ(rig.desk.join(Right::Control, kNow), 0U);
  rig.desk.leave(1, kNow);
  EXPECT_NE(rig.desk.join(Right::View, kNow), 0U);
  EXPECT_EQ(rig.desk.join(Right::None, kNow), 0U);
}

TEST(DeskTest, WhoTalksTooMuchIsToBeClosed) {
  Rig rig;
  const std::uint32_t client = rig.join(Right::Control);
  int heard = 0;
  while (rig.desk.hear_text(client, "{}", kNow) && heard < 1000) ++heard;
  EXPECT_EQ(heard, static_cast<int>(Desk::kMessagesPerSecond));
  EXPECT_TRUE(rig.desk.hear_text(client, "{}", kNow + 100ms)) << "a pause makes up for it";
}

TEST(DeskTest, WhatIsNoChannelOrSubscribedTwiceIsRefused) {
  Rig rig;
  const std::uint32_t client = rig.join(Right::View);
  const std::string twice =
      R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":100},{"id":1,"channelId":100}]})";
  EXPECT_TRUE(rig.desk.hear_text(client, twice, kNow));
  EXPECT_THAT(rig.next(client), HasSubstr("this subscription exists"));
  EXPECT_TRUE(rig.desk.hear_text(
      client, R"({"op":"subscribe","subscriptions":[{"id":2,"channelId":1}]})", kNow));
  EXPECT_THAT(rig.next(client), HasSubstr("no such channel")) << "the 1 kHz ones are in the file";
}

RC_GTEST_PROP(DeskTest, AnyBytesOfAClientAreSurvived, (const std::vector<std::string>& said)) {
  Rig rig;
  const std::uint32_t client = rig.join(Right::Control);
  rig.publish_pointer(client);
  TimePoint now = kNow;
  for (const std::string& one : said) {
    now += kSecond;
    RC_ASSERT(rig.desk.hear_text(client, one, now));
    for (const char kind : {'\x01', '\x02'}) {
      RC_ASSERT(rig.desk.hear_bytes(client, kind + one, now));
      RC_ASSERT(rig.desk.hear_bytes(client, kind + "\x05\0\0\0\0\0\0\0\x04\0\0\0json"s + one, now));
    }
    LiveStatus status;
    status.stamp = static_cast<std::uint64_t>(now.time_since_epoch().count());
    rig.desk.publish(status);
  }
}

}  // namespace
}  // namespace palp::monitor
