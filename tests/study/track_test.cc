#include "study/track.h"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "study/simulated_observer.h"

namespace palp::study {
namespace {

const AnswerTable& table() {
  static const AnswerTable one{{}, {}, {}, even_levels(0.02, 1.2, 25)};
  return one;
}

FormulaObserver observer(std::uint64_t stream) {
  return {
      .task = {}, .traits = {.jnd = 0.15, .pse = 0, .lapse = 0.02}, .seed = 5, .stream = stream};
}

TEST(TrackTest, ConstantStimuliAskEveryLevelEquallyOftenInAnotherOrderEachRound) {
  Track track{
      table(), {.kind = MethodKind::Constant, .stop = {.trials_min = 75, .trials_max = 75}}, 1, 1};
  std::map<std::size_t, int> count;
  std::vector<std::size_t> order;
  while (!track.done()) {
    const std::size_t level = track.next();
    ++count[level];
    order.push_back(level);
    track.told(level, true);
  }
  ASSERT_EQ(count.size(), 25U);
  for (const auto& [level, times] : count) EXPECT_EQ(times, 3) << level;
  EXPECT_NE(std::vector(order.begin(), order.begin() + 25),
            std::vector(order.begin() + 25, order.begin() + 50));
}

TEST(TrackTest, EveryMethodStopsAndRepeatsItself) {
  for (const MethodKind kind :
       {MethodKind::Constant, MethodKind::Staircase, MethodKind::Quest, MethodKind::QuestPlus}) {
    Track one{table(), {.kind = kind}, 4, 2};
    Track other{table(), {.kind = kind}, 4, 2};
    const auto answers = run_track(one, observer(1));
    const auto again = run_track(other, observer(1));
    EXPECT_LE(one.trials(), 60U);
    ASSERT_EQ(answers.size(), again.size()) << to_string(kind);
    EXPECT_EQ(one.posterior().ln_jnd().mean, other.posterior().ln_jnd().mean);
  }
}

// A track that is told what was written down stands where the first one stood.
TEST(TrackTest, IsRebuiltFromItsAnswers) {
  for (const MethodKind kind :
       {MethodKind::Constant, MethodKind::Staircase, MethodKind::QuestPlus}) {
    Track whole{table(), {.kind = kind}, 4, 2};
    std::vector<std::pair<std::size_t, bool>> log;
    for (int i = 0; i < 30 && !whole.done(); ++i) {
      const std::size_t level = whole.next();
      const bool yes = observer(3).answer(table().levels()[level], whole.trials());
      log.emplace_back(level, yes);
      whole.told(level, yes);
    }
    Track resumed{table(), {.kind = kind}, 4, 2};
    for (const auto& [level, yes] : log) resumed.told(level, yes);
    ASSERT_EQ(resumed.done(), whole.done());
    if (whole.done()) continue;
    EXPECT_EQ(resumed.next(), whole.next()) << to_string(kind);
  }
}

TEST(TrackTest, AStaircaseGoesDownAfterTwoRightAnswersAndUpAfterOneWrong) {
  Track track{table(), {.kind = MethodKind::Staircase}, 1, 1};
  const std::size_t start = track.next();
  track.told(start, true);
  EXPECT_EQ(track.next(), start);
  track.told(start, true);
  const std::size_t lower = track.next();
  EXPECT_LT(lower, start);
  track.told(lower, false);
  EXPECT_GT(track.next(), lower);
}

// Many staircases settle where their rule says, on average.
TEST(TrackTest, StaircasesSettleAtTheirShare) {
  const AnswerTable fine{{}, {}, {.jnd_count = 3, .lapse_count = 2}, even_levels(0.01, 2, 400)};
  for (const auto& [right, ratio] : {std::pair{2, 0.5488}, std::pair{3, 0.7393}}) {
    const Method method{.kind = MethodKind::Staircase,
                        .staircase = {.right_to_go_down = right,
                                      .down_over_up = ratio,
                                      .reversals = 60,
                                      .reversals_used = 50},
                        .stop = {.trials_min = 1, .trials_max = 2000}};
    double sum = 0;
    for (std::uint64_t i = 0; i < 40; ++i) {
      Track track{fine, method, 1, i};
      FormulaObserver person = observer(i);
      person.traits.lapse = 0;
      (void)run_track(track, person);
      sum += std::log(*track.reversal_level());
    }
    const double share = answer_share({}, {.jnd = 0.15}, std::exp(sum / 40));
    EXPECT_NEAR(share, staircase_share(method.staircase), 0.02) << right;
  }
}

TEST(TrackTest, EndsEarlyWhereThePosteriorIsNarrowEnough) {
  const Method method{.stop = {.trials_min = 30, .trials_max = 120, .ln_jnd_sd = 0.25}};
  Track track{table(), method, 1, 1};
  (void)run_track(track, observer(4));
  EXPECT_GE(track.trials(), 30U);
  EXPECT_LT(track.trials(), 120U);
  EXPECT_LE(track.posterior().ln_jnd().sd, 0.25);
}

// Chosen levels tell more than levels that are asked evenly.
TEST(TrackTest, QuestPlusLearnsMoreThanConstantStimuli) {
  double chosen = 0;
  double even = 0;
  for (std::uint64_t i = 0; i < 20; ++i) {
    Track one{table(), {.kind = MethodKind::QuestPlus}, 1, i};
    Track other{table(), {.kind = MethodKind::Constant}, 1, i};
    (void)run_track(one, observer(i));
    (void)run_track(other, observer(i));
    chosen += one.posterior().ln_jnd().sd;
    even += other.posterior().ln_jnd().sd;
  }
  EXPECT_LT(chosen, 0.75 * even);
}

}  // namespace
}  // namespace palp::study
