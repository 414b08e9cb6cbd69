#include "surgeon_site/recording_reader.h"

#include <numbers>

#include <gtest/gtest.h>

#include "common/record/session_writer.h"

namespace palp::surgeon {
namespace {

using std::chrono::milliseconds;

constexpr double kStiffness = 300;  ///< [N/m]
constexpr double kSurface = 2e-3;   ///< [m]
constexpr double kPush = 0.6;       ///< [N], while in the tissue

/// Two taps of 0.8 s to 4 mm past the surface, a second apart.
record::MemorySink recorded(link::Role site = link::Role::Surgeon) {
  record::MemorySink sink;
  record::SessionWriter writer{
      sink, {.site = site, .metadata = {{"surface_offset_mm", "2"}}, .opened_at = {}}};
  for (int ms = 0; ms < 2000; ++ms) {
    SiteTick tick;
    tick.at = TimePoint{milliseconds{ms}};
    tick.state = ms < 100 ? SiteState::Clutched : SiteState::Engaged;
    const double share = static_cast<double>(ms % 1000) / 800;
    const double lift = share < 1 ? 0.5 * (1 - std::cos(2 * std::numbers::pi * share)) : 0;
    tick.position = kSurface - 3e-3 + 7e-3 * lift;
    tick.force = tick.position > kSurface ? kPush : 0;
    writer.write(tick);
  }
  writer.close();
  return sink;
}

TEST(RecordingReaderTest, TheHandsWillIsWhereItWasAndWhatTheForceBentItsGrip) {
  const auto script = parse_recording(recorded().bytes(), kStiffness);
  ASSERT_TRUE(script) << script.error().text;
  EXPECT_NEAR(seconds(script->length()), 1.9, 0.02) << "from the first engaged tick";
  const Intent deepest = script->at(milliseconds{300});
  EXPECT_NEAR(deepest.position, 4e-3 + kPush / kStiffness, 0.05e-3);
  EXPECT_NEAR(script->at(milliseconds{750}).position, -3e-3, 0.05e-3) << "no force in the air";
  EXPECT_TRUE(script->has_tremor());
}

TEST(RecordingReaderTest, EachTapHasItsStretchAndItsPhase) {
  const auto script = parse_recording(recorded().bytes(), kStiffness);
  ASSERT_TRUE(script);
  int taps = 0;
  for (const Stretch& stretch : script->stretches()) {
    if (stretch.kind != StretchKind::Tap) continue;
    EXPECT_EQ(stretch.phase, ++taps);
    EXPECT_NEAR(seconds(stretch.duration), 0.45, 0.1);
  }
  EXPECT_EQ(taps, 2);
  EXPECT_EQ(script->phases().size(), 3U) << "two taps and the rest";
}

TEST(RecordingReaderTest, WhatIsNoRecordedHandIsRefusedInOneSentence) {
  const auto refused = [](std::span<const std::byte> bytes) {
    const auto script = parse_recording(bytes, kStiffness);
    return script ? "" : script.error().text;
  };
  EXPECT_EQ(refused(recorded(link::Role::Patient).bytes()), "it is not the surgeon's session file");
  EXPECT_NE(refused({}), "");
  record::MemorySink idle;
  record::SessionWriter{idle, {.site = link::Role::Surgeon}}.close();
  EXPECT_EQ(refused(idle.bytes()), "the hand was never engaged in it");
  record::MemorySink wild;
  {
    record::SessionWriter writer{wild, {.site = link::Role::Surgeon}};
    writer.write(SiteTick{.state = SiteState::Engaged, .position = 7, .place = {}, .sent = {}});
  }
  EXPECT_EQ(refused(wild.bytes()), "its hand moves as none can, or for more than 4 hours");
  EXPECT_FALSE(load_recording("/nowhere/hand.mcap", kStiffness));
}

}  // namespace
}  // namespace palp::surgeon
