#include "monitor/pilot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp::monitor {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

std::string held(int press, double into = 0) {
  return R"({"press":)" + std::to_string(press) + R"(,"held":true,"into_m":)" +
         std::to_string(into) + R"(,"x_m":0,"y_m":0})";
}
std::string up(int press) {
  return R"({"press":)" + std::to_string(press) + R"(,"held":false,"into_m":0,"x_m":0,"y_m":0})";
}

/// Client 1 has the pointer and answers within 2 ms.
Pilot piloted() {
  Pilot pilot;
  EXPECT_TRUE(pilot.take(1, "one"));
  (void)pilot.heard_pong(1, 2ms, {});
  return pilot;
}

TEST(PilotTest, OneAtATime) {
  Pilot pilot = piloted();
  EXPECT_FALSE(pilot.take(2, "two"));
  EXPECT_EQ(pilot.name(), "one");
  EXPECT_FALSE(pilot.give(2));
  EXPECT_TRUE(pilot.give(1));
  EXPECT_TRUE(pilot.take(2, "two"));
}

TEST(PilotTest, OnlyThePilotsPointerIsHeard) {
  Pilot pilot = piloted();
  EXPECT_FALSE(pilot.hear(2, held(1), {}));
  const auto report = pilot.hear(1, held(1, 0.004), TimePoint{3s});
  ASSERT_TRUE(report);
  EXPECT_TRUE(report->held);
  EXPECT_EQ(report->into, 0.004);
  EXPECT_EQ(report->arrived_at, TimePoint{3s});
}

TEST(PilotTest, APressThatIsOverNeverComesBack) {
  Pilot pilot = piloted();
  const auto first = pilot.hear(1, held(1), {});
  const auto second = pilot.hear(1, held(2), {});
  EXPECT_EQ(second->press, first->press + 1);
  EXPECT_FALSE(pilot.hear(1, held(1), {})) << "a late message of an earlier one";
  EXPECT_FALSE(pilot.hear(1, up(2), {})->held);
}

TEST(PilotTest, PressesOfTwoPilotsAreNotTakenForOne) {
  Pilot pilot = piloted();
  const auto of_first = pilot.hear(1, held(1), {});
  ASSERT_TRUE(pilot.give(1));
  EXPECT_FALSE(pilot.let_go({}).held);
  ASSERT_TRUE(pilot.take(2, ""));
  (void)pilot.heard_pong(2, 2ms, {});
  EXPECT_GT(pilot.hear(2, held(1), {})->press, of_first->press);
}

TEST(PilotTest, NoPressBeginsOverALongWay) {
  Pilot pilot;
  ASSERT_TRUE(pilot.take(1, ""));
  EXPECT_FALSE(pilot.hear(1, held(1), {})->held) << "not measured yet";
  for (int i = 0; i < 50; ++i) (void)pilot.heard_pong(1, i < 46 ? 10ms : 60ms, {});
  EXPECT_FALSE(pilot.obstacle().empty());
  (void)pilot.heard_pong(1, 10ms, {});
  EXPECT_FALSE(pilot.obstacle().empty()) << "four of fifty were late";
  EXPECT_FALSE(pilot.hear(1, held(2), {})->held);
  for (int i = 0; i < 50; ++i) (void)pilot.heard_pong(1, i < 2 ? 60ms : 10ms, {});
  EXPECT_TRUE(pilot.obstacle().empty()) << "two were";
  EXPECT_FALSE(pilot.hear(1, held(2), {})->held) << "a press that was refused stays so";
  EXPECT_TRUE(pilot.hear(1, held(3), {})->held);
}

TEST(PilotTest, AnAnswerThatIsWaitedForCountsByItsAge) {
  Pilot pilot = piloted();
  (void)pilot.awaits_pong(1, 50ms, {});
  EXPECT_TRUE(pilot.obstacle().empty());
  (void)pilot.awaits_pong(1, 51ms, {});
  EXPECT_EQ(pilot.round_trip(), 51ms);
  EXPECT_FALSE(pilot.hear(1, held(1), {})->held);
  (void)pilot.awaits_pong(2, 0ms, {});
  EXPECT_FALSE(pilot.obstacle().empty()) << "another's";
  (void)pilot.heard_pong(1, 10ms, {});
  EXPECT_TRUE(pilot.obstacle().empty());
}

TEST(PilotTest, TheNewestLateOneIsEnoughToWait) {
  Pilot pilot = piloted();
  for (int i = 0; i < 48; ++i) (void)pilot.heard_pong(1, 2ms, {});
  (void)pilot.heard_pong(1, 3s, {});
  EXPECT_FALSE(pilot.obstacle().empty());
}

TEST(PilotTest, ALongWayEndsAPressThatIsInProgress) {
  Pilot pilot = piloted();
  const auto down = pilot.hear(1, held(1, 0.004), {});
  ASSERT_TRUE(down->held);
  EXPECT_FALSE(pilot.heard_pong(1, 50ms, {}));
  EXPECT_FALSE(pilot.awaits_pong(1, 50ms, {}));
  const auto ended = pilot.awaits_pong(1, 51ms, TimePoint{3s});
  ASSERT_TRUE(ended);
  EXPECT_FALSE(ended->held);
  EXPECT_EQ(ended->press, down->press);
  EXPECT_EQ(ended->arrived_at, TimePoint{3s});
  EXPECT_FALSE(pilot.awaits_pong(1, 60ms, {})) << "it is told once";
  (void)pilot.heard_pong(1, 10ms, {});
  EXPECT_FALSE(pilot.hear(1, held(1), {})->held) << "it never comes back";
  EXPECT_TRUE(pilot.hear(1, held(2), {})->held);
  EXPECT_TRUE(pilot.heard_pong(1, 60ms, {})) << "an answer that came late does the same";
}

TEST(PilotTest, ThePressOfWhoHadItBeforeIsNotEnded) {
  Pilot pilot = piloted();
  ASSERT_TRUE(pilot.hear(1, held(1), {})->held);
  ASSERT_TRUE(pilot.give(1));
  ASSERT_TRUE(pilot.take(2, ""));
  EXPECT_FALSE(pilot.awaits_pong(2, 1s, {}));
}

TEST(PilotTest, WhatIsNoPointersMessageChangesNothing) {
  Pilot pilot = piloted();
  for (const char* bad : {"",
                          "{}",
                          "[1]",
                          R"({"press":1,"held":1,"into_m":0,"x_m":0,"y_m":0})",
                          R"({"press":-1,"held":true,"into_m":0,"x_m":0,"y_m":0})",
                          R"({"press":1e12,"held":true,"into_m":0,"x_m":0,"y_m":0})",
                          R"({"press":1,"held":true,"into_m":null,"x_m":0,"y_m":0})",
                          R"({"press":1,"held":true,"into_m":1.1,"x_m":0,"y_m":0})",
                          R"({"press":1,"held":true,"into_m":0,"x_m":1e999,"y_m":0})",
                          R"({"press":1,"held":true,"into_m":0,"x_m":0})"}) {
    EXPECT_FALSE(pilot.hear(1, bad, {})) << bad;
  }
}

RC_GTEST_PROP(PilotTest, AnyMessageIsReadOrRefused, (const std::string& any)) {
  Pilot pilot;
  (void)pilot.take(1, any);
  RC_ASSERT(pilot.name().size() <= 83);
  (void)pilot.hear(1, any, {});
}

}  // namespace
}  // namespace palp::monitor
