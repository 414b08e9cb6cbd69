// Goal: pictures go to an address that has proven itself, and nowhere else.
// Method: the thread of the video with a real server; the surgeon's end is made by hand.
#include "site_program/camera_sending.h"

#include "tests/common/io/net/loopback.h"
#include "tests/site_program/camera_rig.h"
#include "video/media_seal.h"

namespace palp::site_program {
namespace {

using std::chrono::milliseconds;

/// A surgeon's end of the video, without a thread.
struct Hand {
  explicit Hand(const io::Endpoint& patient) : to{patient} {}
  std::vector<std::byte> report(std::uint64_t echo = 0) {
    video::Report one;
    one.echo = echo;
    return seal.seal(video::write(one));
  }
  /// Kinds that came since the last call, and the newest challenge.
  std::vector<std::size_t> heard(io::test::PlainSocket& socket) {
    std::vector<std::size_t> kinds;
    while (auto taken = socket.take()) {
      const auto opened = seal.open(taken->bytes);
      const auto message =
          opened ? video::read_media(opened->payload) : std::optional<video::MediaMessage>{};
      if (!message) continue;
      kinds.push_back(message->index());
      if (const auto* one = std::get_if<video::Question>(&*message)) challenge = one->challenge;
    }
    return kinds;
  }
  io::Endpoint to;
  video::MediaSeal seal{video::media_keys(std::nullopt, link::Role::Surgeon)};
  std::uint64_t challenge{};
};
constexpr std::size_t kFragment = 0;
constexpr std::size_t kQuestion = 2;

class CameraSendingTest : public testing::Test {
 protected:
  CameraSendingTest()
      : sending_{CameraSendingConfig{}, rig_.camera, rig_.patient.door, rig_.patient.recording},
        hand_{rig_.patient.server.local()} {
    rig_.meet();
  }
  bool within(Duration span, const std::function<bool()>& done) {
    const TimePoint until = io::SteadyClock{}.now() + span;
    bool came = false;
    (void)rig_.run_until([&] { return (came = done()) || io::SteadyClock{}.now() > until; });
    return came;
  }
  /// What comes to `socket` while it reports.
  bool comes(std::size_t kind, io::test::PlainSocket& socket, bool echoes, Duration span) {
    TimePoint next{};
    return within(span, [&] {
      if (const TimePoint now = io::SteadyClock{}.now(); now > next) {
        next = now + milliseconds{30};
        (void)socket.send_to(hand_.to, hand_.report(echoes ? hand_.challenge : 0));
      }
      const auto kinds = hand_.heard(socket);
      return std::ranges::find(kinds, kind) != kinds.end();
    });
  }
  test::CameraRig rig_;
  CameraSending sending_;
  Hand hand_;
};

TEST_F(CameraSendingTest, AnAddressThatAnswersNoQuestionGetsNoPicture) {
  io::test::PlainSocket socket;
  EXPECT_TRUE(comes(kQuestion, socket, false, std::chrono::seconds{5}));
  EXPECT_FALSE(comes(kFragment, socket, false, std::chrono::seconds{1}));
  EXPECT_TRUE(comes(kFragment, socket, true, std::chrono::seconds{5}));
}

TEST_F(CameraSendingTest, ACopyFromElsewhereDrawsNoPictures) {
  io::test::PlainSocket socket;
  io::test::PlainSocket thief;
  ASSERT_TRUE(comes(kFragment, socket, true, std::chrono::seconds{5}));
  // The thief is faster with every second report.
  std::size_t got = 0;
  TimePoint next{};
  (void)within(std::chrono::seconds{1}, [&] {
    if (const TimePoint now = io::SteadyClock{}.now(); now > next) {
      next = now + milliseconds{30};
      const auto report = hand_.report(hand_.challenge);
      (void)thief.send_to(hand_.to, report);
      (void)socket.send_to(hand_.to, hand_.report(hand_.challenge));
    }
    while (thief.take()) ++got;
    (void)hand_.heard(socket);
    return false;
  });
  EXPECT_EQ(got, 0U);
}

TEST_F(CameraSendingTest, WhatIsForgedMovesNothing) {
  io::test::PlainSocket socket;
  const auto report = hand_.report();
  const bool came = within(std::chrono::seconds{1}, [&] {
    (void)socket.send_to(hand_.to, std::span{report}.first(report.size() - 1));
    return !hand_.heard(socket).empty();
  });
  EXPECT_FALSE(came);
}

}  // namespace
}  // namespace palp::site_program
