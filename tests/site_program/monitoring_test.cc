#include "site_program/monitoring.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/io/realtime/steady_clock.h"

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

TEST(MonitoringTest, TheFeedIsThereWithoutASessionFile) {
  Recording recording{{}, surgeon_info(), 1, kPeriod};
  ASSERT_NE(recording.feed(), nullptr);
  SiteTick tick;
  tick.at = io::SteadyClock{}.now();
  EXPECT_TRUE(recording.recorder(0).record(tick));
  (void)recording.stop();
  EXPECT_EQ(recording.feed()->status().ticks, 1U);
  EXPECT_FALSE(recording.feed()->status().recording);
}

}  // namespace
}  // namespace palp::site_program
