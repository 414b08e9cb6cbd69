#include "surgeon_site/devices/master_rig.h"

#include <thread>

#include <gtest/gtest.h>

namespace palp::surgeon {
namespace {

TEST(MasterRigTest, TellsByNameThatTheMasterIsNotThere) {
  MasterPlan plan;
  plan.product = master_named("paddle");
  plan.facts.axes = 1;
  MasterRig rig{plan, 0};
  const io::SteadyClock clock;
  const TimePoint end = clock.now() + std::chrono::seconds{20};
  std::optional<MasterNews> news;
  while (!news && clock.now() < end) {
    news = rig.news();
    std::this_thread::yield();
  }
  ASSERT_TRUE(news);
  EXPECT_FALSE(news->fit);
  EXPECT_EQ(news->sentence, "master (Teensy paddle): absent, cannot be opened");
  EXPECT_FALSE(rig.news());
  EXPECT_FALSE(rig.ready());
  EXPECT_FALSE(rig.take_answer());
  EXPECT_FALSE(rig.hopeless(std::chrono::seconds{1}));
  EXPECT_EQ(rig.hopeless(std::chrono::seconds{6}), news->sentence);
  EXPECT_TRUE(rig.device().read(clock.now()).faulted);
  EXPECT_EQ(rig.device().hand_facts().axes, 1U);
  rig.restart();
}

}  // namespace
}  // namespace palp::surgeon
