#include "tests/support/realtime_guard.h"

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

namespace palp::test {
namespace {

struct Finding {
  std::uint64_t count{};
  std::string first;
};

Finding watched(const std::function<void()>& action) {
  RealtimeGuard guard;
  action();
  guard.release();
  return {guard.count(), guard.first_violation()};
}

/// Caught, and named first; nothing under a sanitizer, where the guard is off.
void expect_caught(const std::string& function, const std::function<void()>& action) {
  const Finding finding = watched(action);
  if (RealtimeGuard::kArmed) {
    EXPECT_EQ(finding.first.substr(0, finding.first.find(',')), function) << finding.first;
  } else {
    EXPECT_EQ(finding.count, 0U);
  }
}

/// Keeps the compiler from leaving an allocation out.
void keep(const void* memory) { asm volatile("" : : "r"(memory) : "memory"); }

TEST(RealtimeGuardTest, ArithmeticIsClean) {
  double sum = 0;
  EXPECT_EQ(watched([&] {
              for (int i = 0; i < 1000; ++i) sum += i;
            }).count,
            0U);
  EXPECT_EQ(sum, 499500);
}

TEST(RealtimeGuardTest, CatchesAPlantedAllocation) {
  std::unique_ptr<int> made;
  expect_caught("malloc", [&] {
    made = std::make_unique<int>(1);
    keep(made.get());
  });
}

TEST(RealtimeGuardTest, CatchesAllocationInsideTheStandardLibrary) {
  std::vector<int> numbers;
  expect_caught("malloc", [&] {
    numbers.push_back(1);
    keep(numbers.data());
  });
  std::string text{"short"};
  expect_caught("malloc", [&] {
    text.append(100, 'x');
    keep(text.data());
  });
}

TEST(RealtimeGuardTest, CatchesEveryWayToAskForMemory) {
  void* memory = nullptr;
  expect_caught("calloc", [&] { keep(memory = std::calloc(2, 8)); });
  expect_caught("realloc", [&] { keep(memory = std::realloc(memory, 100)); });
  expect_caught("free", [&] { std::free(memory); });
  expect_caught("aligned_alloc", [&] { keep(memory = std::aligned_alloc(64, 64)); });
  std::free(memory);
  expect_caught("posix_memalign", [&] {
    if (posix_memalign(&memory, 64, 64) != 0) memory = nullptr;
    keep(memory);
  });
  std::free(memory);
}

TEST(RealtimeGuardTest, FreeingNothingIsClean) {
  EXPECT_EQ(watched([] { std::free(nullptr); }).count, 0U);
}

TEST(RealtimeGuardTest, CatchesAPlantedLock) {
  std::mutex mutex;
  expect_caught("pthread_mutex_lock", [&] { const std::scoped_lock lock{mutex}; });
  expect_caught("pthread_mutex_trylock", [&] {
    if (mutex.try_lock()) mutex.unlock();
  });
}

TEST(RealtimeGuardTest, CatchesAWaitForACondition) {
  std::mutex mutex;
  std::condition_variable condition;
  std::unique_lock lock{mutex};
  expect_caught("pthread_cond_clockwait",
                [&] { condition.wait_for(lock, std::chrono::nanoseconds{1}); });
}

TEST(RealtimeGuardTest, WaitsStillWorkWhileWatched) {
  std::mutex mutex;
  std::condition_variable condition;
  bool ready = false;
  std::thread other{[&] {
    const std::scoped_lock lock{mutex};
    ready = true;
    condition.notify_one();
  }};
  {
    const RealtimeGuard guard;
    std::unique_lock lock{mutex};
    condition.wait(lock, [&] { return ready; });
  }
  other.join();
  EXPECT_TRUE(ready);
}

TEST(RealtimeGuardTest, CatchesAPlantedSleep) {
  expect_caught("clock_nanosleep", [] {
    const timespec span{0, 1};
    clock_nanosleep(CLOCK_MONOTONIC, 0, &span, nullptr);
  });
  expect_caught("nanosleep", [] { std::this_thread::sleep_for(std::chrono::nanoseconds{1}); });
  expect_caught("usleep", [] { usleep(1); });
}

TEST(RealtimeGuardTest, CatchesAPlantedThrow) {
  bool caught = false;
  expect_caught("throw", [&] {
    try {
      throw std::runtime_error{"planted"};
    } catch (const std::runtime_error&) {
      caught = true;
    }
  });
  EXPECT_TRUE(caught);
}

TEST(RealtimeGuardTest, CatchesAThrowOfTheStandardLibrary) {
  const std::vector<int> none;
  expect_caught("throw", [&] {
    try {
      keep(&none.at(3));
    } catch (const std::out_of_range&) {
    }
  });
}

TEST(RealtimeGuardTest, BlockingSocketIsCaughtAndNonBlockingOneIsClean) {
  std::array<int, 2> ends{};
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_DGRAM, 0, ends.data()), 0);
  char byte = 'x';
  expect_caught("send", [&] { EXPECT_EQ(send(ends[0], &byte, 1, 0), 1); });
  expect_caught("read", [&] { EXPECT_EQ(read(ends[1], &byte, 1), 1); });
  EXPECT_EQ(watched([&] { send(ends[0], &byte, 1, MSG_DONTWAIT); }).count, 0U);
  ASSERT_EQ(fcntl(ends[1], F_SETFL, O_NONBLOCK), 0);
  ssize_t size = 0;
  EXPECT_EQ(watched([&] { size = recv(ends[1], &byte, 1, 0); }).count, 0U);
  EXPECT_EQ(size, 1);
  close(ends[0]);
  close(ends[1]);
}

