#include "surgeon_site/session_end.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::surgeon {
namespace {

using config::ExitCode;
using std::chrono::seconds;
using testing::HasSubstr;

SurgeonStatus ended(ScriptOutcome outcome) {
  SurgeonStatus status;
  status.script.finished = true;
  status.script.outcome = outcome;
  return status;
}

SurgeonStatus beside_a_stopped_peer() {
  SurgeonStatus status;
  status.state = SiteState::Parked;
  status.peer_heard = true;
  status.peer_state = SiteState::Stopped;
  return status;
}

TEST(SessionEndTest, OnlyACompletedScriptHasDoneItsWork) {
  EXPECT_FALSE(end_of_script({}));
  EXPECT_EQ(end_of_script(ended(ScriptOutcome::Completed))->code, ExitCode::Done);
  for (const auto outcome :
       {ScriptOutcome::Interrupted, ScriptOutcome::Refused, ScriptOutcome::Stopped}) {
    const auto end = end_of_script(ended(outcome)).value();
    EXPECT_EQ(end.code, ExitCode::CutShort);
    EXPECT_FALSE(end.reason.empty());
  }
}

TEST(SessionEndTest, TimeThatEndsOnASiteThatIsStoppedWasCutShort) {
  SurgeonStatus status;
  status.state = SiteState::Engaged;
  EXPECT_EQ(end_of_time(status).code, ExitCode::Done);
  status.state = SiteState::Stopped;
  status.reason = record::NoteCode::PeerStopped;
  EXPECT_EQ(end_of_time(status).code, ExitCode::CutShort);
  EXPECT_THAT(end_of_time(status).reason, HasSubstr(record::to_string(status.reason)));
  EXPECT_EQ(end_of_time(beside_a_stopped_peer()).code, ExitCode::CutShort);
}

TEST(SessionEndTest, AScriptWaitsTenSecondsForAStoppedPeer) {
  StoppedPeerWatch watch;
  const TimePoint began{seconds{5}};
  EXPECT_FALSE(watch.judge(beside_a_stopped_peer(), true, began));
  EXPECT_FALSE(watch.judge(beside_a_stopped_peer(), true, began + seconds{9}));
  const auto end = watch.judge(beside_a_stopped_peer(), true, began + seconds{10}).value();
  EXPECT_EQ(end.code, ExitCode::CutShort);
  EXPECT_THAT(end.reason, HasSubstr("stopped"));
}

TEST(SessionEndTest, APeerThatIsFreedBeginsTheWaitAnew) {
  StoppedPeerWatch watch;
  const TimePoint began{seconds{5}};
  EXPECT_FALSE(watch.judge(beside_a_stopped_peer(), true, began));
  SurgeonStatus free = beside_a_stopped_peer();
  free.peer_state = SiteState::Parked;
  EXPECT_FALSE(watch.judge(free, true, began + seconds{8}));
  EXPECT_FALSE(watch.judge(beside_a_stopped_peer(), true, began + seconds{12}));
}

TEST(SessionEndTest, APersonIsWaitedFor) {
  StoppedPeerWatch watch;
  const TimePoint began{seconds{5}};
  EXPECT_FALSE(watch.judge(beside_a_stopped_peer(), false, began));
  EXPECT_FALSE(watch.judge(beside_a_stopped_peer(), false, began + seconds{600}));
}

}  // namespace
}  // namespace palp::surgeon
