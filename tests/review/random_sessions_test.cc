#include "tests/review/random_sessions.h"

// Goal: a session's file says what the lab said of it, to the last digit, and no stroke stands
// beside another's tap. Method: scripts, networks and couplings by chance; a hundred of them in
// random_sessions_slow_test.

namespace palp::review {
namespace {

TEST(RandomSessionsTest, FilesSayWhatTheLabSaid) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) test::expect_same_judgement(seed);
}

}  // namespace
}  // namespace palp::review
