#include "tests/review/random_sessions.h"

namespace palp::review {
namespace {

TEST(RandomSessionsSlowTest, FilesSayWhatTheLabSaidAHundredTimes) {
  for (std::uint64_t seed = 100; seed < 200; ++seed) test::expect_same_judgement(seed);
}

}  // namespace
}  // namespace palp::review
