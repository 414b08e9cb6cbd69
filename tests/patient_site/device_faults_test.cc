#include <chrono>
#include <cmath>

#include <gtest/gtest.h>

#include "patient_site/patient_node.h"
#include "tests/patient_site/patient_world.h"

namespace palp::patient {
namespace {

using record::NoteCode;
using std::chrono::milliseconds;
using test::FaultySite;
using test::World;

TEST(PatientNodeTest, EveryFaultOfADeviceStopsTheSite) {
  const auto reason_of = [](auto&& happens) {
    World world;
    world.engage();
    happens(world.site);
    world.run(milliseconds{60});
    EXPECT_TRUE(world.site.halted);
    EXPECT_EQ(world.status().state, SiteState::Stopped);
    return static_cast<NoteCode>(world.recorder.all<Transition>().back().reason);
  };
  const auto fault = NoteCode::DeviceFault;
  EXPECT_EQ(reason_of([](FaultySite& site) { site.stage_faulted = true; }), fault);
  EXPECT_EQ(reason_of([](FaultySite& site) { site.stage_gives_nan = true; }), fault);
  EXPECT_EQ(reason_of([](FaultySite& site) { site.force = std::nan(""); }), fault);
  EXPECT_EQ(reason_of([](FaultySite& site) { site.saturated = true; }), NoteCode::SensorSaturated);
  EXPECT_EQ(reason_of([](FaultySite& site) { site.silent = true; }), NoteCode::SensorSilent);
}

TEST(PatientNodeTest, ASensorWhoseReadingStaysWhileTheTipMovesInContactStopsTheSite) {
  for (const double reading : {0.0, 0.25}) {
    World world;
    world.engage();
    world.say.port.force = 2;  // the hand feels it, so the tip goes where the hand is
    world.move(2e-3, milliseconds{800});
    world.site.force = reading;
    world.run(std::chrono::seconds{2});
    EXPECT_EQ(world.status().state, SiteState::Engaged) << "a tip at rest feels the same";
    world.move(4.9e-3, milliseconds{500});
    EXPECT_EQ(world.status().state, SiteState::Engaged);
    world.move(6e-3, milliseconds{200});
    EXPECT_EQ(world.status().state, SiteState::Stopped) << reading;
    EXPECT_EQ(world.status().reason, NoteCode::SensorStuck);
  }
}

TEST(PatientNodeTest, AQuietSensorInTheAirIsNoFault) {
  World world;
  world.engage();
  world.site.force = 0.0;
  world.move(-1e-3, milliseconds{500});
  world.move(-20e-3, milliseconds{500});
  EXPECT_EQ(world.status().state, SiteState::Engaged);
}

TEST(PatientNodeTest, AStageThatDoesNotFollowStopsTheSite) {
  World world;
  world.engage();
  world.site.stage_stuck = true;
  world.run(std::chrono::seconds{1});
  EXPECT_EQ(world.status().state, SiteState::Engaged) << "where it is to stand";
  world.move(-8.5e-3, milliseconds{20});
  EXPECT_EQ(world.status().state, SiteState::Engaged);
  world.run(milliseconds{150});
  EXPECT_EQ(world.status().state, SiteState::Stopped);
  EXPECT_EQ(world.status().reason, NoteCode::StageStuck);
}

TEST(PatientNodeTest, AStageThatRunsAwayStopsTheSiteWhateverItsStateWas) {
  for (const double speed : {10e-3, 100e-3, -10e-3, -100e-3}) {
    for (const SiteState state : {SiteState::Engaged, SiteState::Clutched, SiteState::Parked}) {
      World world;
      if (state == SiteState::Engaged) world.engage();
      if (state == SiteState::Clutched) world.say.site.state = state;
      world.silent = state == SiteState::Parked;
      world.run(milliseconds{300});
      ASSERT_EQ(world.status().state, state);
      const double began = world.status().position;
      world.site.stage_creep = speed;
      world.run(milliseconds{900});
      EXPECT_EQ(world.status().reason, NoteCode::StageStuck) << speed;
      EXPECT_EQ(world.status().state, SiteState::Stopped) << speed;
      EXPECT_NE(began, world.status().position);
    }
  }
}

TEST(PatientNodeTest, APullBeyondTheLimitStopsTheSite) {
  World world;
  world.engage();
  world.site.force = -2.9;
  world.run(milliseconds{100});
  EXPECT_EQ(world.status().state, SiteState::Engaged);
  world.site.force = -3.1;
  world.run(milliseconds{2});
  EXPECT_EQ(world.status().state, SiteState::Stopped);
  EXPECT_EQ(world.status().reason, NoteCode::ForceLimit);
}

TEST(PatientNodeTest, AShortSilenceOfTheSensorIsNoFault) {
  World world;
  world.engage();
  world.site.silent = true;
  world.run(milliseconds{50});
  EXPECT_EQ(world.status().state, SiteState::Engaged);
  world.run(milliseconds{1});
  EXPECT_EQ(world.status().state, SiteState::Stopped);
}

}  // namespace
}  // namespace palp::patient
