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

TEST(RandomSessionsTest, AStrokeThatComesInTheNextTapsTimeStandsBesideItsOwn) {
  const std::string spec = "delay 700ms";
  lab::Scenario scenario = test::lab_scenario({},
                                              {"surgeon.coupling.name=wave",
                                               "patient.coupling.name=wave",
                                               "up.spec=" + spec,
                                               "down.spec=" + spec});
  surgeon::ScriptBuilder script{scenario.hand.plant.grip.stiffness};
  script.hold(from_seconds(0.3)).travel(kSiteA).move(surgeon::kNearPlace, from_seconds(0.4));
  for (const double depth : {2.5e-3, 4.5e-3, 2.5e-3, 4.5e-3}) {
    script.taps(1, depth, from_seconds(0.6), from_seconds(0.1));
  }
  scenario.script = script.lift(from_seconds(0.4), from_seconds(0.3)).build();
  test::Looked looked;
  test::expect_same_judgement(scenario, looked);
  EXPECT_GE(looked.taps, 4U);
}

}  // namespace
}  // namespace palp::review
