#include <gtest/gtest.h>

#include "common/record/byte_sink.h"
#include "lab/plan/scenario_file.h"
#include "lab/run/run.h"
#include "surgeon_site/recording_reader.h"

// Goal: a hand that was recorded once palpates again, over any network. Method: the demo's script
// is recorded in the lab; its file is the hand of further runs.

namespace palp::lab {
namespace {

Scenario scenario_over(const std::string& network) {
  auto document = load_scenario("metro").value();
  EXPECT_TRUE(document.set("surgeon.hand.master=script:demo"));
  EXPECT_TRUE(document.set("up.spec=" + network));
  EXPECT_TRUE(document.set("down.spec=" + network));
  return make_scenario("recorded", document).value();
}

double deepest(const RunResult& run) {
  double deepest = 0;  // [m]
  for (const judge::RunTick& tick : run.ticks) deepest = std::max(deepest, tick.hand);
  return deepest;
}

TEST(RecordedHandTest, PalpatesAgainAsItDidAndOverAnotherNetworkToo) {
  Scenario scenario = scenario_over("delay 1ms");
  record::MemorySink file;
  const RunResult first = simulate(scenario, {.surgeon = &file, .patient = nullptr});
  const auto again = surgeon::parse_recording(file.bytes(), scenario.hand.plant.grip.stiffness);
  ASSERT_TRUE(again) << again.error().text;
  scenario.script = *again;
  const RunResult second = simulate(scenario);
  EXPECT_EQ(second.outcome, surgeon::ScriptOutcome::Completed);
  EXPECT_NEAR(deepest(second), deepest(first), 0.2e-3);
  ASSERT_EQ(second.metrics.taps.size(), first.metrics.taps.size());
  for (std::size_t k = 0; k < first.metrics.taps.size(); ++k) {
    EXPECT_EQ(second.metrics.taps[k].place, first.metrics.taps[k].place);
    EXPECT_NEAR(second.metrics.taps[k].hand_max, first.metrics.taps[k].hand_max, 0.2e-3);
  }
  Scenario far = scenario_over("delay 60ms 3ms distribution normal loss 1%");
  far.script = *again;
  const RunResult third = simulate(far);
  EXPECT_EQ(third.outcome, surgeon::ScriptOutcome::Completed);
  EXPECT_EQ(third.metrics.taps.size(), first.metrics.taps.size());
  EXPECT_FALSE(third.metrics.unstable);
}

}  // namespace
}  // namespace palp::lab
