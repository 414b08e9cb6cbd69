#include "lab/run/direct_touch.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "lab/plan/scenario_file.h"
#include "surgeon_site/script_reader.h"

/// Goal: what a hand would press with its own finger is known without device, link or stage.
namespace palp::lab {
namespace {

double touched(const std::vector<std::string>& settings) {
  config::Document document = load_scenario("standard").value();
  for (const std::string& setting : settings) EXPECT_TRUE(document.set(setting)) << setting;
  return own_finger(make_scenario("touch", document).value()).force;
}

constexpr Duration kMillisecond = std::chrono::milliseconds{1};
const std::string kPlain = "patient.simulated_phantom.phantom=closed-form:100";

TEST(DirectTouchTest, AHandReachesTheDepthItAimsAtInPlainTissue) {
  const double aimed = 0.480;  // [N], 1897 N/m^1.5, 4 mm deep
  EXPECT_NEAR(touched({kPlain}), aimed, 0.12 * aimed) << "deepest in a tap, with its momentum";
}

TEST(DirectTouchTest, EveryMillisecondOfTheScriptIsThere) {
  const Scenario scenario = make_scenario("touch", load_scenario("standard").value()).value();
  const std::vector<TouchTick> ticks = direct_touch(scenario);
  ASSERT_EQ(ticks.size(), static_cast<std::size_t>(scenario.script.length() / kMillisecond));
  for (const TouchTick& tick : ticks) {
    if (tick.position < 0) {
      EXPECT_EQ(tick.force, 0);
    }
  }
  EXPECT_EQ(ticks.front().at, kMillisecond);
  EXPECT_EQ(ticks.back().place, kSiteB);
}

TEST(DirectTouchTest, AStifferGripPressesStifferTissueHarder) {
  const std::string stiff = "patient.simulated_phantom.phantom=random:3";
  EXPECT_GT(touched({stiff, "surgeon.hand.grip=firm"}),
            touched({stiff, "surgeon.hand.grip=light"}));
}

TEST(DirectTouchTest, NeitherLinkNorStageNorLawIsInIt) {
  const double plain = touched({kPlain});
  EXPECT_EQ(plain, touched({kPlain, "up.delay_ms=400"}));
  EXPECT_EQ(plain, touched({kPlain, "patient.simulated_phantom.servo_hz=10"}));
}

TEST(DirectTouchTest, WhereTheSurfaceComesUpThePressIsHarder) {
  EXPECT_GT(touched({kPlain,
                     "patient.simulated_phantom.breathing_mm=1",
                     "patient.simulated_phantom.breathing_hz=0.3"}),
            1.1 * touched({kPlain}));
}

TEST(DirectTouchTest, AFingerReactsAsTheHandDoes) {
  const double passive = touched({kPlain});
  EXPECT_GT(touched({kPlain, "surgeon.hand.reflex=0.5"}), 1.03 * passive);
  EXPECT_GT(touched({kPlain, "surgeon.hand.co_contraction_per_n=1"}), 1.03 * passive);
  EXPECT_EQ(touched({kPlain, "surgeon.hand.reflex_delay_ms=20"}), passive) << "without a reflex";
}

TEST(DirectTouchTest, ALightHandThatTapsQuicklyOnSomethingStiffBounces) {
  config::Document document = load_scenario("standard").value();
  for (const char* setting :
       {"patient.simulated_phantom.phantom=random:1453753669872186", "surgeon.hand.grip=light"}) {
    ASSERT_TRUE(document.set(setting)) << setting;
  }
  Scenario scenario = make_scenario("touch", document).value();
  const auto swing_at = [&](const std::string& taps) {
    scenario.script = surgeon::parse_script(taps, scenario.hand.plant.grip.stiffness).value();
    return own_finger(scenario).swing;
  };
  EXPECT_GT(swing_at("hold 1\nmove -3 0.5\ntaps 5 4 0.24 0\nlift 1 1\n"), 0.3e-3);
  EXPECT_GT(swing_at("hold 1\nmove -3 0.5\ntaps 5 4 0.22 0\nlift 1 1\n"), 0.3e-3)
      << "though some of its turns are a little slower than those of a limit cycle";
  EXPECT_EQ(swing_at("hold 1\nmove -3 0.5\npress 4 1 3\nlift 1 1\n"), 0);
}

}  // namespace
}  // namespace palp::lab
