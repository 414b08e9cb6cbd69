#include <array>
#include <cstdint>
#include <thread>

#include <gtest/gtest.h>

#include "common/core/mailbox.h"
#include "common/core/spsc_queue.h"
#include "tests/support/realtime_guard.h"

namespace palp {
namespace {

/// Torn if the words differ.
struct Wide {
  std::array<std::uint64_t, 8> words{};
};

Wide wide(std::uint64_t number) {
  Wide value;
  value.words.fill(number);
  return value;
}

/// Number of a value that is whole; fails the test otherwise.
std::uint64_t whole_number(const Wide& value) {
  for (const std::uint64_t word : value.words) EXPECT_EQ(word, value.words[0]) << "torn";
  return value.words[0];
}

TEST(MailboxTest, HoldsADefaultValueBeforeTheFirstPut) {
  Mailbox<Wide> mailbox;
  EXPECT_EQ(whole_number(mailbox.get()), 0U);
}

TEST(MailboxTest, NewestWinsAndStays) {
  Mailbox<Wide> mailbox;
  for (std::uint64_t number = 1; number <= 5; ++number) mailbox.put(wide(number));
  EXPECT_EQ(whole_number(mailbox.get()), 5U);
  EXPECT_EQ(whole_number(mailbox.get()), 5U);
  mailbox.put(wide(6));
  EXPECT_EQ(whole_number(mailbox.get()), 6U);
}

TEST(MailboxTest, WhatTheReaderHoldsIsNotOverwritten) {
  Mailbox<Wide> mailbox;
  mailbox.put(wide(1));
  const Wide& held = mailbox.get();
  for (std::uint64_t number = 2; number <= 9; ++number) mailbox.put(wide(number));
  EXPECT_EQ(whole_number(held), 1U);
  EXPECT_EQ(whole_number(mailbox.get()), 9U);
}

TEST(MailboxTest, AlternatingPutAndGetLosesNothing) {
  Mailbox<Wide> mailbox;
  for (std::uint64_t number = 1; number <= 100; ++number) {
    mailbox.put(wide(number));
    EXPECT_EQ(whole_number(mailbox.get()), number);
  }
}

TEST(MailboxTest, AcrossThreadsNeverTornNeverBackwardsAndTheLastArrives) {
  constexpr std::uint64_t kLast = 50'000;
  Mailbox<Wide> mailbox;  // writer: the other thread, reader: this one
  std::thread writer{[&] {
    for (std::uint64_t number = 1; number <= kLast; ++number) mailbox.put(wide(number));
  }};
  std::uint64_t seen = 0;
  while (seen < kLast) {
    const std::uint64_t number = whole_number(mailbox.get());
    ASSERT_GE(number, seen);
    seen = number;
  }
  writer.join();
}

TEST(MailboxTest, PutAndGetAreFitForRealTime) {
  Mailbox<Wide> mailbox;
  test::RealtimeGuard guard;
  for (std::uint64_t number = 0; number < 100; ++number) {
    mailbox.put(wide(number));
    static_cast<void>(mailbox.get());
  }
  guard.release();
  EXPECT_TRUE(guard.clean()) << guard.first_violation();
}

TEST(SpscQueueTest, KeepsOrderAndAnswersFalseWhenFullAndWhenEmpty) {
  SpscQueue<int> queue{15};
  int number = 0;
  EXPECT_FALSE(queue.try_dequeue(number));
  int taken = 0;
  while (queue.try_enqueue(taken)) ++taken;
  EXPECT_GE(taken, 15);
  for (int expected = 0; expected < taken; ++expected) {
    ASSERT_TRUE(queue.try_dequeue(number));
    EXPECT_EQ(number, expected);
  }
  EXPECT_FALSE(queue.try_dequeue(number));
}

TEST(SpscQueueTest, TryCallsAreFitForRealTimeAlsoWhenFull) {
  SpscQueue<Wide> queue{8};
  Wide value;
  test::RealtimeGuard guard;
  for (int round = 0; round < 3; ++round) {
    while (queue.try_enqueue(value)) {
    }
    while (queue.try_dequeue(value)) {
    }
  }
  guard.release();
  EXPECT_TRUE(guard.clean()) << guard.first_violation();
}

TEST(SpscQueueTest, AcrossThreadsEveryItemArrivesOnceInOrder) {
  constexpr std::uint64_t kLast = 50'000;
  SpscQueue<Wide> queue{64};  // writer: the other thread, reader: this one
  std::thread writer{[&] {
    for (std::uint64_t number = 1; number <= kLast;) {
      if (queue.try_enqueue(wide(number))) {
        ++number;
      } else {
        std::this_thread::yield();
      }
    }
  }};
  Wide value;
  for (std::uint64_t expected = 1; expected <= kLast;) {
    if (!queue.try_dequeue(value)) {
      std::this_thread::yield();
      continue;
    }
    ASSERT_EQ(whole_number(value), expected);
    ++expected;
  }
  writer.join();
}

}  // namespace
}  // namespace palp
