#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "lab/plan/scenario_file.h"
#include "lab/run/run.h"
#include "surgeon_site/script_reader.h"
#include "tests/support/own_path.h"

/// Goal: how far the force sensor and what holds it yield is no softness of the tissue.
/// Method: a hand presses a spring below B in virtual time.
namespace palp::lab {
namespace {

constexpr double kStiffness = 1200;  // [N/m]
constexpr double kYield = 20e-6;     // [m/N]

Scenario pressing(const std::string& coupling, const std::vector<std::string>& settings) {
  const std::string table = test::own_path("spring.csv");
  std::ofstream{table} << "d_mm,F_N\n0,0\n2,2.4\n4,4.8\n8,9.6\n";
  config::Document document = load_scenario("standard").value();
  std::vector<std::string> all;
  all.push_back("patient.simulated_phantom.phantom=file:" + table);
  all.push_back("patient.simulated_phantom.yield_um_per_n=20");
  for (const char* site : {"surgeon", "patient"}) {
    all.push_back(std::string{site} + ".coupling.name=" + coupling);
  }
  all.insert(all.end(), settings.begin(), settings.end());
  for (const std::string& setting : all) EXPECT_TRUE(document.set(setting)) << setting;
  Scenario scenario = make_scenario("yield", document).value();
  scenario.depths = false;
  scenario.script = surgeon::parse_script("hold 1\ntap 4 times at B\npress 4 1 4\nlift 1 1\n",
                                          scenario.hand.plant.grip.stiffness)
                        .value();
  return scenario;
}

struct Felt {
  double stiffness{};  ///< [-], of the tissue's own
  double tip_short{};  ///< [m], the tip less deep than the hand
};

/// In the press, from a second on.
Felt felt(const RunResult& result) {
  double force = 0;
  double hand = 0;
  double tip = 0;
  double count = 0;
  for (const judge::RunTick& tick : result.ticks) {
    if (tick.phase.kind != judge::PhaseKind::PressHold || tick.phase.elapsed < 1) continue;
    force += tick.hand_force;
    hand += tick.hand;
    tip += tick.tip;
    ++count;
  }
  EXPECT_GT(hand / count, 1e-3);
  return {force / hand / kStiffness, (hand - tip) / count};
}

TEST(YieldingSensorTest, WithItsYieldStatedTheTissueIsAsStiffAsItIs) {
  const Felt with = felt(simulate(pressing("mmt", {})));
  EXPECT_NEAR(with.stiffness, 1, 0.01);
  const Felt without =
      felt(simulate(pressing("mmt", {"patient.simulated_phantom.yield_stated=0"})));
  EXPECT_NEAR(without.stiffness, 1 / (1 + kStiffness * kYield), 0.01);
  EXPECT_LT(without.stiffness, with.stiffness - 0.015);
}

/// The stage goes as much further as the sensor gives way: here by 27 um.
TEST(YieldingSensorTest, TheTipIsAsDeepAsTheHand) {
  EXPECT_NEAR(felt(simulate(pressing("mmt", {}))).tip_short, 0, 8e-6);
  const auto rigid = pressing("mmt", {"patient.simulated_phantom.yield_um_per_n=0"});
  EXPECT_NEAR(felt(simulate(rigid)).tip_short, 0, 8e-6);
  const auto unstated = pressing("mmt", {"patient.simulated_phantom.yield_stated=0"});
  EXPECT_GT(felt(simulate(unstated)).tip_short, 15e-6);
}

}  // namespace
}  // namespace palp::lab
