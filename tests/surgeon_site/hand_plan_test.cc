#include "surgeon_site/hand_plan.h"

#include <gtest/gtest.h>

namespace palp::surgeon {
namespace {

Settings with_master(const std::string& master) {
  Settings settings;
  settings.master = master;
  return settings;
}

TEST(HandPlanTest, IsAPointersAScriptsOrADevices) {
  const auto pointer = plan_hand(with_master("pointer"));
  ASSERT_TRUE(pointer);
  EXPECT_FALSE(pointer->script || pointer->master);
  EXPECT_TRUE(make_pointer(with_master("pointer")));

  const auto scripted = plan_hand(with_master("script:standard"));
  ASSERT_TRUE(scripted);
  EXPECT_TRUE(scripted->script);
  EXPECT_TRUE(make_scripted({}, scripted->script));
  EXPECT_FALSE(make_scripted({}, std::nullopt));
  EXPECT_FALSE(make_pointer(with_master("script:standard")));
  EXPECT_FALSE(start_master(scripted->master, 1));
}

TEST(HandPlanTest, ADeviceNeedsItsFile) {
  const auto plan = plan_hand(with_master("paddle"));
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().text, "master 'paddle' needs --devices FILE");
  EXPECT_FALSE(plan_hand(with_master("script:nowhere")));
}

}  // namespace
}  // namespace palp::surgeon
