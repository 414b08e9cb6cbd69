// A million samples over each kind of loss: ./test --slow.
#include <gtest/gtest.h>

#include "tests/common/link/loss_repair.h"

namespace palp::link {
namespace {

constexpr std::uint64_t kSamples = 1'000'000;

TEST(NetworkSlowTest, AMillionSamplesOverRandomLosses) {
  const Repair repair = repair_over(kRandom, kSamples, 41);
  RecordProperty("missing_ppm", std::to_string(repair.missing * 1e6));
  EXPECT_NEAR(repair.lost, 0.05, 0.001);
  EXPECT_LE(repair.missing, 2e-4) << "expected: 0.05^3";
}

TEST(NetworkSlowTest, AMillionSamplesOverBurstsOfThree) {
  const Repair repair = repair_over(kBursts, kSamples, 42);
  RecordProperty("missing_ppm", std::to_string(repair.missing * 1e6));
  EXPECT_NEAR(repair.lost, 0.02, 0.001);
  EXPECT_LE(repair.missing, 6e-4);
}

}  // namespace
}  // namespace palp::link
