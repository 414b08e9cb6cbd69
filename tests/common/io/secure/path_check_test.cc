#include "common/io/secure/path_check.h"

#include <deque>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/io/realtime/steady_clock.h"
#include "common/io/secure/session_server.h"
#include "tests/common/io/net/loopback.h"
#include "tests/common/io/secure/keys_folder.h"

namespace palp::io {
namespace {

using link::Role;
using std::chrono::milliseconds;

TEST(PathCheckTest, APatientSiteThatRunsAnswersEachQuestionAndKeepsNothing) {
  const test::KeysFolder keys{"path"};
  const auto surgeon = keys.credentials(Role::Surgeon);
  const auto patient = keys.credentials(Role::Patient);
  LinkUpdateDesk desk;
  SessionServerConfig config;
  config.session = {.role = Role::Patient, .settings_hash = 1, .coupling = "direct", .git = ""};
  config.address = {.host = "127.0.0.1", .port = 0};
  config.credentials = patient.get();
  SessionServer server{config, desk};
  const auto facts = read_path({.host = "127.0.0.1", .port = server.local().port()},
                               *surgeon,
                               {.questions = 3, .pause = {}, .patience = std::chrono::seconds{10}});
  ASSERT_TRUE(facts) << facts.error().text;
  EXPECT_EQ(facts->asked, 3U);
  EXPECT_EQ(facts->round_trips.size(), 3U);
  EXPECT_TRUE(judge_path(*facts).good);
  EXPECT_FALSE(server.news()) << "nobody is told of it";
}

TEST(PathCheckTest, SomethingElseThanACookieIsNoAnswer) {
  const test::KeysFolder keys{"path-else"};
  const auto surgeon = keys.credentials(Role::Surgeon);
  test::PlainSocket stranger;
  std::jthread answers{[&stranger](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      if (const auto taken = stranger.take()) stranger.send_to(taken->from, taken->bytes);
      std::this_thread::sleep_for(milliseconds{1});
    }
  }};
  const auto facts = read_path({.host = "127.0.0.1", .port = stranger.local().port()},
                               *surgeon,
                               {.questions = 2, .pause = {}, .patience = milliseconds{20}});
  ASSERT_TRUE(facts);
  EXPECT_TRUE(facts->round_trips.empty());
  EXPECT_FALSE(judge_path(*facts).good);
}

TEST(PathCheckTest, AWayLongerThanThePauseIsMeasuredInFull) {
  const test::KeysFolder keys{"path-far"};
  const auto surgeon = keys.credentials(Role::Surgeon);
  static constexpr Duration kRoundTrip = milliseconds{40};
  test::PlainSocket far;
  std::jthread answers{[&far](const std::stop_token& stop) {
    const SteadyClock clock;
    std::deque<std::pair<TimePoint, test::PlainSocket::Taken>> under_way;
    while (!stop.stop_requested()) {
      if (auto taken = far.take()) under_way.emplace_back(clock.now() + kRoundTrip, *taken);
      for (; !under_way.empty() && under_way.front().first <= clock.now(); under_way.pop_front()) {
        auto& [due, question] = under_way.front();
        question.bytes[13] = std::byte{3};  // else as it came: a ClientHello becomes a cookie
        far.send_to(question.from, question.bytes);
      }
      std::this_thread::sleep_for(milliseconds{1});
    }
  }};
  const auto facts = read_path({.host = "127.0.0.1", .port = far.local().port()},
                               *surgeon,
                               {.questions = 5, .pause = milliseconds{7}});
  ASSERT_TRUE(facts);
  EXPECT_EQ(facts->round_trips.size(), 5U);
  for (const Duration one : facts->round_trips) EXPECT_GE(one, kRoundTrip);
}

TEST(PathCheckTest, TellsTheBestAndTheMiddleAndWhatWasLost) {
  const MachineFinding finding = judge_path(
      {.asked = 4, .round_trips = {milliseconds{30}, milliseconds{20}, milliseconds{25}}});
  EXPECT_EQ(finding.found, "round trip 20.0 ms at best, 25.0 in the middle, 1 of 4 lost");
  EXPECT_FALSE(finding.good);
  EXPECT_TRUE(judge_path({.asked = 1, .round_trips = {milliseconds{2500}}}).good);
  EXPECT_FALSE(judge_path({.asked = 1, .round_trips = {milliseconds{2501}}}).good);
}

}  // namespace
}  // namespace palp::io
