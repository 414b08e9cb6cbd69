#include "lab/plan/mismatched_world.h"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "patient_site/phantom.h"

namespace palp::lab {
namespace {

constexpr double kHalf = 15e-3;  // [m]

TEST(MismatchedWorldTest, EveryOneCanBeBuiltAndKindsTakeTurns) {
  std::map<Mismatch, int> plain;
  for (std::uint64_t index = 0; index < 120; ++index) {
    const MismatchedWorld world = mismatched_world(7, index, kHalf);
    const auto phantom = patient::make_phantom(world.phantom);
    ASSERT_TRUE(phantom) << phantom.error().text;
    EXPECT_EQ(phantom->depth.has_value(), world.inclusion) << world.phantom;
    EXPECT_LE(std::abs(world.axis.x), kHalf);
    if (world.inclusion) {
      EXPECT_NEAR(*phantom->depth, world.depth, 1e-8);
      EXPECT_NEAR(phantom->axis.y, world.axis.y, 1e-8);
    }
    plain[world.kind] += world.inclusion ? 0 : 1;
  }
  EXPECT_EQ(plain.size(), kMismatchNames.size());
  for (const auto& [kind, count] : plain) {
    EXPECT_EQ(count, kind == Mismatch::TwoBalls ? 0 : 4) << to_string(kind);
  }
}

TEST(MismatchedWorldTest, AWorldDependsOnItsSeedAndIndexAlone) {
  EXPECT_EQ(mismatched_world(3, 41, kHalf).phantom, mismatched_world(3, 41, kHalf).phantom);
  EXPECT_NE(mismatched_world(3, 41, kHalf).phantom, mismatched_world(3, 51, kHalf).phantom);
  EXPECT_NE(mismatched_world(3, 41, kHalf).phantom, mismatched_world(4, 41, kHalf).phantom);
}

}  // namespace
}  // namespace palp::lab
