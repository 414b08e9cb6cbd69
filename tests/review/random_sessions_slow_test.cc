#include "tests/review/random_sessions.h"

namespace palp::review {
namespace {

TEST(RandomSessionsSlowTest, FilesSayWhatTheLabSaidAHundredTimes) {
  test::Looked looked;
  for (std::uint64_t seed = 100; seed < 200; ++seed) test::expect_same_judgement(seed, looked);
  EXPECT_GT(looked.taps, 500U);
  EXPECT_GT(looked.presses, 50U);
}

}  // namespace
}  // namespace palp::review
