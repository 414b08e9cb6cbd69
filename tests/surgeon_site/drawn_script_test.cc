#include "surgeon_site/drawn_script.h"

#include <cstdint>
#include <set>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp::surgeon {
namespace {

RC_GTEST_PROP(DrawnScriptTest, EveryOneBeginsAndEndsClearOfTheTissueAndStaysWithinReach, ()) {
  const GestureScript script = drawn_script(*rc::gen::arbitrary<std::uint64_t>(), {});
  RC_ASSERT(script.at({}).position == kClearPlace);
  RC_ASSERT(script.at(script.length()).position == kClearPlace);
  RC_ASSERT(script.length() > std::chrono::seconds{15});
  RC_ASSERT(script.length() < std::chrono::minutes{5});
  for (Duration at{}; at < script.length(); at += std::chrono::milliseconds{10}) {
    const Intent intent = script.at(at);
    RC_ASSERT(intent.position >= kClearPlace - 6e-3 && intent.position < 10e-3);
    RC_ASSERT(std::abs(intent.velocity) < 0.3);
  }
}

TEST(DrawnScriptTest, AllGesturesOccur) {
  std::set<StretchKind> kinds;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const GestureScript script = drawn_script(seed, {});
    for (const Stretch& stretch : script.stretches()) kinds.insert(stretch.kind);
  }
  for (const StretchKind kind : {StretchKind::Tap,
                                 StretchKind::Pause,
                                 StretchKind::PressHold,
                                 StretchKind::Drag,
                                 StretchKind::Travel,
                                 StretchKind::LiftHold}) {
    EXPECT_TRUE(kinds.contains(kind)) << static_cast<int>(kind);
  }
}

TEST(DrawnScriptTest, ASeedIsAScript) {
  EXPECT_EQ(drawn_script(7, {}).length(), drawn_script(7, {}).length());
  EXPECT_NE(drawn_script(7, {}).length(), drawn_script(8, {}).length());
}

}  // namespace
}  // namespace palp::surgeon
