#include "monitor/study_screen.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/json.h"
#include "monitor/desk.h"
#include "monitor/offers.h"
#include "tests/monitor/next_frame.h"

namespace palp::monitor {
namespace {

using config::Json;
using testing::HasSubstr;
using namespace std::string_literals;

constexpr TimePoint kNow{std::chrono::seconds{100}};
constexpr const char* kFollow = R"({"op":"subscribe","subscriptions":[{"id":3,"channelId":105}]})";

/// A desk whose surgeon is a participant.
struct Rig {
  SpscQueue<Request> requests{64};
  StudyScreen study;
  Desk desk{{.site = link::Role::Surgeon, .program = "palp-surgeon", .run = "r"},
            {.requests = &requests, .study = &study}};

  std::string next(std::uint32_t client) { return next_frame(desk, client); }
  std::uint32_t join(Right right) {
    const std::uint32_t client = desk.join(right, kNow);
    EXPECT_THAT(next(client), HasSubstr(R"("study":"yes")"));
    while (!next(client).empty()) {
    }
    return client;
  }
  /// Empty: it was taken.
  std::string answer(std::uint32_t client, const std::string& request) {
    const std::string bytes = "\x02\x07\0\0\0\x09\0\0\0\x04\0\0\0json"s + request;
    EXPECT_TRUE(desk.hear_bytes(client, bytes, kNow));
    const std::string said = next(client);
    if (said.starts_with('{')) return std::string{*Json::parse(said)["message"].text()};
    return std::string{*Json::parse(said.substr(17))["why"].text()};
  }
};

TEST(StudyScreenTest, WhatIsShownReachesThePageAndWhoComesLate) {
  Rig rig;
  const std::uint32_t early = rig.join(Right::Control);
  EXPECT_TRUE(rig.desk.hear_text(early, kFollow, kNow));
  rig.desk.publish_study();
  EXPECT_EQ(rig.next(early), "");
  EXPECT_TRUE(rig.study.shown.try_enqueue(R"({"stage":"press"})"));
  EXPECT_TRUE(rig.study.shown.try_enqueue(R"({"stage":"touch"})"));
  rig.desk.publish_study();
  EXPECT_THAT(rig.next(early), HasSubstr("press"));
  EXPECT_THAT(rig.next(early), HasSubstr("touch"));
  const std::uint32_t late = rig.join(Right::View);
  EXPECT_TRUE(rig.desk.hear_text(late, kFollow, kNow));
  EXPECT_THAT(rig.next(late), HasSubstr("touch"));
  EXPECT_EQ(rig.next(late), "");
}

TEST(StudyScreenTest, AnAnswerIsPassedOnWithItsInstant) {
  Rig rig;
  const std::uint32_t client = rig.join(Right::Control);
  EXPECT_EQ(rig.answer(client, R"({"trial":7,"choice":2})"), "");
  StudyAnswer answer;
  ASSERT_TRUE(rig.study.answers.try_dequeue(answer));
  EXPECT_EQ(answer.trial, 7U);
  EXPECT_EQ(answer.choice, 2U);
  EXPECT_EQ(answer.at, kNow);
}

TEST(StudyScreenTest, WhoOnlyLooksDoesNotAnswerAndNonsenseIsNone) {
  Rig rig;
  EXPECT_EQ(rig.answer(rig.join(Right::View), R"({"trial":7,"choice":2})"),
            "this client may only look");
  const std::uint32_t client = rig.join(Right::Control);
  for (const char* wrong : {"{}",
                            R"({"trial":7})",
                            R"({"trial":0,"choice":1})",
                            R"({"trial":7,"choice":1.7})",
                            R"({"trial":7.5,"choice":1})",
                            "[]",
                            "x"}) {
    EXPECT_EQ(rig.answer(client, wrong), "this answer names no trial or no choice") << wrong;
  }
  StudyAnswer answer;
  EXPECT_FALSE(rig.study.answers.try_dequeue(answer));
}

TEST(StudyScreenTest, AFullQueueIsToldAndNobodyWaits) {
  Rig rig;
  const std::uint32_t client = rig.join(Right::Control);
  while (rig.study.answers.try_enqueue({})) {
  }
  EXPECT_EQ(rig.answer(client, R"({"trial":7,"choice":2})"),
            "the study has not taken the answers before this one");
}

}  // namespace
}  // namespace palp::monitor
