#include "review/replay.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include <gtest/gtest.h>

#include "common/config/document.h"
#include "common/record/notes.h"
#include "common/record/session_reader.h"
#include "common/record/session_writer.h"
#include "lab/plan/scenario_file.h"
#include "lab/run/run.h"
#include "surgeon_site/script_reader.h"

// Goal: a session file holds all that decided a session. Method: whole sessions in virtual time,
// with jitter, loss, a blackout and devices that fail, are written to files in memory; from a file
// alone, a new control and a new law must record the same again, bit for bit.

namespace palp::review {
namespace {

using lab::FaultKind;
using lab::kDeviceFaults;
using lab::load_scenario;
using lab::make_scenario;
using lab::Scenario;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

/// The first touches over a path that jitters, loses and falls silent, with one fault.
Scenario rough(const std::string& coupling, FaultKind fault) {
  auto document = load_scenario("metro").value();
  for (const char* site : {"surgeon", "patient"}) {
    EXPECT_TRUE(document.set(std::string{site} + ".coupling.name=" + coupling));
  }
  EXPECT_TRUE(document.set("surgeon.engagement.forced=true"));
  for (const char* way : {"up", "down"}) {
    EXPECT_TRUE(document.set(std::string{way} + ".spec=delay 10ms 4ms loss 5%"));
  }
  Scenario scenario = make_scenario("metro", document).value();
  scenario.duration = 14s;
  scenario.fault = {fault, 5s, 300ms};
  scenario.blackout_at_script_time = 7s;
  return scenario;
}

struct Files {
  record::MemorySink surgeon;
  record::MemorySink patient;
};

Files session_of(const Scenario& scenario) {
  Files files;
  (void)simulate(scenario, {.surgeon = &files.surgeon, .patient = &files.patient});
  return files;
}

struct Replays {
  ReplayReport surgeon;
  ReplayReport patient;
};

/// What the file says of the sites' settings.
Scenario scenario_of(std::span<const std::byte> file) {
  record::SessionReader reader{file};
  (void)reader.next();
  auto document = config::scenario_document();
  const auto merged = document.merge(reader.attachment("scenario.textproto").value(), "file");
  EXPECT_TRUE(merged) << merged.error().text;
  return make_scenario("file", document).value();
}

/// From the files alone.
Replays replay(const Files& files) {
  const Scenario scenario = scenario_of(files.surgeon.bytes());
  const auto surgeon = replay_surgeon({files.surgeon.bytes()}, scenario.surgeon, scenario.coupling);
  const auto patient = replay_patient({files.patient.bytes()},
                                      {scenario.patient, scenario.coupling, scenario.estimator});
  EXPECT_TRUE(surgeon) << surgeon.error().text;
  EXPECT_TRUE(patient) << patient.error().text;
  return {surgeon.value_or(ReplayReport{}), patient.value_or(ReplayReport{})};
}

template <class T>
std::vector<T> all(std::span<const std::byte> file) {
  std::vector<T> found;
  record::SessionReader reader{file};
  while (const auto entry = reader.next()) {
    if (const T* one = std::get_if<T>(&entry->record)) found.push_back(*one);
  }
  return found;
}

void expect_same_again(const std::string& coupling, FaultKind fault) {
  SCOPED_TRACE(coupling + ", " + std::string{to_string(fault)});
  const Files files = session_of(rough(coupling, fault));
  const Replays again = replay(files);
  EXPECT_EQ(again.surgeon.difference, "");
  EXPECT_EQ(again.patient.difference, "");
  EXPECT_EQ(again.surgeon.ticks, all<SiteTick>(files.surgeon.bytes()).size());
  EXPECT_EQ(again.patient.ticks, all<SiteTick>(files.patient.bytes()).size());
  EXPECT_EQ(again.surgeon.ticks, 14'000U);
  EXPECT_EQ(again.patient.estimates, all<DepthEstimate>(files.patient.bytes()).size());
  // Or nothing was at stake: engaged, held by the blackout or stopped by the fault, and again.
  EXPECT_GT(all<Transition>(files.surgeon.bytes()).size(), 4U);
  EXPECT_GT(all<Transition>(files.patient.bytes()).size(), 4U);
}

TEST(ReplayTest, DirectDoesTheSameAgainFromItsFiles) {
  expect_same_again("direct", FaultKind::LiftPedal);
}

TEST(ReplayTest, WaveDoesTheSameAgainFromItsFiles) {
  expect_same_again("wave", FaultKind::LiftPedal);
}

TEST(ReplayTest, TdpaDoesTheSameAgainFromItsFiles) {
  expect_same_again("tdpa", FaultKind::LiftPedal);
}

TEST(ReplayTest, MmtDoesTheSameAgainFromItsFiles) {
  expect_same_again("mmt", FaultKind::LiftPedal);
}

TEST(ReplayTest, PausesOfAProcessDoSoAgain) {
  for (const std::string_view law : coupling::kCouplingNames) {
    for (const FaultKind fault : {FaultKind::PauseSurgeon, FaultKind::PausePatient}) {
      SCOPED_TRACE(std::string{law} + ", " + std::string{to_string(fault)});
      Scenario scenario = rough(std::string{law}, fault);
      scenario.duration = 8s;
      scenario.fault.amount = 20ms;
      scenario.fault.count = 10;
      scenario.fault.apart = 90ms;
      const Replays again = replay(session_of(scenario));
      EXPECT_EQ(again.surgeon.difference, "");
      EXPECT_EQ(again.patient.difference, "");
      EXPECT_EQ(again.surgeon.ticks + again.patient.ticks, 2 * 8'000U - 10 * 20U);
    }
  }
}

TEST(ReplayTest, DevicesThatFailDoSoAgain) {
  for (const FaultKind fault : kDeviceFaults) {
    SCOPED_TRACE(to_string(fault));
    Scenario scenario = rough("mmt", fault);
    scenario.duration = 8s;
    const Replays again = replay(session_of(scenario));
    EXPECT_EQ(again.surgeon.difference, "");
    EXPECT_EQ(again.patient.difference, "");
  }
}

/// The file holds the stage's readings, and the yield by which they become the tip's.
TEST(ReplayTest, ASensorThatYieldsDoesSoAgain) {
  Scenario scenario = rough("mmt", FaultKind::None);
  scenario.duration = 8s;
  scenario.tissue.yield = 200e-6;
  scenario.tissue.servo_stiffness = 20e3;
  const Files files = session_of(scenario);
  EXPECT_EQ(replay(files).patient.difference, "");
  const auto devices = all<DevicesTold>(files.patient.bytes());
  EXPECT_EQ(devices.at(0).facts.sensor->yield, 200e-6);
}

TEST(ReplayTest, WhatTheSurgeonIsToldOfItsForceIsToldAgain) {
  auto document = load_scenario("standard").value();
  ASSERT_TRUE(document.set("patient.simulated_phantom.breathing_mm=1.5"));
  ASSERT_TRUE(document.set("patient.simulated_phantom.breathing_hz=0.3"));
  for (const char* way : {"up", "down"}) {
    ASSERT_TRUE(document.set(std::string{way} + ".delay_ms=300"));
  }
  Scenario scenario = make_scenario("standard", document).value();
  scenario.script =
      surgeon::parse_script("hold 1\npress 3 1 8\nlift 1 1\n", scenario.hand.plant.grip.stiffness)
          .value();
  const Files files = session_of(scenario);
  const auto notes = all<Note>(files.surgeon.bytes());
  const auto code = static_cast<std::uint16_t>(record::NoteCode::TipFeelsMore);
  EXPECT_TRUE(std::ranges::any_of(notes, [&](const Note& note) { return note.code == code; }));
  EXPECT_EQ(replay(files).surgeon.difference, "");
}

TEST(ReplayTest, EstimatesComeAgainToo) {
  Scenario scenario = rough("mmt", FaultKind::None);
  scenario.blackout_at_script_time = {};
  scenario.duration = 24s;
  const Files files = session_of(scenario);
  const Replays again = replay(files);
  EXPECT_EQ(again.patient.difference, "");
  EXPECT_GE(again.patient.estimates, 4U);
  EXPECT_EQ(again.patient.estimates, all<DepthEstimate>(files.patient.bytes()).size());
  EXPECT_FALSE(all<DepthArrived>(files.surgeon.bytes()).empty());
}

TEST(ReplayTest, MapsComeAgainTooAndReachTheSurgeon) {
  const Scenario scenario = make_scenario("map", *load_scenario("map")).value();
  const Files files = session_of(scenario);
  const Replays again = replay(files);
  EXPECT_EQ(again.surgeon.difference, "");
  EXPECT_EQ(again.patient.difference, "");
  const auto maps = all<MapEstimate>(files.patient.bytes());
  EXPECT_EQ(again.patient.maps, maps.size());
  const auto arrived = all<MapArrived>(files.surgeon.bytes());
  ASSERT_EQ(maps.size(), 7U) << "from the third of nine places on";
  ASSERT_EQ(arrived.size(), maps.size());
  EXPECT_EQ(arrived.back().report.number, maps.back().report.number);
  EXPECT_EQ(arrived.back().report.verdict, DepthVerdict::Found);
  EXPECT_NEAR(arrived.back().report.x.median, 17e-3, 1e-3);
  EXPECT_NEAR(arrived.back().report.y.median, 4e-3, 1e-3);
  EXPECT_NEAR(arrived.back().report.depth.median, 5e-3, 1e-3);
  EXPECT_NEAR(arrived.back().report.radius.high, maps.back().report.radius.high, 1e-8);
  const auto there = all<MapCell>(files.patient.bytes());
  const auto here = all<MapCell>(files.surgeon.bytes());
  std::size_t of_last = 0;
  for (const MapCell& cell : here) {
    if (cell.number != there.back().number) continue;
    ++of_last;
    const MapCell& sent = there.at(there.size() - cell.count + cell.index);
    EXPECT_NEAR(cell.stiffness, sent.stiffness, 1e-6);
    EXPECT_NEAR(cell.place.x, sent.place.x, 1e-8);
  }
  EXPECT_EQ(of_last, there.back().count) << "the last map came whole";
}

/// The file once more, each record as `change` wants it.
template <class Change>
std::vector<std::byte> altered(std::span<const std::byte> file, link::Role site, Change change) {
  record::MemorySink sink;
  {
    record::SessionWriter writer{sink, {.site = site}};
    record::SessionReader reader{file};
    while (auto entry = reader.next()) {
      if (change(entry->record)) (void)writer.write(entry->record);
    }
  }
  return {sink.bytes().begin(), sink.bytes().end()};
}

TEST(ReplayTest, OneBitOfOneReadingIsADifference) {
  const Scenario scenario = rough("mmt", FaultKind::None);
  const Files files = session_of(scenario);
  int hands = 0;
  const auto changed = altered(files.surgeon.bytes(), link::Role::Surgeon, [&](Record& record) {
    auto* hand = std::get_if<HandReading>(&record);
    if (hand != nullptr && ++hands == 9000) hand->position = std::nextafter(hand->position, 1);
    return true;
  });
  const auto again = replay_surgeon({changed}, scenario.surgeon, scenario.coupling);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->ticks, 9000U);
  EXPECT_EQ(again->difference.find("surgeon/tick, 8.999"), 0U) << again->difference;
  EXPECT_NE(again->difference.find(" s, position_m: "), std::string::npos) << again->difference;
}

TEST(ReplayTest, AFileWithoutReadingsIsRefusedInOneSentence) {
  const Scenario scenario = rough("mmt", FaultKind::None);
  const Files files = session_of(scenario);
  const auto without = altered(files.patient.bytes(), link::Role::Patient, [](auto& record) {
    return !std::holds_alternative<ForceReading>(record);
  });
  const auto refused =
      replay_patient({without}, {scenario.patient, scenario.coupling, std::nullopt});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().text,
            "the tick at 1.000000 s has no reading of stage or sensor in the file");
}

}  // namespace
}  // namespace palp::review
