#include "patient_site/patient_control.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/fake_recorder.h"

namespace palp::patient {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

/// A site whose inputs a test makes up.
struct Bench {
  explicit Bench(const PatientDevices& facts = {}, const PatientConfig& config = {})
      : control{config, facts, {law, recorder, contact}} {}

  PatientOutputs tick() {
    in.now += 1ms;
    in.stage.sampled_at = in.now - stage_age;
    in.force = ForceSample{.sampled_at = in.now - force_age, .force = force};
    return control.step(in);
  }
  /// Engaged, the surgeon's hand at `hand`.
  PatientOutputs engaged_tick(double hand) {
    in.link.state = LinkState::Live;
    in.link.session_id = 1;
    in.arrived.peer_heard = true;
    const bool clutched = control.status().state == SiteState::Clutched;
    const bool engaged = control.status().state == SiteState::Engaged;
    in.arrived.peer.state = clutched || engaged ? SiteState::Engaged : SiteState::Clutched;
    in.arrived.peer.epoch = clutched || engaged ? 1 : 0;
    sample.sample.position = hand;
    sample.fresh = true;
    ++sample.number;
    in.arrived.samples = {&sample, 1};
    return tick();
  }

  coupling::PatientCoupling law{coupling::DirectPatient{{}}};
  test::KeepingRecorder recorder;
  SpscQueue<ContactSample> contact{1024};
  PatientControl control;
  PatientInputs in;
  Incoming sample;
  Duration stage_age{};
  Duration force_age{};
  double force{};  ///< [N]
};

TEST(PatientControlTest, ASleepBeyondTheLimitLeavesTheStageWhereItStands) {
  for (const Duration sleep : {Duration{49ms}, Duration{51ms}, Duration{5s}}) {
    Bench bench;
    for (int i = 0; i < 10; ++i) bench.engaged_tick(0);
    ASSERT_EQ(bench.control.status().state, SiteState::Engaged);
    const double stood = bench.control.status().command;
    bench.in.now += sleep - 1ms;
    for (int i = 0; i < 300; ++i) bench.engaged_tick(5e-3);  // nobody pressed the pedal again
    const bool over = sleep > kLateMax;
    EXPECT_EQ(bench.control.status().reason == record::NoteCode::TickLate, over);
    EXPECT_EQ(bench.control.status().command == stood, over) << seconds(sleep);
  }
}

TEST(PatientControlTest, NeverRunsFasterThanTheStageSaysItCan) {
  for (const double speed : {0.15, 0.02}) {
    PatientDevices facts;
    facts.stage.speed = speed;
    Bench bench{facts};
    for (int i = 0; i < 10; ++i) bench.engaged_tick(0);
    ASSERT_EQ(bench.control.status().state, SiteState::Engaged);
    double before = bench.control.status().command;
    double fastest = 0;
    for (int i = 0; i < 200; ++i) {
      bench.in.stage.position = before;
      const double now = bench.engaged_tick(-40e-3).target.position;
      fastest = std::max(fastest, std::abs(now - before) / 1e-3);
      before = now;
    }
    EXPECT_NEAR(fastest, speed, 1e-9);
  }
}

/// Taken for a new one, it would let the tip go on for 1 mm.
TEST(PatientControlTest, BrakesInTimeByReadingsThatAreOld) {
  PatientDevices facts;
  facts.sensor.pole = 1e5;
  facts.sensor.lag = 0;
  Bench bench{facts};
  bench.force_age = 20ms;
  for (int i = 0; i < 10; ++i) bench.engaged_tick(0);
  ASSERT_EQ(bench.control.status().state, SiteState::Engaged);
  std::array<double, 20> late{};  // [N]
  double highest = 0;
  for (std::size_t i = 0; i < 1000; ++i) {
    bench.in.stage.position = bench.control.status().command;
    const double force = 1500 * std::max(0.0, bench.in.stage.position);
    bench.force = late[i % late.size()];
    late[i % late.size()] = force;
    bench.engaged_tick(8e-3);
    highest = std::max(highest, force);
  }
  EXPECT_LE(highest, 3);
  EXPECT_GE(highest, 2.5);
}

TEST(PatientControlTest, TheTipPressesNoHarderThanItsLawAsks) {
  PatientDevices facts;
  facts.sensor.pole = 1e5;
  facts.sensor.lag = 0;
  Bench bench{facts};
  const coupling::MmtConfig config;
  bench.law = coupling::PatientCoupling{coupling::MmtPatient{config, facts}};
  for (int i = 0; i < 10; ++i) bench.engaged_tick(0);
  double highest = 0;
  for (int i = 0; i < 500; ++i) {
    bench.in.stage.position = bench.control.status().command;
    bench.force = 600 * std::max(0.0, bench.in.stage.position);
    bench.engaged_tick(8e-3);
    highest = std::max(highest, bench.force);
  }
  EXPECT_LE(highest, config.unfelt + config.braked_beyond) << "the hand was given nothing";
  EXPECT_GE(highest, 0.5 * config.unfelt);
}

TEST(PatientControlTest, ASensorOfLargeStepsMayRestOnOneForLongerAndFeelsContactLater) {
  const auto stopped_after = [](double step) {
    PatientDevices facts;
    facts.sensor.step = step;
    Bench bench{facts};
    bench.force = 0.4;
    for (int i = 0; i < 10; ++i) bench.engaged_tick(0);
    int ticks = 0;
    while (bench.control.status().state == SiteState::Engaged && ticks < 1000) {
      bench.in.stage.position = 20e-6 * ++ticks;
      bench.engaged_tick(0);
    }
    return bench.in.stage.position;
  };
  EXPECT_GT(stopped_after(0.2), stopped_after(0.05) + 1e-3);
}

TEST(PatientControlTest, ContactSamplesAreRawAndSayHowOldTheyAre) {
  Bench bench;
  bench.stage_age = 2ms;
  bench.force_age = 7ms;
  for (int i = 0; i < 10; ++i) bench.engaged_tick(0);
  bench.in.stage.position = 1.25e-3;  // a step, which no filter would follow at once
  bench.force = 0.05;
  bench.engaged_tick(0);
  ContactSample last;
  while (bench.contact.try_dequeue(last)) continue;
  EXPECT_EQ(last.at, bench.in.now);
  EXPECT_EQ(last.position, 1.25e-3);
  EXPECT_EQ(last.force, 0.05);
  EXPECT_EQ(last.position_age, 2ms);
  EXPECT_EQ(last.force_age, 7ms);
}

/// All that is made of a reading means the tip; the reading itself is kept as it was.
TEST(PatientControlTest, TheTipStandsBehindTheStageByWhatTheSensorYields) {
  PatientDevices facts;
  facts.sensor.yield = 20e-6;
  Bench bench{facts};
  for (int i = 0; i < 10; ++i) bench.engaged_tick(0);
  bench.in.stage.position = 1.25e-3;
  bench.force = 2;
  const PatientOutputs out = bench.engaged_tick(0);
  const double tip = 1.25e-3 - 2 * 20e-6;
  EXPECT_EQ(bench.control.status().position, tip);
  EXPECT_EQ(out.to_peer.port.position, tip);
  EXPECT_EQ(bench.recorder.all<SiteTick>().back().position, tip);
  EXPECT_EQ(bench.recorder.all<StageReading>().back().position, 1.25e-3);
  ContactSample last;
  while (bench.contact.try_dequeue(last)) continue;
  EXPECT_EQ(last.position, tip);
}

/// The gate's target is one for the tip: the stage goes as much further as the sensor gives way.
TEST(PatientControlTest, TheStageIsAskedForWhatItsSensorGivesWay) {
  PatientDevices facts;
  facts.sensor.yield = 1e-3;
  Bench bench{facts};
  const auto beyond = [&](double force) {
    bench.force = force;
    const double target = bench.engaged_tick(0).target.position;
    return target - bench.control.status().command;
  };
  for (int i = 0; i < 10; ++i) bench.engaged_tick(0);
  EXPECT_EQ(beyond(0), 0);
  EXPECT_NEAR(beyond(2), 2e-3, 1e-12);
  EXPECT_EQ(beyond(-0.5), 0) << "nothing pulls the tip";
  EXPECT_NEAR(beyond(4), 3e-3, 1e-12) << "a force above the gate's limit moves nothing more";
  facts.stage.travel_max = 0.5e-3;
  Bench at_the_end{facts};
  for (int i = 0; i < 10; ++i) at_the_end.engaged_tick(0);
  at_the_end.force = 2;
  EXPECT_EQ(at_the_end.engaged_tick(0).target.position, 0.5e-3);
}

/// In the record a zero has a sign.
TEST(PatientControlTest, ARigidSensorLeavesTheReadingAsItIs) {
  Bench bench;
  bench.in.stage.position = -0.0;
  bench.force = -0.0;
  bench.tick();
  EXPECT_TRUE(std::signbit(bench.control.status().position));
}

TEST(PatientControlTest, ItsDevicesAndThePeersAreWrittenDownOnce) {
  PatientDevices facts;
  facts.stage.lag = 0.03;
  Bench bench{facts};
  bench.in.peer_devices.hand = HandFacts{.force_peak = 3};
  bench.tick();
  for (int i = 0; i < 5; ++i) bench.engaged_tick(0);
  const auto told = bench.recorder.all<DevicesTold>();
  ASSERT_EQ(told.size(), 2U);
  EXPECT_FALSE(told[0].of_peer);
  EXPECT_EQ(told[0].facts.stage->lag, 0.03);
  EXPECT_TRUE(told[1].of_peer);
  EXPECT_EQ(told[1].facts.hand->force_peak, 3);
  EXPECT_EQ(bench.control.status().peer_devices.hand->force_peak, 3);
}

TEST(PatientControlTest, ATicksRecordsEndWithWhatTheLinkSaid) {
  Bench bench;
  for (int i = 0; i < 20; ++i) bench.engaged_tick(0);
  std::size_t ticks = 0;
  for (const Record& record : bench.recorder.records()) {
    if (std::holds_alternative<LinkHeard>(record)) ++ticks;
  }
  EXPECT_EQ(ticks, 20U);
  EXPECT_EQ(bench.recorder.all<StageReading>().size(), 20U);
  EXPECT_EQ(bench.recorder.all<ForceReading>().size(), 20U);
  EXPECT_TRUE(std::holds_alternative<LinkHeard>(bench.recorder.records().back()));
}

TEST(PatientControlTest, TheMapRidesOnOneTelegramOfTwenty) {
  Bench bench;
  bench.in.found.map = {.number = 9, .places = 5, .depth = {7e-3, 6e-3, 8e-3}};
  int told = 0;
  for (int i = 0; i < 100; ++i) {
    const MapReport& map = bench.engaged_tick(0).to_peer.site.map;
    if (map == bench.in.found.map) ++told;
    EXPECT_TRUE(map == bench.in.found.map || map.number == 0);
  }
  EXPECT_EQ(told, 5);
  EXPECT_EQ(bench.control.status().map, bench.in.found.map);
}

TEST(PatientControlTest, TheCellsOfTheMapRideByTurnsBesideIt) {
  Bench bench;
  const std::array<MapCell, 3> cells{MapCell{.number = 9, .index = 0, .count = 3},
                                     MapCell{.number = 9, .index = 1, .count = 3},
                                     MapCell{.number = 9, .index = 2, .count = 3}};
  bench.in.map_cells = cells;
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(bench.engaged_tick(0).to_peer.site.map_cell.number, 0U) << "of no map";
  }
  bench.in.found.map = {.number = 9, .places = 5};
  std::array<int, 3> told{};
  for (int i = 0; i < 120; ++i) {
    const SiteReport site = bench.engaged_tick(0).to_peer.site;
    if (site.map_cell.number == 0) continue;
    ++told.at(site.map_cell.index);
    EXPECT_EQ(site.map.number, 0U) << "not both in one telegram";
  }
  EXPECT_EQ(told, (std::array{10, 10, 10}));
}

TEST(PatientControlTest, WhatAnEarlierSessionFoundIsNotSaidAgain) {
  Bench bench;
  bench.engaged_tick(0);
  bench.in.found.depth.number = 4;
  bench.in.found.map.number = 4;
  bench.engaged_tick(0);
  EXPECT_EQ(bench.control.status().depth.number, 4U);
  EXPECT_EQ(bench.control.status().map.number, 4U);
  bench.in.link.session_id = 2;
  EXPECT_EQ(bench.tick().to_peer.site.depth.number, 0U);
  EXPECT_EQ(bench.control.status().map.number, 0U);
  bench.in.found.depth.number = 5;
  EXPECT_EQ(bench.tick().to_peer.site.depth.number, 5U);
}

}  // namespace
}  // namespace palp::patient
