#include <cmath>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/record/notes.h"
#include "common/record/session_reader.h"
#include "lab/plan/scenario_file.h"
#include "lab/run/run.h"
#include "surgeon_site/script_reader.h"
#include "tests/support/own_path.h"

/// Goal: a hand that feels less than the tissue is told so within half a second, whatever the
/// reason, and one that feels all of it is not.
/// Method: presses and a drag in virtual time, judged by the true force at the hand.
namespace palp::lab {
namespace {

using record::NoteCode;

struct Told {
  double announced{};      ///< [-], of what was short; NaN: nothing was
  double in_vain{};        ///< [-], of the time at rest
  std::set<NoteCode> why;  ///< in the log, ForceComplete too
};

Told told_of(const std::string& script, const std::vector<std::string>& settings) {
  config::Document document = load_scenario("standard").value();
  for (const std::string& setting : settings) EXPECT_TRUE(document.set(setting)) << setting;
  Scenario scenario = make_scenario("short force", document).value();
  scenario.depths = false;
  scenario.script = surgeon::parse_script(script, scenario.hand.plant.grip.stiffness).value();
  record::MemorySink file;
  const RunResult result = simulate(scenario, {.surgeon = &file});
  Told told{.announced = result.metrics.contact.announced,
            .in_vain = result.metrics.contact.told_in_vain,
            .why = {}};
  record::SessionReader reader{file.bytes()};
  while (const auto entry = reader.next()) {
    const auto* note = std::get_if<Note>(&entry->record);
    if (note != nullptr) told.why.insert(static_cast<NoteCode>(note->code));
  }
  return told;
}

std::vector<std::string> path_of(int round_trip_ms) {
  const std::string way = std::to_string(round_trip_ms / 2);
  return {"up.delay_ms=" + way, "down.delay_ms=" + way};
}

std::vector<std::string> with(std::vector<std::string> settings, const std::string& more) {
  settings.push_back(more);
  return settings;
}

/// A phantom of a file lies below B.
constexpr const char* kPress = "hold 1\nmove to B\nhold 0.5\npress 1 2 6\nlift 1 1\n";

TEST(ShortForceTest, ATissueStifferThanMayBeShownIsCalledSo) {
  const std::string table = test::own_path("stone.csv");
  std::ofstream{table} << "d_mm,F_N\n0,0\n0.4,1\n0.8,2\n2,5\n8,20\n";
  for (const int round_trip_ms : {0, 100, 300}) {
    const Told told = told_of(
        kPress, with(path_of(round_trip_ms), "patient.simulated_phantom.phantom=file:" + table));
    EXPECT_EQ(told.announced, 1) << round_trip_ms << " ms";
    EXPECT_TRUE(told.why.contains(NoteCode::TissueTooStiff)) << round_trip_ms << " ms";
    EXPECT_TRUE(told.why.contains(NoteCode::ForceComplete)) << round_trip_ms << " ms";
  }
}

Told held_against_a_breath(int round_trip_ms) {
  std::vector<std::string> settings = path_of(round_trip_ms);
  settings.emplace_back("patient.simulated_phantom.breathing_mm=1.5");
  settings.emplace_back("patient.simulated_phantom.breathing_hz=0.3");
  return told_of("hold 1\npress 3 1 8\nlift 1 1\n", settings);
}

/// A short path lets the hand follow the surface before a breath is known.
TEST(ShortForceTest, OverAShortPathATissueThatBreathesIsFeltWhole) {
  for (const int round_trip_ms : {20, 100, 300}) {
    EXPECT_TRUE(std::isnan(held_against_a_breath(round_trip_ms).announced)) << round_trip_ms;
  }
}

TEST(ShortForceTest, ATissueThatBreathesAgainstAModelAtRestIsCalledMore) {
  for (const int round_trip_ms : {500, 700}) {
    const Told told = held_against_a_breath(round_trip_ms);
    EXPECT_EQ(told.announced, 1) << round_trip_ms << " ms";
    EXPECT_TRUE(told.why.contains(NoteCode::TipFeelsMore)) << round_trip_ms << " ms";
  }
}

/// The bump is under the hand half a second before any news of it can be there.
TEST(ShortForceTest, OverALongPathADraggedHandIsToldThatTheTipIsElsewhere) {
  const Told told = told_of(
      "hold 1\ntaps 2 4 1 1\npress 3 1 2\ndrag to 40,0 in 2 s\nhold 2\nlift 1 1\n", path_of(500));
  EXPECT_TRUE(told.why.contains(NoteCode::TipElsewhere));
}

TEST(ShortForceTest, AWholeForceIsNotCalledShort) {
  for (const int round_trip_ms : {0, 100, 500}) {
    const Told told =
        told_of("hold 1\ntaps 3 4 1 1\npress 3 1 4\nlift 1 1\n", path_of(round_trip_ms));
    EXPECT_TRUE(std::isnan(told.announced)) << round_trip_ms << " ms";
    EXPECT_LT(told.in_vain, 0.01) << round_trip_ms << " ms";
  }
}

}  // namespace
}  // namespace palp::lab
