#include "monitor/outbox.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp::monitor {
namespace {

Frame passing(const std::string& body) { return {.text = false, .passing = true, .body = body}; }
Frame answer(const std::string& body) { return {.text = true, .passing = false, .body = body}; }

TEST(OutboxTest, TheNewestWinsAndAnswersStay) {
  Outbox box{10};
  box.push(answer("aaaa"));
  for (const char* one : {"1111", "2222", "3333"}) box.push(passing(one));
  EXPECT_EQ(box.dropped(), 2U);
  EXPECT_EQ(box.begin_first().body, "aaaa");
  box.pop();
  EXPECT_EQ(box.begin_first().body, "3333");
  box.pop();
  EXPECT_TRUE(box.empty());
  EXPECT_EQ(box.waiting(), 0U);
}

TEST(OutboxTest, WhatIsOnItsWayIsNotTakenAway) {
  Outbox box{10};
  box.push(passing("1111"));
  const Frame& under_way = box.begin_first();
  for (int i = 0; i < 100; ++i) box.push(passing("2222"));
  EXPECT_EQ(under_way.body, "1111");
  box.pop();
  EXPECT_EQ(box.begin_first().body, "2222");
}

TEST(OutboxTest, AClientThatTakesNoAnswersIsHopeless) {
  Outbox box{10};
  for (int i = 0; i < 5; ++i) box.push(answer("aaaa"));
  EXPECT_FALSE(box.hopeless());
  box.push(answer("a"));
  EXPECT_TRUE(box.hopeless());
}

TEST(OutboxTest, NorMayManySmallAnswersPileUp) {
  Outbox box{1024 * 1024};
  for (std::size_t i = 0; i < Outbox::kStayingMax; ++i) box.push(answer("a"));
  for (int i = 0; i < 10; ++i) box.push(passing("b"));
  EXPECT_FALSE(box.hopeless()) << "what gives way does not count";
  box.push(answer("a"));
  EXPECT_TRUE(box.hopeless());
  (void)box.begin_first();
  box.pop();
  EXPECT_FALSE(box.hopeless());
}

Frame picture(const std::string& body) {
  return {.text = false, .passing = true, .chained = true, .body = body};
}

TEST(OutboxTest, APictureThatGivesWayTakesAlongWhatRestsOnIt) {
  Outbox box{20};
  for (const char* one : {"p1p1", "p2p2", "p3p3"}) box.push(picture(one));
  EXPECT_FALSE(box.take_broken());
  (void)box.begin_first();
  box.push(passing("1111222233334444"));
  EXPECT_TRUE(box.take_broken());
  EXPECT_FALSE(box.take_broken()) << "told once";
  EXPECT_EQ(box.dropped(), 2U);
  EXPECT_EQ(box.begin_first().body, "p1p1") << "what is on its way stays";
  box.pop();
  EXPECT_EQ(box.begin_first().body, "1111222233334444");
}

TEST(OutboxTest, PicturesDoNotPileUpBeforeAClientThatIsSlow) {
  Outbox box{1024 * 1024};
  for (std::size_t i = 0; i < Outbox::kChainedMax; ++i) box.push(picture("p"));
  EXPECT_FALSE(box.take_broken());
  box.push(picture("p"));
  EXPECT_TRUE(box.take_broken());
  EXPECT_TRUE(box.empty());
  box.push(picture("k"));
  EXPECT_FALSE(box.take_broken());
}

RC_GTEST_PROP(OutboxTest,
              NeverHoldsMoreThanItsBoundAndTheNewest,
              (const std::vector<std::string>& all)) {
  Outbox box{64};
  for (const std::string& one : all) {
    box.push(passing(one));
    RC_ASSERT(box.waiting() <= std::max<std::size_t>(64, one.size()));
  }
  std::string last;
  while (!box.empty()) {
    last = box.begin_first().body;
    box.pop();
  }
  const bool newest = all.empty() || last == all.back();
  RC_ASSERT(newest);
}

}  // namespace
}  // namespace palp::monitor
