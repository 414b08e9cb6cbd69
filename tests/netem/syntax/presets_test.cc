#include "netem/syntax/presets.h"

#include <gtest/gtest.h>

#include "netem/model/simulation.h"
#include "tests/netem/model/impairment_builders.h"

namespace palp::netem {
namespace {

TEST(PresetsTest, AllSayWhatTheyAreAndWhereTheyComeFrom) {
  EXPECT_EQ(preset_names().size(), 12U);
  for (const std::string& name : preset_names()) {
    const auto preset = find_preset(name);
    ASSERT_TRUE(preset) << preset.error().text;
    EXPECT_FALSE(preset->means.empty()) << name;
    EXPECT_FALSE(preset->sources.empty()) << name;
    EXPECT_EQ(preset->preset, name);
  }
}

TEST(PresetsTest, AreFoundByName) {
  const auto preset = find_preset("transatlantic");
  ASSERT_TRUE(preset);
  EXPECT_EQ(preset->up.impairment.delay.mean, std::chrono::microseconds{37'500});
  const auto unknown = find_preset("moon");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().text.find("'moon'"), std::string::npos);
  EXPECT_NE(unknown.error().text.find("metro-fibre"), std::string::npos);
}

struct Expected {
  const char* name;
  Direction direction;
  double p50;       ///< [ms]
  double p99_low;   ///< [ms]
  double p99_high;  ///< [ms]
};

/// Goal: what a preset does is what its source says. Method: ten minutes at 1 kHz in virtual time.
TEST(PresetsTest, DelayAsTheirSourcesSay) {
  for (const Expected& one : {Expected{"lan", Direction::Up, 0.125, 0.15, 0.2},
                              Expected{"5g-sa-private", Direction::Up, 6.4, 9, 11},
                              Expected{"5g-sa-private", Direction::Down, 5.3, 10, 11.5},
                              Expected{"5g-mmwave-urllc", Direction::Up, 0.67, 0.86, 0.96},
                              Expected{"5g-mmwave-urllc", Direction::Down, 0.75, 1.0, 1.12},
                              Expected{"transatlantic", Direction::Down, 37.5, 38, 38.5},
                              Expected{"geo", Direction::Up, 290, 300, 325}}) {
    const auto preset = find_preset(one.name);
    ASSERT_TRUE(preset);
    const auto result =
        simulate({.plan = one.direction == Direction::Up ? preset->up : preset->down,
                  .packets = 300'000,
                  .interval = std::chrono::milliseconds{1},
                  .direction = one.direction});
    EXPECT_NEAR(seconds(result.intended.quantile(0.5)) * 1e3, one.p50, 0.02 * one.p50) << one.name;
    const double p99 = seconds(result.intended.quantile(0.99)) * 1e3;
    EXPECT_GE(p99, one.p99_low) << one.name;
    EXPECT_LE(p99, one.p99_high) << one.name;
  }
}

}  // namespace
}  // namespace palp::netem
