#include "study/block.h"

#include <gtest/gtest.h>

#include "tests/study/study_fixture.h"

namespace palp::study {
namespace {

struct Standing {
  Study study = test::small_study();
  AnswerTable table = table_of(study);
  std::vector<BlockPlan> plans = participant_plan(study, 0);
  [[nodiscard]] Block block() const { return {study, table, plans.front()}; }
};

TEST(BlockTest, PracticeEndsOnceEnoughOfTheLastAreRight) {
  const Standing standing;
  Block block = standing.block();
  for (const bool right : {true, false, false, true, true}) {
    EXPECT_EQ(block.next().kind, TrialKind::Practice);
    block.told(right);
  }
  EXPECT_EQ(block.next().kind, TrialKind::Practice);  // two of the last four
  block.told(true);
  EXPECT_NE(block.next().kind, TrialKind::Practice);
  EXPECT_EQ(block.next().number, 6U);
}

TEST(BlockTest, WhoNeedsTooMuchPracticeIsExcluded) {
  const Standing standing;
  Block block = standing.block();
  for (int i = 0; i < 12; ++i) {
    EXPECT_FALSE(block.done());
    block.told(false);
  }
  EXPECT_TRUE(block.done());
  EXPECT_TRUE(block.excluded());
}

TEST(BlockTest, AsksWhatTheScheduleSaysAndLearnsFromTrialsOnly) {
  Standing standing;
  standing.study.catch_share = 0.25;
  standing.plans = participant_plan(standing.study, 0);
  Block block = standing.block();
  for (int i = 0; i < 3; ++i) block.told(true);
  for (const Slot& slot : standing.plans.front().trials) {
    const TrialAsk ask = block.next();
    EXPECT_EQ(ask.kind, slot.kind);
    EXPECT_EQ(ask.stronger, slot.stronger);
    EXPECT_EQ(ask.track, slot.track);
    const double before = block.believed(slot.track).mean;
    block.told(true);
    if (slot.kind == TrialKind::Catch) {
      EXPECT_EQ(ask.level, standing.study.levels.back());
      EXPECT_EQ(block.believed(slot.track).mean, before);
    } else {
      EXPECT_LT(block.believed(slot.track).mean, before);
    }
  }
  EXPECT_TRUE(block.done());
  EXPECT_FALSE(block.excluded());
}

TEST(BlockTest, CountsTrialsWithoutPractice) {
  Standing standing;
  Block block = standing.block();
  const std::size_t all = standing.plans[0].trials.size();
  for (std::size_t before = 0; !block.done();) {
    const TrialAsk ask = block.next();
    EXPECT_EQ(ask.count, all);
    EXPECT_EQ(ask.before, before);
    before += ask.kind == TrialKind::Practice ? 0 : 1;
    block.told(true);
  }
}

TEST(BlockTest, EasyTrialsOfATwoSidedTaskHaveBothSigns) {
  Standing standing;
  standing.study = *parse_study("task: \"bias\" condition { name: \"one\" }", "f");
  standing.table = table_of(standing.study);
  standing.plans = participant_plan(standing.study, 0);
  Block block = standing.block();
  int below = 0;
  for (int i = 0; i < 8; ++i) {
    const TrialAsk ask = block.next();
    EXPECT_EQ(ask.level > 0, ask.stronger == 1);
    below += ask.level < 0 ? 1 : 0;
    block.told(ask.stronger == 1);  // right
  }
  EXPECT_GT(below, 0);
  EXPECT_NE(block.next().kind, TrialKind::Practice);
}

}  // namespace
}  // namespace palp::study
