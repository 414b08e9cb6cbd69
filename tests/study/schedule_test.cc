#include "study/schedule.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/study/study_fixture.h"

namespace palp::study {
namespace {

RC_GTEST_PROP(BalancedDrawTest, IsEvenAndNeverFiveOnEnd, ()) {
  const auto count = *rc::gen::inRange<std::size_t>(0, 200);
  const auto kinds = *rc::gen::inRange<std::size_t>(2, 9);
  const auto sides = balanced_draw(count, kinds, *rc::gen::arbitrary<std::uint64_t>(), 3);
  RC_ASSERT(sides.size() == count);
  std::size_t all = 0;
  for (std::size_t kind = 0; kind < kinds; ++kind) {
    const auto of = static_cast<std::size_t>(std::ranges::count(sides, kind));
    RC_ASSERT(of == count / kinds || of == count / kinds + 1);
    all += of;
  }
  RC_ASSERT(all == count);
  std::size_t run = 0;
  for (std::size_t i = 0; i < count; ++i) {
    run = i > 0 && sides[i] == sides[i - 1] ? run + 1 : 1;
    RC_ASSERT(run <= 4U);
  }
}

TEST(ScheduleTest, EachConditionFollowsEachOtherEquallyOften) {
  const Study study = test::small_study();  // three conditions: six rows
  std::array<std::array<int, 3>, 3> follows{};
  for (std::size_t participant = 0; participant < 6; ++participant) {
    const auto blocks = participant_plan(study, participant);
    ASSERT_EQ(blocks.size(), 3U);
    for (std::size_t i = 1; i < 3; ++i) ++follows[blocks[i - 1].condition][blocks[i].condition];
  }
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) EXPECT_EQ(follows[a][b], a == b ? 0 : 2);
  }
}

TEST(ScheduleTest, CatchTrialsAreSpreadAndTracksTakeTurns) {
  Study study = test::small_study();
  study.trials = 60;
  study.catch_share = 1.0 / 15;
  const BlockPlan block = participant_plan(study, 0).front();
  ASSERT_EQ(block.trials.size(), 64U);
  std::array<int, 2> tracks{};
  for (std::size_t quarter = 0; quarter < 4; ++quarter) {
    const auto from = block.trials.begin() + static_cast<std::ptrdiff_t>(16 * quarter);
    EXPECT_EQ(std::count_if(
                  from, from + 16, [](const Slot& slot) { return slot.kind == TrialKind::Catch; }),
              1);
  }
  for (const Slot& slot : block.trials) {
    if (slot.kind == TrialKind::Trial) ++tracks[slot.track];
  }
  EXPECT_EQ(tracks[0], 30);
  EXPECT_EQ(tracks[1], 30);
  EXPECT_EQ(block.practice.size(), study.practice.trials_max);
}

TEST(ScheduleTest, BlocksHaveRandomNumbersOfTheirOwn) {
  const Study study = test::small_study();
  std::set<std::uint64_t> streams;
  for (std::size_t participant = 0; participant < 3; ++participant) {
    for (const BlockPlan& block : participant_plan(study, participant)) {
      EXPECT_TRUE(streams.insert(block.stream).second);
    }
  }
}

// Blind: the schedule tells no condition's name, nor which condition has which letter.
TEST(ScheduleTest, TellsLettersOnly) {
  Study study = test::small_study();
  const std::string text = schedule_text(study);
  for (const Condition& one : study.conditions) EXPECT_EQ(text.find(one.name), std::string::npos);
  EXPECT_EQ(condition_code(0), "A");
  EXPECT_EQ(condition_code(5), "F");
  std::ranges::reverse(study.conditions);
  EXPECT_EQ(schedule_text(study), text);
}

TEST(ScheduleTest, SameSeedSameSchedule) {
  Study study = test::small_study();
  const std::string text = schedule_text(study);
  EXPECT_EQ(schedule_text(study), text);
  ++study.seed;
  EXPECT_NE(schedule_text(study), text);
}

// Each order as often as another; of a search balls anywhere in the area, known before anybody is
// asked.
TEST(ScheduleTest, RankingsAndSearchesAreEven) {
  Study study = test::small_study();
  study.trials = 600;
  study.task = {.intervals = 3, .ranks = true};
  std::array<int, 6> orders{};
  const auto ranked = participant_plan(study, 0);
  for (const Slot& slot : ranked.front().trials) ++orders[slot.stronger];
  for (const int count : orders) EXPECT_NEAR(count, 107, 2);
  study.task = {.intervals = 1, .places = 8};
  study.search = {.side = 40e-3, .within = 8e-3, .limit = 60};
  double x = 0;
  double xx = 0;
  const auto searched = participant_plan(study, 0);
  for (const Slot& slot : searched.front().trials) {
    EXPECT_EQ(slot.stronger, 0U);
    EXPECT_LE(std::max(std::abs(slot.hidden.x), std::abs(slot.hidden.y)), 20e-3);
    x += slot.hidden.x;
    xx += slot.hidden.x * slot.hidden.x;
  }
  const auto n = static_cast<double>(searched.front().trials.size());
  EXPECT_NEAR(x / n, 0, 1.5e-3);
  EXPECT_NEAR(std::sqrt(xx / n), 40e-3 / std::sqrt(12.0), 1e-3);
  EXPECT_NE(schedule_text(study).find("x_mm"), std::string::npos);
}

}  // namespace
}  // namespace palp::study
