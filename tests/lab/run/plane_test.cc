#include <algorithm>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "lab/plan/scenario_file.h"
#include "lab/run/run.h"
#include "tests/support/own_path.h"
#include "tests/support/surveyed_tissue.h"

/// Goal: a session in the plane, over a tissue that a file gives at several places.
/// Method: a script by coordinates taps and drags in virtual time; what was really touched is
/// compared with the tissue that the file was made from.
namespace palp::lab {
namespace {

Scenario plane_scenario(const char* coupling) {
  const std::string tissue = test::own_path("plane_tissue.csv");
  const std::string script = test::own_path("plane_script.txt");
  std::ofstream{tissue} << test::surveyed_tissue_csv();
  std::ofstream{script} << test::kPlaneScript;
  auto document = load_scenario("metro");
  for (const std::string& setting : {"patient.simulated_phantom.phantom=file:" + tissue,
                                     "surgeon.hand.master=script:" + script,
                                     std::string{"surgeon.coupling.name="} + coupling,
                                     std::string{"patient.coupling.name="} + coupling}) {
    EXPECT_TRUE(document->set(setting)) << setting;
  }
  Scenario made = make_scenario("plane", *document).value();
  std::remove(tissue.c_str());
  std::remove(script.c_str());
  return made;
}

/// The ticks in which the pressed tip travelled along y = 2 mm.
std::vector<judge::RunTick> drag_of(const RunResult& result) {
  std::vector<judge::RunTick> drag;
  for (const judge::RunTick& tick : result.ticks) {
    if (tick.contact_force > 0.1 && std::abs(tick.tip_place.y - 2e-3) < 1e-6) drag.push_back(tick);
  }
  return drag;
}

TEST(PlaneTest, ASessionByCoordinatesEndsInOrder) {
  for (const char* coupling : {"mmt", "tdpa"}) {
    const RunResult result = simulate(plane_scenario(coupling));
    EXPECT_EQ(result.outcome, surgeon::ScriptOutcome::Completed) << coupling;
    EXPECT_FALSE(result.metrics.unstable) << result.metrics.unstable_reason;
    ASSERT_EQ(result.metrics.taps.size(), 4U);
    EXPECT_EQ(result.metrics.taps[0].place, (Place{-5e-3, 0}));
    EXPECT_EQ(result.metrics.taps[2].place, (Place{10e-3, 0}));
    EXPECT_EQ(result.metrics.taps[2].index, 1) << "each visit begins with a first tap";
    EXPECT_GT(*result.metrics.taps[3].stiffness.truth(),
              1.3 * *result.metrics.taps[1].stiffness.truth());
    ASSERT_GE(result.depths.size(), 4U);
    EXPECT_NEAR(distance(result.depths[0].place, {-5e-3, 0}), 0, 1e-6);
  }
}

TEST(PlaneTest, ADragFeelsABump) {
  const std::vector<judge::RunTick> drag = drag_of(simulate(plane_scenario("tdpa")));
  ASSERT_GT(drag.size(), 4000U);
  EXPECT_NEAR(drag.back().tip_place.x, 25e-3, 1e-6);
  const auto strength = [](const judge::RunTick& tick) {
    return tick.contact_force / (0.06 * std::pow(std::max(0.5, tick.tip * 1e3), 1.5));
  };
  const auto hardest = std::max_element(
      drag.begin() + 500, drag.end() - 500, [&](const judge::RunTick& a, const judge::RunTick& b) {
        return strength(a) < strength(b);
      });
  EXPECT_NEAR(hardest->tip_place.x, 10e-3, 2e-3);
  EXPECT_NEAR(strength(*hardest), 1.57, 0.08);
  for (std::size_t k = 1; k < drag.size(); ++k) {
    ASSERT_LE(distance(drag[k].tip_place, drag[k - 1].tip_place), 20.1e-6 * 2) << "no jump";
  }
}

TEST(PlaneTest, AStageThatCannotDragStaysAndTheSessionGoesOn) {
  Scenario scenario = plane_scenario("mmt");
  scenario.tissue.can_drag = false;
  const RunResult result = simulate(scenario);
  EXPECT_EQ(result.outcome, surgeon::ScriptOutcome::Completed);
  for (const judge::RunTick& tick : drag_of(result)) {
    ASSERT_NEAR(tick.tip_place.x, -5e-3, 1e-6) << "it tore at the tissue";
  }
  EXPECT_NEAR(distance(result.ticks.back().tip_place, kSiteA), 0, 1e-6) << "free again, it follows";
}

}  // namespace
}  // namespace palp::lab
