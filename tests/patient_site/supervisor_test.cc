#include "patient_site/supervisor.h"

#include <gtest/gtest.h>

namespace palp::patient {
namespace {

using record::NoteCode;

/// A quiet world: link Live in session 1, surgeon Clutched in epoch 0, tip clear, devices well.
SupervisorInput quiet() {
  SupervisorInput in;
  in.link = LinkState::Live;
  in.session_id = 1;
  in.peer = {SiteState::Clutched, 0, {}, {}};
  in.peer_heard = true;
  in.free_to_follow = true;
  in.retracted = true;
  return in;
}

SupervisorInput pressed(std::uint32_t epoch = 1) {
  SupervisorInput in = quiet();
  in.peer.state = SiteState::Engaged;
  in.peer.epoch = epoch;
  return in;
}

SupervisorInput with_link(LinkState link) {
  SupervisorInput in = pressed();
  in.link = link;
  return in;
}

PatientSupervisor in_state(SiteState state) {
  PatientSupervisor site;
  if (state == SiteState::Parked) return site;
  (void)site.step(quiet());
  if (state == SiteState::Clutched) return site;
  (void)site.step(pressed());
  if (state == SiteState::Engaged) return site;
  if (state == SiteState::Hold) (void)site.step(with_link(LinkState::Hold));
  SupervisorInput in = pressed();
  if (state == SiteState::Retract) {
    in.link = LinkState::Down;
    in.retracted = false;
    (void)site.step(in);
  }
  if (state == SiteState::Stopped) {
    in.emergency_stop = true;
    (void)site.step(in);
  }
  return site;
}

TEST(PatientSupervisorTest, ReachesEveryState) {
  for (int i = 0; i < kSiteStateCount; ++i) {
    const auto state = static_cast<SiteState>(i);
    EXPECT_EQ(in_state(state).state(), state) << to_string(state);
  }
}

struct Arrow {
  const char* name;
  SiteState from;
  SupervisorInput in;
  SiteState to;
  NoteCode reason;
};

SupervisorInput changed(SupervisorInput in, const auto& change) {
  change(in);
  return in;
}

/// One list: the table of the supervisor's states.
// NOLINTNEXTLINE(readability-function-size): a table
std::vector<Arrow> arrows() {
  using S = SiteState;
  const auto peer = [](S state) {
    return changed(pressed(), [&](auto& in) { in.peer.state = state; });
  };
  const auto stop = [](const auto& change) { return changed(pressed(), change); };
  return {
      {"parked_ready", S::Parked, quiet(), S::Clutched, NoteCode::LinkReady},
      {"parked_down",
       S::Parked,
       changed(quiet(), [](auto& in) { in.link = LinkState::Down; }),
       S::Parked,
       NoteCode::None},
      {"parked_unheard",
       S::Parked,
       changed(quiet(), [](auto& in) { in.peer_heard = false; }),
       S::Parked,
       NoteCode::None},
      {"parked_not_clear",
       S::Parked,
       changed(quiet(), [](auto& in) { in.retracted = false; }),
       S::Parked,
       NoteCode::None},
      {"parked_peer_stopped",
       S::Parked,
       changed(quiet(), [](auto& in) { in.peer.state = S::Stopped; }),
       S::Parked,
       NoteCode::None},
      {"clutched_quiet", S::Clutched, quiet(), S::Clutched, NoteCode::None},
      {"clutched_engage", S::Clutched, pressed(), S::Engaged, NoteCode::PeerEngaged},
      {"clutched_slept",
       S::Clutched,
       changed(pressed(), [](auto& in) { in.overslept = true; }),
       S::Clutched,
       NoteCode::None},
      {"engaged_slept",
       S::Engaged,
       changed(pressed(), [](auto& in) { in.overslept = true; }),
       S::Clutched,
       NoteCode::TickLate},
      {"hold_slept",
       S::Hold,
       changed(pressed(), [](auto& in) { in.overslept = true; }),
       S::Clutched,
       NoteCode::TickLate},
      {"clutched_in_tissue",
       S::Clutched,
       changed(pressed(), [](auto& in) { in.free_to_follow = false; }),
       S::Retract,
       NoteCode::EngageRefusedForce},
      {"clutched_hold", S::Clutched, with_link(LinkState::Hold), S::Clutched, NoteCode::None},
      {"clutched_lost", S::Clutched, with_link(LinkState::Lost), S::Retract, NoteCode::GapLost},
      {"clutched_down", S::Clutched, with_link(LinkState::Down), S::Retract, NoteCode::LinkDown},
      {"engaged_goes_on", S::Engaged, pressed(), S::Engaged, NoteCode::None},
      {"engaged_clutch", S::Engaged, peer(S::Clutched), S::Clutched, NoteCode::PeerClutched},
      {"engaged_peer_hold", S::Engaged, peer(S::Hold), S::Engaged, NoteCode::None},
      {"engaged_peer_retract", S::Engaged, peer(S::Retract), S::Retract, NoteCode::PeerRetracting},
      {"engaged_peer_parked", S::Engaged, peer(S::Parked), S::Retract, NoteCode::PeerRetracting},
      {"engaged_hold", S::Engaged, with_link(LinkState::Hold), S::Hold, NoteCode::GapHold},
      {"engaged_lost", S::Engaged, with_link(LinkState::Lost), S::Retract, NoteCode::GapLost},
      {"engaged_down", S::Engaged, with_link(LinkState::Down), S::Retract, NoteCode::LinkDown},
      {"engaged_old_epoch",
       S::Engaged,
       changed(peer(S::Clutched), [](auto& in) { in.peer.epoch = 0; }),
       S::Engaged,
       NoteCode::None},
      {"engaged_again", S::Engaged, pressed(2), S::Engaged, NoteCode::None},
      {"engaged_again_in_tissue",
       S::Engaged,
       changed(pressed(2), [](auto& in) { in.free_to_follow = false; }),
       S::Clutched,
       NoteCode::PeerClutched},
      {"engaged_new_session",
       S::Engaged,
       changed(pressed(), [](auto& in) { in.session_id = 2; }),
       S::Retract,
       NoteCode::SessionBegan},
      {"hold_goes_on", S::Hold, with_link(LinkState::Hold), S::Hold, NoteCode::None},
      {"hold_over", S::Hold, pressed(), S::Engaged, NoteCode::GapOver},
      {"hold_over_clutched", S::Hold, peer(S::Clutched), S::Clutched, NoteCode::PeerClutched},
      {"hold_over_retract", S::Hold, peer(S::Retract), S::Retract, NoteCode::PeerRetracting},
      {"hold_lost", S::Hold, with_link(LinkState::Lost), S::Retract, NoteCode::GapLost},
      {"hold_down", S::Hold, with_link(LinkState::Down), S::Retract, NoteCode::LinkDown},
      {"retract_under_way",
       S::Retract,
       changed(pressed(5), [](auto& in) { in.retracted = false; }),
       S::Retract,
       NoteCode::None},
      {"retract_done", S::Retract, pressed(5), S::Parked, NoteCode::RetractDone},
      {"stopped_stays", S::Stopped, pressed(5), S::Stopped, NoteCode::None},
      {"stopped_reset",
       S::Stopped,
       changed(quiet(), [](auto& in) { in.local_reset = true; }),
       S::Parked,
       NoteCode::LocalReset},
      {"stopped_reset_too_early",
       S::Stopped,
       changed(quiet(),
               [](auto& in) {
                 in.local_reset = true;
                 in.device_fault = NoteCode::SensorStuck;
               }),
       S::Stopped,
       NoteCode::None},
      {"engaged_emergency",
       S::Engaged,
       stop([](auto& in) { in.emergency_stop = true; }),
       S::Stopped,
       NoteCode::EmergencyStop},
      {"engaged_fault",
       S::Engaged,
       stop([](auto& in) { in.device_fault = NoteCode::SensorStuck; }),
       S::Stopped,
       NoteCode::SensorStuck},
      {"engaged_force",
       S::Engaged,
       stop([](auto& in) { in.force_exceeded = true; }),
       S::Stopped,
       NoteCode::ForceLimit},
      {"engaged_peer_stop", S::Engaged, peer(S::Stopped), S::Stopped, NoteCode::PeerStopped},
      {"hold_peer_stop", S::Hold, peer(S::Stopped), S::Stopped, NoteCode::PeerStopped},
      {"retract_emergency",
       S::Retract,
       stop([](auto& in) { in.emergency_stop = true; }),
       S::Stopped,
       NoteCode::EmergencyStop},
      {"stop_of_an_old_epoch",
       S::Engaged,
       changed(peer(S::Stopped), [](auto& in) { in.peer.epoch = 0; }),
       S::Stopped,
       NoteCode::PeerStopped},
  };
}

class Arrows : public ::testing::TestWithParam<Arrow> {};

TEST_P(Arrows, LeadWhereTheTableSays) {
  PatientSupervisor site = in_state(GetParam().from);
  ASSERT_EQ(site.state(), GetParam().from);
  const SupervisorOutput out = site.step(GetParam().in);
  EXPECT_EQ(out.state, GetParam().to) << to_string(out.state);
  EXPECT_EQ(out.reason, GetParam().reason) << static_cast<int>(out.reason);
}

INSTANTIATE_TEST_SUITE_P(All, Arrows, ::testing::ValuesIn(arrows()), [](const auto& one) {
  return std::string{one.param.name};
});

TEST(PatientSupervisorTest, TakesTheSurgeonsEpochWhenItFollows) {
  PatientSupervisor site = in_state(SiteState::Clutched);
  const SupervisorOutput out = site.step(pressed(4));
  EXPECT_TRUE(out.engaged_now);
  EXPECT_EQ(out.epoch, 4U);
  EXPECT_FALSE(site.step(pressed(4)).engaged_now) << "one epoch engages once";
}

TEST(PatientSupervisorTest, WalksOutInTheNewEpochWhereTheTipStandsInTissue) {
  PatientSupervisor site = in_state(SiteState::Clutched);
  SupervisorInput in = pressed(4);
  in.free_to_follow = false;
  in.contact_force = 0.4;
  const SupervisorOutput refused = site.step(in);
  EXPECT_EQ(refused.state, SiteState::Retract) << "or nobody could ever engage again";
  EXPECT_EQ(refused.reason, NoteCode::EngageRefusedForce);
  EXPECT_EQ(refused.epoch, 4U);
  EXPECT_EQ(refused.refused, NoteCode::EngageRefusedForce);
  EXPECT_EQ(refused.detail, 0.4);
  in.free_to_follow = true;
  in.retracted = true;
  EXPECT_EQ(site.step(in).state, SiteState::Parked);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(site.step(in).state, SiteState::Clutched) << "the same press does not count later";
  }
  in.peer.epoch = 5;
  EXPECT_EQ(site.step(in).state, SiteState::Engaged);
}

TEST(PatientSupervisorTest, ASiteThatBecomesReadyWaitsForANewPress) {
  PatientSupervisor site;
  EXPECT_EQ(site.step(pressed(7)).state, SiteState::Clutched);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(site.step(pressed(7)).state, SiteState::Clutched);
  EXPECT_EQ(site.step(pressed(8)).state, SiteState::Engaged);
}

TEST(PatientSupervisorTest, ANewSessionCountsEpochsFromZero) {
  PatientSupervisor site = in_state(SiteState::Clutched);
  (void)site.step(pressed(40));
  SupervisorInput in = quiet();
  in.peer.epoch = 40;
  (void)site.step(in);
  in = quiet();
  in.session_id = 2;
  const SupervisorOutput began = site.step(in);
  EXPECT_TRUE(began.session_began);
  EXPECT_EQ(began.epoch, 0U);
  in = pressed(1);
  in.session_id = 2;
  EXPECT_EQ(site.step(in).state, SiteState::Engaged);
}

TEST(PatientSupervisorTest, AResetLetsTheStageOutOfTissueThatStillPresses) {
  PatientSupervisor site = in_state(SiteState::Engaged);
  SupervisorInput in = pressed();
  in.force_exceeded = true;
  in.retracted = false;
  EXPECT_EQ(site.step(in).state, SiteState::Stopped);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(site.step(in).state, SiteState::Stopped) << "it is latched";
  in.local_reset = true;
  EXPECT_EQ(site.step(in).state, SiteState::Parked) << "where the gate moves the stage out";
  in.local_reset = false;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(site.step(in).state, SiteState::Parked);
}

TEST(PatientSupervisorTest, APeerThatStaysStoppedDoesNotStopASiteAgain) {
  PatientSupervisor site = in_state(SiteState::Engaged);
  SupervisorInput in = pressed();
  in.peer.state = SiteState::Stopped;
  EXPECT_EQ(site.step(in).state, SiteState::Stopped);
  in.local_reset = true;
  EXPECT_EQ(site.step(in).state, SiteState::Parked);
  in.local_reset = false;
  EXPECT_EQ(site.step(in).state, SiteState::Parked) << "waits until the peer was reset too";
  EXPECT_EQ(site.step(quiet()).state, SiteState::Clutched);
}

TEST(PatientSupervisorTest, OutOfHoldItIsTheSameEpoch) {
  PatientSupervisor site = in_state(SiteState::Hold);
  const SupervisorOutput out = site.step(pressed());
  EXPECT_TRUE(out.resumed_now);
  EXPECT_FALSE(out.engaged_now);
  EXPECT_EQ(out.epoch, 1U);
}

}  // namespace
}  // namespace palp::patient
