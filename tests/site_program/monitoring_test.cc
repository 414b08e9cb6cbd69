#include "site_program/monitoring.h"

#include <array>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <new>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pthread.h>

#include "common/io/process/diagnostics.h"
#include "common/io/realtime/steady_clock.h"
#include "tests/monitor/raw_client.h"

// Memory of C++ in this binary, which may run out for the monitor's thread alone.
namespace {
std::atomic<bool> monitor_starves{false};

void* fed(std::size_t size) {
  std::array<char, 16> name{};
  if (monitor_starves && pthread_getname_np(pthread_self(), name.data(), name.size()) == 0 &&
      std::string_view{name.data()} == "palp-monitor") {
    throw std::bad_alloc{};
  }
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc{};
}
}  // namespace

void* operator new(std::size_t size) { return fed(size); }
void* operator new[](std::size_t size) { return fed(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace palp::site_program {
namespace {

using testing::HasSubstr;

constexpr Duration kPeriod = std::chrono::milliseconds{1};

record::SessionInfo surgeon_info() {
  record::SessionInfo info;
  info.site = link::Role::Surgeon;
  return info;
}

TEST(MonitoringTest, NobodyIsServedUnlessAskedFor) {
  Recording quiet{{}, surgeon_info(), 1};
  EXPECT_EQ(quiet.feed(), nullptr);
  const Monitoring none{{.serve = true, .port = 0}, {}, quiet, std::nullopt};
  EXPECT_EQ(none.fault(), "") << "nothing to show, so nothing is served";
}

TEST(MonitoringTest, APortInUseIsASentenceAndNoEnd) {
  Recording one{{}, surgeon_info(), 1, kPeriod}, other{{}, surgeon_info(), 1, kPeriod};
  const Monitoring first{{.serve = true, .port = 0}, {}, one, std::nullopt};
  ASSERT_EQ(first.fault(), "");
  const Monitoring second{{.serve = true, .port = first.port()}, {}, other, std::nullopt};
  EXPECT_THAT(second.fault(), HasSubstr("already in use"));
  EXPECT_EQ(second.port(), 0U);
}

TEST(MonitoringTest, APageThatDiesIsToldOnceAndTheRestGoesOn) {
  Recording recording{{}, surgeon_info(), 1, kPeriod};
  Monitoring monitoring{{.serve = true, .port = 0}, {}, recording, std::nullopt};
  StatusLine line;
  io::start_diagnostics("test");
  const auto told = [&] {
    testing::internal::CaptureStderr();
    monitoring.tell_news(line);
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_EQ(told(), "");
  monitor_starves = true;
  const monitor::RawClient client{monitoring.port()};
  std::string news;
  for (int i = 0; i < 500 && news.empty(); ++i) {
    io::SteadyClock{}.pass(std::chrono::milliseconds{10});
    news = told();
  }
  monitor_starves = false;
  EXPECT_THAT(news, HasSubstr("the monitor has ended: std::bad_alloc; the session goes on"));
  EXPECT_EQ(told(), "");
  SiteTick tick;
  tick.at = io::SteadyClock{}.now();
  EXPECT_TRUE(recording.recorder(0).record(tick));
  monitoring.stop();
  (void)recording.stop();
}

TEST(MonitoringTest, TheFeedIsThereWithoutASessionFileAndTellsTheLastTickToo) {
  for (int i = 0; i < 20; ++i) {
    Recording recording{{}, surgeon_info(), 1, kPeriod};
    ASSERT_NE(recording.feed(), nullptr);
    const TimePoint begun = io::SteadyClock{}.now();
    SiteTick tick;
    do tick.at = io::SteadyClock{}.now();
    while (tick.at - begun < std::chrono::milliseconds{i % 5});
    EXPECT_TRUE(recording.recorder(0).record(tick));
    (void)recording.stop();
    EXPECT_EQ(recording.feed()->status().ticks, 1U);
    EXPECT_FALSE(recording.feed()->status().recording);
  }
}

}  // namespace
}  // namespace palp::site_program
