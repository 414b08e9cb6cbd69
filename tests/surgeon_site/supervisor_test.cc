#include "surgeon_site/supervisor.h"

#include <string>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp::surgeon {
namespace {

using std::chrono_literals::operator""s;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""ns;
using record::NoteCode;

/// A supervisor and the world it sees; each step is one tick later.
struct Site {
  SurgeonSupervisor supervisor{SupervisorConfig{.round_trip_max_to_engage = 20ms}};
  SupervisorInput in;

  Site() {
    in.link = LinkState::Live;
    in.session_id = 1;
    in.round_trip = 10ms;
    in.peer_heard = true;
    in.peer.state = SiteState::Parked;
    in.tip_known = true;
  }

  SupervisorOutput step(Duration after = 1ms) {
    in.now += after;
    return supervisor.step(in);
  }

  /// Brings a fresh site to `state` by the usual way, the peer following.
  static Site in_state(SiteState state) {
    Site site;
    if (state == SiteState::Parked) return site;
    site.in.peer.state = SiteState::Clutched;
    site.step();
    if (state == SiteState::Clutched) return site;
    site.in.pedal_held = true;
    site.step();
    site.in.peer.state = SiteState::Engaged;
    site.in.peer.epoch = 1;
    site.step();
    if (state == SiteState::Engaged) return site;
    if (state == SiteState::Hold) site.in.link = LinkState::Hold;
    if (state == SiteState::Retract) site.in.link = LinkState::Down;
    if (state == SiteState::Stopped) site.in.emergency_stop = true;
    site.step();
    return site;
  }
};

TEST(SupervisorTest, BuildersReachEveryState) {
  for (int i = 0; i < kSiteStateCount; ++i) {
    const auto state = static_cast<SiteState>(i);
    EXPECT_EQ(Site::in_state(state).supervisor.state(), state) << to_string(state);
  }
}

TEST(SupervisorTest, AfterALateTickOnlyAPedalThatIsLiftedAndPressedEngages) {
  Site site = Site::in_state(SiteState::Engaged);
  site.in.overslept = true;
  EXPECT_EQ(site.step().reason, NoteCode::TickLate);
  site.in.overslept = false;
  site.in.peer.state = SiteState::Clutched;
  for (int i = 0; i < 100; ++i) EXPECT_EQ(site.step().state, SiteState::Clutched);
  site.in.pedal_held = false;
  site.step();
  site.in.pedal_held = true;
  EXPECT_EQ(site.step().state, SiteState::Engaged);
}

struct Arrow {
  const char* name;
  SiteState from;
  void (*change)(SupervisorInput& in);
  SiteState to;
  NoteCode reason;
};

class SupervisorArrows : public ::testing::TestWithParam<Arrow> {};

TEST_P(SupervisorArrows, LeadsThereForThatReason) {
  const Arrow& arrow = GetParam();
  Site site = Site::in_state(arrow.from);
  arrow.change(site.in);
  const SupervisorOutput out = site.step();
  EXPECT_EQ(out.state, arrow.to) << "to " << to_string(out.state);
  EXPECT_EQ(out.reason, arrow.reason);
  EXPECT_EQ(out.engaged_now, arrow.reason == NoteCode::PedalPressed);
}

using S = SiteState;
constexpr auto kNone = NoteCode::None;

const Arrow kArrows[]{
    {"ParkedLinkReady", S::Parked, [](auto&) {}, S::Clutched, NoteCode::LinkReady},
    {"ParkedLinkDown", S::Parked, [](auto& in) { in.link = LinkState::Down; }, S::Parked, kNone},
    {"ParkedLinkHold", S::Parked, [](auto& in) { in.link = LinkState::Hold; }, S::Parked, kNone},
    {"ParkedPeerUnheard", S::Parked, [](auto& in) { in.peer_heard = false; }, S::Parked, kNone},
    {"ParkedPeerStopped",
     S::Parked,
     [](auto& in) { in.peer.state = S::Stopped; },
     S::Parked,
     kNone},
    {"ParkedFault",
     S::Parked,
     [](auto& in) { in.device_faulted = true; },
     S::Stopped,
     NoteCode::DeviceFault},
    {"ClutchedStays", S::Clutched, [](auto&) {}, S::Clutched, kNone},
    {"ClutchedPedal",
     S::Clutched,
     [](auto& in) { in.pedal_held = true; },
     S::Engaged,
     NoteCode::PedalPressed},
    {"ClutchedLinkHold",
     S::Clutched,
     [](auto& in) { in.link = LinkState::Hold; },
     S::Clutched,
     kNone},
    {"ClutchedLinkLost",
     S::Clutched,
     [](auto& in) { in.link = LinkState::Lost; },
     S::Retract,
     NoteCode::GapLost},
    {"ClutchedLinkDown",
     S::Clutched,
     [](auto& in) { in.link = LinkState::Down; },
     S::Retract,
     NoteCode::LinkDown},
    {"ClutchedPeerStops",
     S::Clutched,
     [](auto& in) { in.peer.state = S::Stopped; },
     S::Stopped,
     NoteCode::PeerStopped},
    {"EngagedStays", S::Engaged, [](auto&) {}, S::Engaged, kNone},
    {"EngagedSlept",
     S::Engaged,
     [](auto& in) { in.overslept = true; },
     S::Clutched,
     NoteCode::TickLate},
    {"HoldSlept", S::Hold, [](auto& in) { in.overslept = true; }, S::Clutched, NoteCode::TickLate},
    {"ClutchedSleptOverThePedal",
     S::Clutched,
     [](auto& in) { in.overslept = in.pedal_held = true; },
     S::Clutched,
     kNone},
    {"RetractSlept", S::Retract, [](auto& in) { in.overslept = true; }, S::Retract, kNone},
    {"EngagedPedalUp",
     S::Engaged,
     [](auto& in) { in.pedal_held = false; },
     S::Clutched,
     NoteCode::PedalReleased},
    {"EngagedPeerClutches",
     S::Engaged,
     [](auto& in) { in.peer.state = S::Clutched; },
     S::Clutched,
     NoteCode::PeerClutched},
    {"EngagedPeerHolds", S::Engaged, [](auto& in) { in.peer.state = S::Hold; }, S::Engaged, kNone},
    {"EngagedPeerRetracts",
     S::Engaged,
     [](auto& in) { in.peer.state = S::Retract; },
     S::Retract,
     NoteCode::PeerRetracting},
    {"EngagedPeerParks",
     S::Engaged,
     [](auto& in) { in.peer.state = S::Parked; },
     S::Retract,
     NoteCode::PeerRetracting},
    {"EngagedPeerStops",
     S::Engaged,
     [](auto& in) { in.peer.state = S::Stopped; },
     S::Stopped,
     NoteCode::PeerStopped},
    {"EngagedSessionBegins",
     S::Engaged,
     [](auto& in) { in.session_id = 2; },
     S::Retract,
     NoteCode::SessionBegan},
    {"EngagedLinkHold",
     S::Engaged,
     [](auto& in) { in.link = LinkState::Hold; },
     S::Hold,
     NoteCode::GapHold},
    {"EngagedLinkLost",
     S::Engaged,
     [](auto& in) { in.link = LinkState::Lost; },
     S::Hold,
     NoteCode::GapHold},
    {"EngagedLinkDown",
     S::Engaged,
     [](auto& in) { in.link = LinkState::Down; },
     S::Retract,
     NoteCode::LinkDown},
    {"EngagedEmergency",
     S::Engaged,
     [](auto& in) { in.emergency_stop = true; },
     S::Stopped,
     NoteCode::EmergencyStop},
    {"EngagedFault",
     S::Engaged,
     [](auto& in) { in.device_faulted = true; },
     S::Stopped,
     NoteCode::DeviceFault},
    {"HoldStays", S::Hold, [](auto& in) { in.gap = 2s; }, S::Hold, kNone},
    {"HoldGapOver",
     S::Hold,
     [](auto& in) { in.link = LinkState::Live; },
     S::Engaged,
     NoteCode::GapOver},
    {"HoldGapTooLong",
     S::Hold,
     [](auto& in) {
       in.link = LinkState::Lost;
       in.gap = 2s + 1ns;
     },
     S::Retract,
     NoteCode::GapLost},
    {"HoldLinkDown",
     S::Hold,
     [](auto& in) { in.link = LinkState::Down; },
     S::Retract,
     NoteCode::LinkDown},
    {"HoldPedalUp",
     S::Hold,
     [](auto& in) { in.pedal_held = false; },
     S::Clutched,
     NoteCode::PedalReleased},
    {"HoldPeerRetracts",
     S::Hold,
     [](auto& in) {
       in.link = LinkState::Live;
       in.peer.state = S::Retract;
     },
     S::Retract,
     NoteCode::PeerRetracting},
    {"HoldSessionBegins",
     S::Hold,
     [](auto& in) {
       in.link = LinkState::Live;
       in.session_id = 2;
     },
     S::Retract,
     NoteCode::SessionBegan},
    {"RetractStays", S::Retract, [](auto& in) { in.link = LinkState::Live; }, S::Retract, kNone},
    {"RetractEmergency",
     S::Retract,
     [](auto& in) { in.emergency_stop = true; },
     S::Stopped,
     NoteCode::EmergencyStop},
    {"StoppedStays", S::Stopped, [](auto& in) { in.emergency_stop = false; }, S::Stopped, kNone},
    {"StoppedResetTooEarly",
     S::Stopped,
     [](auto& in) { in.local_reset = true; },
     S::Stopped,
     kNone},
    {"StoppedReset",
     S::Stopped,
     [](auto& in) {
       in.emergency_stop = false;
       in.local_reset = true;
     },
     S::Parked,
     NoteCode::LocalReset},
};

std::string name_of(const ::testing::TestParamInfo<Arrow>& arrow) { return arrow.param.name; }

INSTANTIATE_TEST_SUITE_P(All, SupervisorArrows, ::testing::ValuesIn(kArrows), name_of);

TEST(SupervisorTest, EngagesOnlyWhenEverythingIsReady) {
  const auto refuses = [](void (*change)(SupervisorInput & in)) {
    Site site = Site::in_state(SiteState::Clutched);
    change(site.in);
    site.in.pedal_held = true;
    const SupervisorOutput out = site.step();
    return out.state == SiteState::Clutched && out.epoch == 0 && !out.engaged_now;
  };
  EXPECT_TRUE(refuses([](auto& in) { in.link = LinkState::Hold; }));
  EXPECT_TRUE(refuses([](auto& in) { in.peer.state = SiteState::Parked; }));
  EXPECT_TRUE(refuses([](auto& in) { in.peer.state = SiteState::Retract; }));
  EXPECT_TRUE(refuses([](auto& in) { in.tip_known = false; }));
  EXPECT_FALSE(refuses([](auto&) {}));
}

TEST(SupervisorTest, PedalEngagesByItsEdgeOnly) {
  Site held;
  held.in.peer.state = SiteState::Clutched;
  held.in.pedal_held = true;
  held.step();
  EXPECT_EQ(held.step().state, SiteState::Clutched) << "held since before the clutch";
  held.in.pedal_held = false;
  held.step();
  held.in.pedal_held = true;
  EXPECT_EQ(held.step().state, SiteState::Engaged);
}

TEST(SupervisorTest, RefusesALongRoundTripAndNotesIt) {
  Site site = Site::in_state(SiteState::Clutched);
  site.in.pedal_held = true;
  site.in.round_trip = 20ms + 1ns;
  const SupervisorOutput refused = site.step();
  EXPECT_EQ(refused.state, SiteState::Clutched);
  EXPECT_EQ(refused.refused, NoteCode::RoundTripTooLong);
  EXPECT_NEAR(refused.detail, 0.02, 1e-6);
  EXPECT_EQ(site.step().refused, NoteCode::None) << "once per press";

  Site border = Site::in_state(SiteState::Clutched);
  border.in.pedal_held = true;
  border.in.round_trip = 20ms;
  EXPECT_EQ(border.step().state, SiteState::Engaged);

  Site forced = Site::in_state(SiteState::Clutched);
  forced.supervisor = SurgeonSupervisor{SupervisorConfig{}};
  forced.in.pedal_held = false;
  forced.step();
  forced.in.pedal_held = true;
  forced.in.round_trip = 600ms;
  EXPECT_EQ(forced.step().state, SiteState::Engaged) << "no limit";
}

TEST(SupervisorTest, EveryEngagementOpensTheNextEpoch) {
  Site site = Site::in_state(SiteState::Engaged);
  EXPECT_EQ(site.supervisor.epoch(), 1U);
  site.in.pedal_held = false;
  site.step();
  site.in.peer.state = SiteState::Clutched;
  site.step();
  site.in.pedal_held = true;
  EXPECT_EQ(site.step().epoch, 2U);
}

TEST(SupervisorTest, RestartedSurgeonOpensAnEpochAboveThePatients) {
  Site site = Site::in_state(SiteState::Clutched);
  site.in.peer.epoch = 7;
  site.in.pedal_held = true;
  EXPECT_EQ(site.step().epoch, 8U);
}

TEST(SupervisorTest, NewSessionCountsEpochsFromZero) {
  Site site = Site::in_state(SiteState::Engaged);
  site.in.session_id = 2;
  site.in.link = LinkState::Down;
  site.in.peer = {};
  site.in.peer_heard = false;
  const SupervisorOutput out = site.step();
  EXPECT_TRUE(out.session_began);
  EXPECT_EQ(out.epoch, 0U);
  EXPECT_EQ(out.reason, NoteCode::SessionBegan);
  EXPECT_FALSE(site.step().session_began);
}

TEST(SupervisorTest, EndOfASessionIsNoNewOne) {
  Site site = Site::in_state(SiteState::Engaged);
  site.in.session_id = 0;
  site.in.link = LinkState::Down;
  const SupervisorOutput out = site.step();
  EXPECT_FALSE(out.session_began);
  EXPECT_EQ(out.epoch, 1U);
  EXPECT_EQ(out.reason, NoteCode::LinkDown);
}

TEST(SupervisorTest, ReportsOfAnOlderEpochMoveNothingButStop) {
  for (const SiteState peer : {SiteState::Clutched, SiteState::Parked, SiteState::Retract}) {
    Site site = Site::in_state(SiteState::Clutched);
    site.in.pedal_held = true;
    site.step();
    site.in.peer.state = peer;  // still of epoch 0: it has not heard of the engagement
    EXPECT_EQ(site.step().state, SiteState::Engaged) << to_string(peer);
    site.in.peer.epoch = 1;
    EXPECT_NE(site.step().state, SiteState::Engaged) << to_string(peer);
  }
  Site site = Site::in_state(SiteState::Clutched);
  site.in.pedal_held = true;
  site.step();
  site.in.peer.state = SiteState::Stopped;
  EXPECT_EQ(site.step().state, SiteState::Stopped);
}

TEST(SupervisorTest, GoesBackToClutchedWhenThePeerNeverFollows) {
  Site site = Site::in_state(SiteState::Clutched);
  site.in.pedal_held = true;
  site.step();
  EXPECT_EQ(site.step(3s).state, SiteState::Engaged);
  const SupervisorOutput out = site.step(1ms);
  EXPECT_EQ(out.state, SiteState::Clutched);
  EXPECT_EQ(out.reason, NoteCode::PeerClutched);
}

TEST(SupervisorTest, AfterLostTheForceFadesAndTheHandMustEngageAgain) {
  Site site = Site::in_state(SiteState::Hold);
  site.in.link = LinkState::Lost;
  site.in.gap = 600ms;
  EXPECT_EQ(site.step().state, SiteState::Hold);
  site.in.link = LinkState::Live;
  site.in.gap = 0ms;
  SupervisorOutput out = site.step();
  EXPECT_EQ(out.state, SiteState::Retract);
  EXPECT_EQ(out.reason, NoteCode::GapLost);
  EXPECT_EQ(site.step(999ms).state, SiteState::Retract);
  out = site.step(1ms);
  EXPECT_EQ(out.state, SiteState::Parked);
  EXPECT_EQ(out.reason, NoteCode::RetractDone);
  EXPECT_EQ(site.step().state, SiteState::Clutched);
  EXPECT_EQ(site.step().state, SiteState::Clutched) << "the pedal is still held: no edge";
}

TEST(SupervisorTest, OwnResetLeavesStoppedWhileThePeerStillIs) {
  Site site = Site::in_state(SiteState::Engaged);
  site.in.peer.state = SiteState::Stopped;
  ASSERT_EQ(site.step().state, SiteState::Stopped);
  site.in.local_reset = true;
  EXPECT_EQ(site.step().state, SiteState::Parked);
  site.in.local_reset = false;
  EXPECT_EQ(site.step().state, SiteState::Parked) << "until the peer was reset as well";
  site.in.peer.state = SiteState::Parked;
  EXPECT_EQ(site.step().state, SiteState::Clutched);
}

RC_GTEST_PROP(SupervisorTest, NoInputEngagesWithoutAnEdgeOnALiveLink, ()) {
  Site site;
  bool held = true;
  std::uint32_t epoch = 0;
  for (int i = 0; i < 300; ++i) {
    site.in.pedal_held = *rc::gen::arbitrary<bool>();
    site.in.link = static_cast<LinkState>(*rc::gen::inRange(0, kLinkStateCount));
    site.in.peer.state = static_cast<SiteState>(*rc::gen::inRange(0, kSiteStateCount));
    site.in.peer.epoch = *rc::gen::inRange<std::uint32_t>(0, 4);
    site.in.emergency_stop = *rc::gen::inRange(0, 40) == 0;
    site.in.local_reset = *rc::gen::inRange(0, 4) == 0;
    const SiteState before = site.supervisor.state();
    const SupervisorOutput out = site.step(*rc::gen::element<Duration>(1ms, 300ms, 1500ms));
    RC_ASSERT(out.epoch >= epoch);
    RC_ASSERT((out.reason == NoteCode::None) == (out.state == before));
    if (out.state == SiteState::Engaged && before != SiteState::Engaged) {
      RC_ASSERT(site.in.link == LinkState::Live && site.in.pedal_held);
      RC_ASSERT(before == SiteState::Hold || (!held && out.epoch > epoch));
    }
    held = site.in.pedal_held;
    epoch = out.epoch;
  }
}

}  // namespace
}  // namespace palp::surgeon
