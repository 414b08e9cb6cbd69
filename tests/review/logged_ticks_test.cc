#include "review/logged_ticks.h"

#include <gtest/gtest.h>

#include "tests/review/lab_files.h"

namespace palp::review {
namespace {

TEST(LoggedTicksTest, GivesEachTickWithWhatTheSiteWasTold) {
  const test::LabFiles files = test::lab_files(test::lab_scenario(std::chrono::milliseconds{200}));
  const RunBytes bytes{files.patient.bytes()};
  LoggedTicks ticks{bytes};
  std::size_t count = 0;
  while (const auto tick = ticks.next()) {
    EXPECT_TRUE(tick->stage && tick->force && tick->heard);
    EXPECT_EQ(tick->own_devices.has_value(), count == 0) << "told once, at the start";
    EXPECT_EQ(tick->link().session_id, tick->heard->session_id);
    ++count;
  }
  EXPECT_EQ(count, 200U);
}

TEST(LoggedTicksTest, FilesOfARunFollowEachOther) {
  const test::LabFiles files = test::lab_files(test::lab_scenario(std::chrono::milliseconds{100}));
  const RunBytes bytes{files.surgeon.bytes(), files.surgeon.bytes()};
  LoggedTicks ticks{bytes};
  std::size_t count = 0;
  while (ticks.next()) ++count;
  EXPECT_EQ(count, 200U);
}

}  // namespace
}  // namespace palp::review
