#include <algorithm>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/record/notes.h"
#include "common/record/session_reader.h"
#include "lab/plan/scenario_file.h"
#include "lab/run/run.h"
#include "surgeon_site/script_reader.h"
#include "tests/support/own_path.h"

/// Goal: a first press that stays in contact is felt whole as soon as the tank can pay for holding
/// it, and for as long as it lasts; the bound of energy stands all the same.
/// Method: one press at a place that nobody touched, in virtual time; felt force over the tissue's
/// at the hand's position.
namespace palp::lab {
namespace {

struct Press {
  double share{};   ///< [-], felt over true, 2 s and a round trip after contact
  double later{};   ///< [-], the same at the end of the press
  double energy{};  ///< [J], most that the hand got
  bool unstable{};
  int turns{};           ///< of the tip, by more than 0.3 mm, from 1 s after contact on
  bool told_short{};     ///< the last word of it before the hand lifted: the force is incomplete
  double missing_max{};  ///< [N], in the log
};

constexpr double kLift = 5;  // phase of the script

/// How often the tip turned round, ripples left out, from 1 s after contact to 5 s.
int turns_of_tip(const std::vector<judge::RunTick>& ticks) {
  constexpr double kRipple = 0.3e-3;  // [m]
  std::optional<double> began_at;     // [s]
  std::optional<double> low, high;    // [m], since the last turn
  int heading = 0;
  int turns = 0;
  for (const judge::RunTick& tick : ticks) {
    if (!began_at && tick.contact_force > 0.05) began_at = tick.at;
    if (!began_at || tick.at < *began_at + 1 || tick.at > *began_at + 5) continue;
    low = std::min(low.value_or(tick.tip), tick.tip);
    high = std::max(high.value_or(tick.tip), tick.tip);
    if (heading <= 0 && tick.tip > *low + kRipple) {
      turns += heading < 0 ? 1 : 0;
      heading = 1;
      high = tick.tip;
    } else if (heading >= 0 && tick.tip < *high - kRipple) {
      turns += heading > 0 ? 1 : 0;
      heading = -1;
      low = tick.tip;
    }
  }
  return turns;
}

/// What the surgeon's file says of the force, up to the end of the press.
void read_log(std::span<const std::byte> file, Press& press) {
  record::SessionReader reader{file};
  while (const auto entry = reader.next()) {
    if (const auto* note = std::get_if<Note>(&entry->record)) {
      const auto code = static_cast<record::NoteCode>(note->code);
      if (code == record::NoteCode::ScriptPhase && note->detail >= kLift) return;
      if (code == record::NoteCode::ForceIncomplete) press.told_short = true;
      if (code == record::NoteCode::ForceComplete) press.told_short = false;
    } else if (const auto* tick = std::get_if<SiteTick>(&entry->record)) {
      press.missing_max = std::max(press.missing_max, tick->force_missing);
    }
  }
}

Press first_press(const std::string& tissue, const std::string& grip, int round_trip_ms) {
  config::Document document = load_scenario("standard").value();
  const std::string way = std::to_string(round_trip_ms / 2);
  for (const std::string& setting : {"patient.simulated_phantom.phantom=" + tissue,
                                     "surgeon.hand.grip=" + grip,
                                     "up.delay_ms=" + way,
                                     "down.delay_ms=" + way}) {
    EXPECT_TRUE(document.set(setting)) << setting;
  }
  Scenario scenario = make_scenario("first press", document).value();
  scenario.depths = false;
  scenario.script = surgeon::parse_script("hold 1\nmove to B\nhold 0.5\npress 4 1 6\nlift 1 1\n",
                                          scenario.hand.plant.grip.stiffness)
                        .value();
  record::MemorySink surgeon;
  const RunResult result = simulate(scenario, {.surgeon = &surgeon});
  const auto share = [&](double from, double to) {
    double began_at = -1;
    double felt = 0;
    double truth = 0;
    for (const judge::RunTick& tick : result.ticks) {
      if (began_at < 0 && tick.contact_force > 0.05) began_at = tick.at;
      if (began_at < 0 || tick.at < began_at + from || tick.at > began_at + to) continue;
      felt += tick.hand_force;
      truth += tick.force_true;
    }
    return felt / truth;
  };
  const double since = 2 + 1e-3 * round_trip_ms;
  Press press{.share = share(since, since + 0.3),
              .later = share(5, 5.5),
              .energy = result.metrics.energy_operator,
              .unstable = result.metrics.unstable,
              .turns = turns_of_tip(result.ticks)};
  read_log(surgeon.bytes(), press);
  return press;
}

TEST(FirstPressTest, IsFeltWholeWhereTheEnergyOfHoldingItIsThere) {
  for (const char* grip : {"mid", "firm"}) {
    const Press press = first_press("closed-form", grip, 100);
    EXPECT_NEAR(press.share, 1, 0.03) << grip;
    EXPECT_NEAR(press.later, 1, 0.03) << grip;
    EXPECT_LE(press.energy, 1e-3) << grip;
    EXPECT_FALSE(press.unstable) << grip;
    EXPECT_FALSE(press.told_short) << grip;
  }
}

/// Ten times as stiff as the tissue that the law knows best: a blind hand goes beyond the limit.
TEST(FirstPressTest, InStiffTissueTheTipDoesNotHammerAtItsLimit) {
  const std::string table = test::own_path("stiff.csv");
  std::ofstream{table} << "d_mm,F_N\n0,0\n1,1.5\n2,3\n4,6\n8,12\n";
  for (const char* grip : {"mid", "firm"}) {
    for (const int round_trip_ms : {100, 200, 500}) {
      const Press press = first_press("file:" + table, grip, round_trip_ms);
      EXPECT_LE(press.turns, 2) << grip << ", " << round_trip_ms << " ms";
      EXPECT_FALSE(press.unstable) << grip << ", " << round_trip_ms << " ms";
      EXPECT_LE(press.energy, 1e-3) << grip << ", " << round_trip_ms << " ms";
    }
  }
}

TEST(FirstPressTest, OfALightHandIsShortAndWithinTheBound) {
  const Press press = first_press("closed-form", "light", 500);
  EXPECT_LT(press.share, 0.5) << "the bound could not pay for throwing this hand back";
  EXPECT_LE(press.energy, 1e-3);
  EXPECT_FALSE(press.unstable);
  EXPECT_TRUE(press.told_short);
  EXPECT_GT(press.missing_max, 0.5);
}

}  // namespace
}  // namespace palp::lab
