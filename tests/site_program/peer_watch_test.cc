#include "site_program/peer_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palp::site_program {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;

constexpr TimePoint kStart{seconds{100}};

LinkHealth link_in(LinkState state) {
  LinkHealth link;
  link.state = state;
  return link;
}

PeerWatch watch() {
  return {{.peer = "127.0.0.1:9000", .patience_at_first = seconds{30}, .patience = seconds{50}},
          kStart};
}

TEST(PeerWatchTest, NobodyAnswersIsUnreachableAfterThePatience) {
  PeerWatch watch_it = watch();
  EXPECT_FALSE(watch_it.judge(link_in(LinkState::Down), kStart + seconds{30} - Duration{1}));
  const auto exit_status = watch_it.judge(link_in(LinkState::Down), kStart + seconds{30});
  ASSERT_TRUE(exit_status);
  EXPECT_EQ(exit_status->code, config::ExitCode::CannotOpen);
  EXPECT_EQ(exit_status->outcome, "unreachable");
  EXPECT_EQ(exit_status->reason,
            "no session with 127.0.0.1:9000 within 30 s: nobody answers there");
}

TEST(PeerWatchTest, ALinkThatWorkedAndBrokeIsAPeerLost) {
  PeerWatch watch_it = watch();
  EXPECT_FALSE(watch_it.judge(link_in(LinkState::Live), kStart + seconds{50}));
  EXPECT_FALSE(watch_it.judge(link_in(LinkState::Lost), kStart + seconds{99}));
  EXPECT_FALSE(watch_it.judge(link_in(LinkState::Live), kStart + seconds{99})) << "it came back";
  EXPECT_FALSE(watch_it.judge(link_in(LinkState::Lost), kStart + seconds{148}));
  const auto exit_status = watch_it.judge(link_in(LinkState::Down), kStart + seconds{149});
  ASSERT_TRUE(exit_status);
  EXPECT_EQ(exit_status->code, config::ExitCode::CutShort);
  EXPECT_EQ(exit_status->outcome, "peer lost");
}

TEST(PeerWatchTest, KnowsWhetherThereEverWasALinkAndHowLongItWasWaitedFor) {
  PeerWatch watch_it = watch();
  (void)watch_it.judge(link_in(LinkState::Down), kStart + seconds{2});
  EXPECT_FALSE(watch_it.ever_worked());
  const ExitStatus exit_status = watch_it.unreachable(link_in(LinkState::Down), seconds{2});
  EXPECT_EQ(exit_status.code, config::ExitCode::CannotOpen);
  EXPECT_THAT(exit_status.reason, HasSubstr("within 2 s"));
  (void)watch_it.judge(link_in(LinkState::Live), kStart + seconds{3});
  (void)watch_it.judge(link_in(LinkState::Down), kStart + seconds{4});
  EXPECT_TRUE(watch_it.ever_worked());
}

TEST(PeerWatchTest, WhoeverRefusedIsNotSaidToBeSilent) {
  PeerWatch watch_it = watch();
  watch_it.note_refusal("the peer's certificate is refused");
  watch_it.note_refusal("");
  const auto exit_status = watch_it.judge(link_in(LinkState::Down), kStart + seconds{30});
  ASSERT_TRUE(exit_status);
  EXPECT_EQ(exit_status->reason,
            "no session with 127.0.0.1:9000 within 30 s: the peer's certificate is refused");
}

TEST(PeerWatchTest, ARoundTripAboveTheLimitIsNamed) {
  PeerWatch watch_it = watch();
  LinkHealth link = link_in(LinkState::Down);
  link.round_trip_min = std::chrono::milliseconds{2600};
  const auto exit_status = watch_it.judge(link, kStart + seconds{30});
  ASSERT_TRUE(exit_status);
  EXPECT_EQ(exit_status->code, config::ExitCode::CannotOpen);
  EXPECT_THAT(exit_status->reason, HasSubstr("2600 ms is above the limit of 2500 ms"));
}

}  // namespace
}  // namespace palp::site_program