TEST(RealtimeGuardTest, CatchesFilesAndText) {
  int descriptor = -1;
  expect_caught("open", [&] { descriptor = open("/dev/null", O_WRONLY); });
  close(descriptor);
  expect_caught("fflush", [] { std::fflush(stderr); });
}

TEST(RealtimeGuardTest, AnotherThreadsDoingsAreNotCounted) {
  std::mutex mutex;
  int made = 0;
  std::atomic<bool> watching{false};
  std::thread other{[&] {
    while (!watching) std::this_thread::yield();
    const std::scoped_lock lock{mutex};
    made = *std::make_unique<int>(7);
    watching = false;
  }};
  RealtimeGuard guard;
  watching = true;
  while (watching) {
  }
  guard.release();
  other.join();
  EXPECT_EQ(made, 7);
  EXPECT_TRUE(guard.clean()) << guard.first_violation();
}

TEST(RealtimeGuardTest, CountsEachAndNamesTheFirst) {
  const Finding finding = watched([] {
    usleep(1);
    for (int i = 0; i < 3; ++i) keep(std::make_unique<int>(i).get());
  });
  EXPECT_EQ(finding.count, RealtimeGuard::kArmed ? 7U : 0U);
  EXPECT_EQ(finding.first.starts_with("usleep"), RealtimeGuard::kArmed);
}

TEST(RealtimeGuardTest, NothingCountsBeforeAfterOrInAPause) {
  keep(std::make_unique<int>(1).get());
  RealtimeGuard guard;
  {
    const RealtimeGuard::Pause pause;
    keep(std::make_unique<int>(2).get());
    const RealtimeGuard::Pause inner;
    keep(std::make_unique<int>(2).get());
  }
  guard.release();
  keep(std::make_unique<int>(3).get());
  EXPECT_TRUE(guard.clean()) << guard.first_violation();
}

TEST(RealtimeGuardTest, TheInnermostGuardCounts) {
  RealtimeGuard outer;
  RealtimeGuard inner;
  usleep(1);
  inner.release();
  EXPECT_TRUE(outer.clean());
  usleep(1);
  outer.release();
  EXPECT_EQ(inner.clean(), !RealtimeGuard::kArmed);
  EXPECT_EQ(outer.count(), inner.count());
}

}  // namespace
}  // namespace palp::test
