#include "video/receiver.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp::video {
namespace {

using std::chrono::milliseconds;

/// Frame `number` of `size` bytes, cut into `count` and `spare` fragments, each a payload.
std::vector<Bytes> cut(std::uint32_t number,
                       std::uint16_t back,
                       std::size_t count,
                       std::size_t spare) {
  const std::size_t each = 50;
  std::vector<Bytes> parts;
  for (std::size_t i = 0; i < count; ++i) {
    parts.emplace_back(each, static_cast<std::byte>(number * 16 + i));
  }
  for (Bytes& one : make_parity(parts, spare)) parts.push_back(std::move(one));
  std::vector<Bytes> payloads;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    payloads.push_back(write(Fragment{.key = back == 0,
                                      .frame = number,
                                      .refers_back = back,
                                      .captured_ns = number * 33'000'000ULL,
                                      .size = static_cast<std::uint32_t>(count * each),
                                      .data_count = static_cast<std::uint8_t>(count),
                                      .parity_count = static_cast<std::uint8_t>(spare),
                                      .index = static_cast<std::uint8_t>(i),
                                      .data = parts[i]}));
  }
  return payloads;
}

std::optional<ReceivedFrame> hear_all(Receiver& receiver, const std::vector<Bytes>& payloads) {
  std::optional<ReceivedFrame> shown;
  for (const Bytes& one : payloads) {
    if (auto frame = receiver.hear(one, TimePoint{})) shown = std::move(frame);
  }
  return shown;
}

TEST(ReceiverTest, AFrameIsDeliveredOnceAndAtOnce) {
  Receiver receiver;
  std::vector<Bytes> payloads = cut(0, 0, 3, 2);
  payloads.erase(payloads.begin() + 1);
  EXPECT_FALSE(receiver.hear(payloads[0], TimePoint{}));
  EXPECT_FALSE(receiver.hear(payloads[1], TimePoint{}));
  const auto frame = receiver.hear(payloads[2], TimePoint{});
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->bytes.size(), 150U);
  EXPECT_EQ(frame->bytes[50], std::byte{1});
  EXPECT_FALSE(receiver.hear(payloads[3], TimePoint{}));
  EXPECT_EQ(receiver.counts().repaired, 1U);
}

TEST(ReceiverTest, NothingIsShownWhoseReferenceWasNot) {
  Receiver receiver;
  EXPECT_TRUE(hear_all(receiver, cut(0, 0, 2, 0)));
  EXPECT_FALSE(hear_all(receiver, cut(2, 1, 2, 0))) << "frame 1 is missing";
  EXPECT_TRUE(receiver.report({}).wants_recovery);
  EXPECT_TRUE(hear_all(receiver, cut(5, 5, 2, 0))) << "it refers to frame 0";
  EXPECT_FALSE(receiver.report({}).wants_recovery);
  EXPECT_EQ(receiver.counts().undecodable, 1U);
}

TEST(ReceiverTest, AnOlderFrameNeverFollowsANewer) {
  Receiver receiver;
  EXPECT_TRUE(hear_all(receiver, cut(0, 0, 2, 0)));
  EXPECT_TRUE(hear_all(receiver, cut(3, 0, 2, 0)));
  EXPECT_FALSE(hear_all(receiver, cut(1, 1, 2, 0)));
}

TEST(ReceiverTest, TheReportNamesWhatWasDelivered) {
  Receiver receiver;
  EXPECT_EQ(receiver.report({}).newest_delivered, Report::kNone);
  EXPECT_TRUE(receiver.report({}).wants_key);
  (void)hear_all(receiver, cut(0, 0, 1, 0));
  (void)hear_all(receiver, cut(1, 1, 1, 0));
  (void)hear_all(receiver, cut(4, 0, 1, 0));
  const Report report =
      receiver.report({.standing = milliseconds{3}, .expected = 100, .arrived = 90});
  EXPECT_FALSE(report.wants_key);
  EXPECT_EQ(report.newest_delivered, 4U);
  EXPECT_EQ(report.delivered_before, 0b11001U);
  EXPECT_EQ(report.standing_10us, 300);
  EXPECT_NEAR(report.lost / 65535.0, 0.1, 1e-4);
}

TEST(ReceiverTest, AFragmentThatContradictsItsFrameIsRefused) {
  Receiver receiver;
  (void)receiver.hear(cut(0, 0, 3, 0)[0], TimePoint{});
  EXPECT_FALSE(hear_all(receiver, cut(0, 0, 2, 1)));
  EXPECT_EQ(receiver.counts().malformed, 3U);
}

TEST(ReceiverTest, QuestionsAndWordsAreHeard) {
  Receiver receiver;
  EXPECT_EQ(receiver.peer_state(), VideoState::Silent);
  (void)receiver.hear(write(Question{99}), TimePoint{});
  (void)receiver.hear(write(Word{VideoState::PathFull}), TimePoint{});
  EXPECT_EQ(receiver.take_challenge(), 99U);
  EXPECT_EQ(receiver.take_challenge(), 0U);
  EXPECT_EQ(receiver.peer_state(), VideoState::PathFull);
}

RC_GTEST_PROP(ReceiverTest, AnyFragmentsInAnyOrderKeepItsRules, ()) {
  Receiver receiver;
  std::optional<std::uint32_t> newest;
  for (int i = 0; i < 200; ++i) {
    const auto number = *rc::gen::inRange<std::uint32_t>(0, 40);
    const auto back = static_cast<std::uint16_t>(*rc::gen::inRange(0, 3));
    if (back > number) continue;
    const auto payloads = cut(number, back, 2, 1);
    const auto& one = payloads[*rc::gen::inRange<std::size_t>(0, payloads.size())];
    const auto frame = receiver.hear(one, TimePoint{milliseconds{i}});
    if (!frame) continue;
    RC_ASSERT(!newest || frame->number > *newest);
    RC_ASSERT(frame->bytes[0] == static_cast<std::byte>(number * 16));
    newest = frame->number;
    (void)receiver.report({});
  }
}

}  // namespace
}  // namespace palp::video
