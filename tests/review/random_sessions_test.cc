#include "tests/review/random_sessions.h"

// Goal: a session's file says what the lab said of it, to the last digit, and no stroke stands
// beside another's tap. Method: scripts of taps, repeated touches and holds at several places,
// networks and couplings by chance; a hundred of them in random_sessions_slow_test.

namespace palp::review {
namespace {

TEST(RandomSessionsTest, FilesSayWhatTheLabSaid) {
  test::Looked looked;
  // 108 and 139 have estimates that arrive after the next stroke began.
  for (const std::uint64_t seed : {1U, 2U, 3U, 108U, 139U})
    test::expect_same_judgement(seed, looked);
  EXPECT_GT(looked.taps, 10U);
  EXPECT_GT(looked.presses, 0U);
}

}  // namespace
}  // namespace palp::review
