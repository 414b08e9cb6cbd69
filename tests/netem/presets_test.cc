#include "netem/presets.h"

#include <gtest/gtest.h>

#include "tests/netem/impairment_builders.h"

namespace palp::netem {
namespace {

TEST(PresetsTest, AllSayWhatTheyAreAndWhereTheyComeFrom) {
  ASSERT_EQ(presets().size(), 5U);
  for (const Preset& preset : presets()) {
    EXPECT_FALSE(preset.summary.empty()) << preset.name;
    EXPECT_FALSE(preset.source.empty()) << preset.name;
    EXPECT_GT(preset.up.delay.mean, Duration{}) << preset.name;
    EXPECT_GT(preset.down.delay.mean, Duration{}) << preset.name;
  }
}

TEST(PresetsTest, AreFoundByName) {
  const auto preset = find_preset("transatlantic");
  ASSERT_TRUE(preset);
  EXPECT_EQ(preset->up.delay.mean, std::chrono::microseconds{37'500});
  const auto unknown = find_preset("moon");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().text.find("'moon'"), std::string::npos);
  EXPECT_NE(unknown.error().text.find("metro-fibre"), std::string::npos);
}

TEST(PresetsTest, ReadsDirectionsApartOrTogether) {
  const auto apart =
      parse_preset("x", "# note\nsummary: s\nsource: a\nsource: b\nup: delay 1ms\ndown: loss 1%\n");
  ASSERT_TRUE(apart);
  EXPECT_EQ(apart->source, "a b");
  EXPECT_EQ(apart->up, impaired("delay 1ms"));
  EXPECT_EQ(apart->down, impaired("loss 1%"));
  const auto both = parse_preset("x", "summary: s\nsource: a\nboth: delay 1ms");
  ASSERT_TRUE(both);
  EXPECT_EQ(both->up, both->down);
}

TEST(PresetsTest, RefusesWithTheLine) {
  const auto wrong = parse_preset("x", "summary: s\nsource: a\nboth: delay x\n");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().text.rfind("preset x, line 3: impairment, column 7", 0), 0U)
      << wrong.error().text;
  EXPECT_FALSE(parse_preset("x", "summary: s\nsource: a\nsideways: none"));
  EXPECT_FALSE(parse_preset("x", "summary: s\nsource: a\nup: none"));
  EXPECT_FALSE(parse_preset("x", "summary: s\nboth: none"));
  EXPECT_FALSE(parse_preset("x", ""));
}

}  // namespace
}  // namespace palp::netem
