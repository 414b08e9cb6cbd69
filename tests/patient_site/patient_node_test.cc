#include "patient_site/patient_node.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "patient_site/estimator_worker.h"
#include "tests/patient_site/patient_world.h"

namespace palp::patient {
namespace {

using record::NoteCode;
using std::chrono::milliseconds;
using test::World;

TEST(PatientNodeTest, FollowsTheHandWhenEngagedAndSaysWhatItFeels) {
  World world;
  world.engage();
  world.move(3e-3, milliseconds{800});
  EXPECT_NEAR(world.plant.truth().position, 3e-3, 20e-6);
  const PatientStatus status = world.status();
  EXPECT_NEAR(status.contact_force, world.phantom.plain.force(3e-3), 0.1);
  EXPECT_TRUE(status.surface_known);
  EXPECT_NEAR(status.surface, 0, 0.6e-3);
  EXPECT_EQ(status.records_lost, 0U);
}

TEST(PatientNodeTest, SendsItsPositionForceAndState) {
  World world;
  world.engage();
  world.move(2e-3, milliseconds{500});
  EXPECT_EQ(world.heard.peer.state, SiteState::Engaged);
  EXPECT_EQ(world.heard.peer.epoch, 1U);
  EXPECT_TRUE(world.site.touch_expected);
  ASSERT_FALSE(world.heard.samples.empty());
  EXPECT_NEAR(world.heard.samples.back().sample.position, 2e-3, 20e-6);
  EXPECT_GT(world.heard.samples.back().sample.force, 0);
}

TEST(PatientNodeTest, DoesNotMoveBeforeItIsEngaged) {
  World world;
  world.say.site.state = SiteState::Clutched;
  world.move(3e-3, milliseconds{500});
  EXPECT_NEAR(world.plant.truth().position, -10e-3, 1e-6);
  EXPECT_FALSE(world.site.touch_expected) << "a tare may go on";
}

TEST(PatientNodeTest, GivesTheEstimatorEveryTickOfAnEngagement) {
  World world;
  world.engage();
  world.run(milliseconds{300});
  ContactSample sample;
  std::uint64_t count = 0;
  while (world.contact.try_dequeue(sample)) {
    ++count;
    EXPECT_NEAR(sample.position, -10e-3, 20e-6);
  }
  EXPECT_EQ(count, world.status().contact_samples);
  EXPECT_NEAR(static_cast<double>(count), 300, 6);
}

TEST(PatientNodeTest, CountsSamplesTheEstimatorHasNoRoomFor) {
  World world;
  world.engage();
  world.run(std::chrono::seconds{34});
  EXPECT_GT(world.status().contact_samples_lost, 0U);
  EXPECT_EQ(world.status().state, SiteState::Engaged);
}

TEST(PatientNodeTest, TheNewestDepthRidesOnEveryTelegram) {
  World world;
  world.engage();
  DepthEstimate estimate;
  estimate.number = 3;
  estimate.verdict = DepthVerdict::Found;
  estimate.depth = 10.2e-3;
  estimate.hash = 0.0689;
  world.found.put({.depth = estimate, .map = {}});
  world.run(milliseconds{5});
  EXPECT_EQ(world.heard.peer.depth.number, 3U);
  EXPECT_NEAR(world.heard.peer.depth.depth, 10.2e-3, 1e-8);
  EXPECT_NEAR(world.heard.peer.depth.hash, 0.0689, 1e-7);
}

TEST(PatientNodeTest, HoldsInAGapAndRetractsWhenTheLinkIsLost) {
  World world;
  world.engage();
  world.move(3e-3, milliseconds{800});
  world.silent = true;
  world.run(milliseconds{110});
  EXPECT_EQ(world.status().state, SiteState::Hold);
  EXPECT_NEAR(world.plant.truth().position, 3e-3, 20e-6);
  world.run(milliseconds{400});
  EXPECT_EQ(world.status().state, SiteState::Retract);
  world.run(std::chrono::seconds{2});
  EXPECT_EQ(world.status().state, SiteState::Parked);
  EXPECT_NEAR(world.plant.truth().position, world.status().surface - 2e-3, 0.1e-3);
  world.silent = false;
  world.run(milliseconds{300});
  EXPECT_EQ(world.status().state, SiteState::Clutched) << "the surgeon must engage again";
}

TEST(PatientNodeTest, ComesOutOfHoldWithARamp) {
  World world;
  world.engage();
  world.silent = true;
  world.run(milliseconds{110});
  ASSERT_EQ(world.status().state, SiteState::Hold);
  world.silent = false;
  world.say.port.position = -4e-3;
  double fastest = 0;
  for (int i = 0; i < 400; ++i) {
    world.tick();
    fastest = std::max(fastest, world.plant.truth().velocity);
  }
  EXPECT_EQ(world.status().state, SiteState::Engaged);
  EXPECT_LT(fastest, 0.05);
  EXPECT_NEAR(world.plant.truth().position, -4e-3, 20e-6);
}

TEST(PatientNodeTest, WalksAwayFromTooMuchForceAndStopsAboveFiveNewton) {
  World world;
  world.engage();
  world.move(3e-3, milliseconds{800});
  world.site.force = 3.5;
  world.run(milliseconds{50});
  EXPECT_EQ(world.status().state, SiteState::Engaged);
  EXPECT_LT(world.plant.truth().position, 1e-3);
  world.site.force = 5.0;
  world.run(milliseconds{2});
  EXPECT_EQ(world.status().state, SiteState::Engaged);
  world.site.force = 5.05;
  world.run(milliseconds{2});
  EXPECT_EQ(world.status().state, SiteState::Stopped);
}

TEST(PatientNodeTest, LeavesStoppedByALocalResetOnly) {
  World world;
  world.engage();
  world.node.commands().put({.emergency_stop = true, .resets = 0});
  world.run(milliseconds{2});
  EXPECT_EQ(world.status().state, SiteState::Stopped);
  world.node.commands().put({.emergency_stop = false, .resets = 0});
  world.run(milliseconds{100});
  EXPECT_EQ(world.status().state, SiteState::Stopped);
  world.node.commands().put({.emergency_stop = false, .resets = 1});
  world.run(milliseconds{1});
  EXPECT_EQ(world.status().state, SiteState::Parked);
}

TEST(PatientNodeTest, RefusesToEngageInTissueAndWalksOut) {
  World world;
  world.engage();
  world.move(3e-3, milliseconds{800});
  world.say.site.state = SiteState::Clutched;
  world.run(milliseconds{10});
  ASSERT_EQ(world.status().state, SiteState::Clutched);
  world.say.site.state = SiteState::Engaged;
  world.say.site.epoch = 2;
  world.run(milliseconds{10});
  EXPECT_EQ(world.status().state, SiteState::Retract);
  EXPECT_EQ(world.status().epoch, 2U);
  EXPECT_EQ(world.status().refused, NoteCode::EngageRefusedForce);
  world.say.site.state = SiteState::Clutched;
  world.run(std::chrono::seconds{2});
  EXPECT_EQ(world.status().state, SiteState::Clutched);
  world.say.site.state = SiteState::Engaged;
  world.say.site.epoch = 3;
  world.run(milliseconds{10});
  EXPECT_EQ(world.status().state, SiteState::Engaged);
}

bool noted(const World& world, NoteCode code) {
  for (const Note& note : world.recorder.all<Note>()) {
    if (note.code == static_cast<std::uint16_t>(code)) return true;
  }
  return false;
}

TEST(PatientNodeTest, ALawThatGivesNoNumberMovesNothing) {
  World world;
  world.engage();
  coupling::DirectConfig broken;
  broken.position_scale = std::numeric_limits<double>::quiet_NaN();
  world.law = coupling::PatientCoupling{coupling::DirectPatient{broken}};
  world.run(milliseconds{100});
  EXPECT_NEAR(world.plant.truth().position, -10e-3, 10e-6);
  EXPECT_TRUE(noted(world, NoteCode::NotFinite));
}

TEST(PatientNodeTest, ChangesThePlaceWithTheSurgeon) {
  World world;
  world.engage();
  world.say.site.place = {10e-3, -4e-3};
  world.run(milliseconds{300});
  EXPECT_NEAR(distance(world.status().place, {10e-3, -4e-3}), 0, 1e-8);
  EXPECT_EQ(world.status().place_refused, NoteCode::None);
}

TEST(PatientNodeTest, AStageThatCannotDragSaysSo) {
  World world{{.can_drag = false}};
  world.engage();
  world.move(3e-3, milliseconds{800});
  world.say.site.place = {4e-3, 3e-3};
  world.run(milliseconds{500});
  EXPECT_EQ(world.status().place, kSiteA);
  EXPECT_EQ(world.status().place_refused, NoteCode::DragRefused);
  EXPECT_TRUE(noted(world, NoteCode::DragRefused));
}

TEST(PatientNodeTest, RecordsEachTickEachArrivalAndTheLinkTenTimesASecond) {
  World world;
  world.engage();
  world.run(std::chrono::seconds{1});
  const PatientStatus status = world.status();
  EXPECT_EQ(world.recorder.all<SiteTick>().size(), status.ticks);
  EXPECT_EQ(world.recorder.records().size(), status.records);
  EXPECT_NEAR(static_cast<double>(world.recorder.all<Arrived>().size()),
              static_cast<double>(status.ticks),
              110);
  EXPECT_NEAR(static_cast<double>(world.recorder.all<LinkStatus>().size()), 12, 1);
  const auto transitions = world.recorder.all<Transition>();
  ASSERT_EQ(transitions.size(), 2U);
  EXPECT_EQ(transitions[0].to, SiteState::Clutched);
  EXPECT_EQ(transitions[1].to, SiteState::Engaged);
}

TEST(PatientNodeTest, CountsThePeriodsItMissed) {
  World world;
  world.run(milliseconds{10});
  world.now += milliseconds{4};
  world.tick();
  EXPECT_EQ(world.status().ticks_missed, 4U);
}

// Goal: a tap through the whole site gives the depth. Method: the hand comes as samples over the
// link, the estimator is drained as the lab does.
TEST(PatientNodeTest, ATapGivesADepthAtTheSurgeons) {
  World world;
  palp::test::KeepingRecorder stroke_recorder;
  EstimatorWorker worker{{}, {world.contact, world.found, world.cells, stroke_recorder}};
  world.engage();
  world.say.site.place = kSiteB;
  world.move(-3e-3, milliseconds{500});
  for (int tap = 0; tap < 3; ++tap) {
    for (int i = 0; i < 1500; ++i) {
      const double t = std::min(i * 1e-3, 1.0);
      world.say.port.position = -3e-3 + 3.5e-3 * (1 - std::cos(2 * 3.14159265358979 * t));
      world.tick();
      (void)worker.drain();
    }
  }
  EXPECT_EQ(world.heard.peer.depth.number, 3U);
  EXPECT_EQ(world.heard.peer.depth.verdict, DepthVerdict::Found);
  EXPECT_NEAR(world.heard.peer.depth.hash, 0.0689, 0.006);
  EXPECT_EQ(worker.strokes(), 3U);
}

}  // namespace
}  // namespace palp::patient
