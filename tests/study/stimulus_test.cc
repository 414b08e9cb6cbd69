#include "study/stimulus.h"

#include <gtest/gtest.h>

#include "study/orders.h"

namespace palp::study {
namespace {

TEST(StimulusTest, OneIntervalHoldsTheLevelOfAChoice) {
  const auto felt = stimuli_of({.level = 0.3, .stronger = 2}, {.intervals = 3});
  ASSERT_EQ(felt.size(), 3U);
  EXPECT_EQ(felt[0].level, 0);
  EXPECT_EQ(felt[1].level, 0);
  EXPECT_EQ(felt[2].level, 0.3);
  const auto bias = stimuli_of({.level = -0.3, .stronger = 0}, {.two_sided = true});
  EXPECT_EQ(bias[0].level, 0);
  EXPECT_EQ(bias[1].level, -0.3);
  EXPECT_EQ(stimuli_of({.level = 0.3}, {.two_sided = true, .yes_no = true}).size(), 1U);
  EXPECT_EQ(stimuli_of({.level = 0.3}, {.intervals = 1, .places = 8}).size(), 1U);
}

TEST(StimulusTest, ADelayLeavesTheTissueAsItIs) {
  const auto felt = stimuli_of({.level = 40, .stronger = 0}, {.delays = true});
  EXPECT_EQ(felt[0].delay, 40);
  EXPECT_EQ(felt[1].delay, 0);
  EXPECT_EQ(felt[0].level, 0);
}

TEST(StimulusTest, ARankingIsEvenAboutTheMiddle) {
  for (std::size_t order = 0; order < kOrders.size(); ++order) {
    const auto felt =
        stimuli_of({.level = 0.2, .stronger = order}, {.intervals = 3, .ranks = true});
    std::array<double, kRanked> levels{};
    double sum = 0;
    for (std::size_t i = 0; i < kRanked; ++i) sum += levels[i] = felt[i].level;
    EXPECT_EQ(order_of(levels), order);
    EXPECT_NEAR(sum, 0, 1e-15);
    EXPECT_EQ(levels[kOrders[order][2]], 0.2);
  }
}

TEST(StimulusTest, TissuesAreThoseThatTrialsShow) {
  const auto levels = [](const std::string& task) {
    return tissue_levels(*parse_study(
        task + " levels { from_ln: 0.1 to_ln: 0.4 count: 2 } condition { name: \"one\" }", "s"));
  };
  EXPECT_EQ(levels("task: \"delay\"").size(), 1U);
  EXPECT_EQ(levels("").size(), 3U);
  EXPECT_EQ(levels("task: \"rank\"").size(), 5U);
}

}  // namespace
}  // namespace palp::study
