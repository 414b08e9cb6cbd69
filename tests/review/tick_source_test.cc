#include "review/tick_source.h"

#include <gtest/gtest.h>

#include "tests/review/session_samples.h"

namespace palp::review {
namespace {

TEST(TickSourceTest, TicksOfTheSessionComeInOrderAndNoOthers) {
  const test::SampleFiles files = test::sample_session();
  SiteData surgeon = load_site(files.surgeon, "s", link::Role::Surgeon).value();
  surgeon.from = test::at_ms(1000);
  surgeon.to = test::at_ms(1500);
  TickSource source{surgeon};
  for (int ms = 1000; ms < 1500; ++ms) {
    const auto tick = source.next_tick();
    ASSERT_TRUE(tick);
    EXPECT_EQ(tick->at, test::at_ms(ms));
  }
  EXPECT_FALSE(source.next());
}

}  // namespace
}  // namespace palp::review
