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

/// A patient site that waits to be called.
class Waiting {
 public:
  explicit Waiting(const Credentials& patient) : server_{config_of(patient), desk_} {}
  [[nodiscard]] HostAndPort place() const {
    return {.host = "127.0.0.1", .port = server_.local().port()};
  }
  [[nodiscard]] bool news() { return server_.news().has_value(); }

 private:
  static SessionServerConfig config_of(const Credentials& patient) {
    SessionServerConfig config;
    config.session = {.role = Role::Patient, .settings_hash = 1, .coupling = "direct", .git = ""};
    config.address = {.host = "127.0.0.1", .port = 0};
    config.credentials = &patient;
    return config;
  }
  LinkUpdateDesk desk_;
  SessionServer server_;
};

TEST(PathCheckTest, APatientSiteThatRunsAnswersEachQuestionAndKeepsNothing) {
  const test::KeysFolder keys{"path"};
  const auto surgeon = keys.credentials(Role::Surgeon);
  const auto patient = keys.credentials(Role::Patient);
  Waiting waiting{*patient};
  const auto facts = read_path(waiting.place(),
                               *surgeon,
                               {.questions = 3, .pause = {}, .patience = std::chrono::seconds{10}});
  ASSERT_TRUE(facts) << facts.error().text;
  EXPECT_EQ(facts->asked, 3U);
  EXPECT_EQ(facts->round_trips.size(), 3U);
  EXPECT_TRUE(judge_path(*facts).good);
  EXPECT_FALSE(waiting.news()) << "nobody is told of it";
}

TEST(PathCheckTest, TriesWhetherTheSitesTakeEachOthersCertificates) {
  const test::KeysFolder ours{"try-ours"};
  const test::KeysFolder others{"try-others"};
  const auto surgeon = ours.credentials(Role::Surgeon);
  const auto patient = ours.credentials(Role::Patient);
  const Waiting waiting{*patient};
  const auto tried = try_handshake(waiting.place(), *surgeon);
  ASSERT_TRUE(tried) << tried.error().text;
  EXPECT_TRUE(tried->good) << tried->advice;
  EXPECT_THAT(tried->found, testing::HasSubstr("test patient site"));

  const auto stranger = others.credentials(Role::Surgeon);
  const auto refused = try_handshake(waiting.place(), *stranger);
  ASSERT_TRUE(refused);
  EXPECT_FALSE(refused->good);
  EXPECT_THAT(refused->advice, testing::HasSubstr("two different authorities"));
}

TEST(PathCheckTest, TellsWhenThePatientSiteRefusesThisOne) {
  const test::KeysFolder keys{"try-revoked"};
  const auto surgeon = keys.credentials(Role::Surgeon);
  ASSERT_TRUE(revoke_certificate(keys.config(), keys.site(Role::Surgeon) / "certificate.pem"));
  const auto patient = keys.credentials(Role::Patient);
  const Waiting waiting{*patient};
  const auto refused = try_handshake(waiting.place(), *surgeon);
  ASSERT_TRUE(refused);
  EXPECT_FALSE(refused->good);
  EXPECT_THAT(refused->advice, testing::HasSubstr("revoked"));
}

TEST(PathCheckTest, WhoDoesNotAnswerIsWaitedForAndNoLonger) {
  const test::KeysFolder keys{"try-silent"};
  const auto surgeon = keys.credentials(Role::Surgeon);
  const test::PlainSocket silent;
  const auto tried = try_handshake(
      {.host = "127.0.0.1", .port = silent.local().port()}, *surgeon, milliseconds{50});
  ASSERT_TRUE(tried);
  EXPECT_FALSE(tried->good);
  EXPECT_THAT(tried->advice, testing::HasSubstr("start the patient site"));
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
