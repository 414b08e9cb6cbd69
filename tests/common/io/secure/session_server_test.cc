// Goal: two sites find each other over real sockets, find each other again after a restart of
// either, and strangers cannot keep them from it.
// Method: two servers on loopback with real links; the test's thread is the rt of both.
#include "common/io/secure/session_server.h"

#include <atomic>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/io/secure/path_check.h"
#include "common/link/codec_wire.h"
#include "tests/common/io/net/loopback.h"
#include "tests/common/io/secure/keys_folder.h"

namespace palp::io {
namespace {

using link::Role;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

SessionServerConfig config_of(Role role, std::uint16_t port, const std::string& coupling) {
  SessionServerConfig config;
  config.session.role = role;
  config.session.coupling = coupling;
  config.session.settings_hash = 42;
  config.address = {.host = "127.0.0.1", .port = port};
  return config;
}

/// One site: what main makes of it, without a node.
class Site {
 public:
  Site(Role role, std::uint16_t port, const std::string& coupling = "direct")
      : Site{config_of(role, port, coupling)} {}
  explicit Site(const SessionServerConfig& config) : server{config, desk} {}

  void tick(TimePoint now) {
    desk.serve(link, now);
    accepted += link.receive(now).accepted;
    link.send({}, now);
    while (auto one = server.news()) {
      news.push_back(*one);
    }
    state = link.health(now).state;
  }
  [[nodiscard]] int count(SessionNews::Kind kind) const {
    return static_cast<int>(std::count_if(
        news.begin(), news.end(), [&](const SessionNews& one) { return one.kind == kind; }));
  }
  [[nodiscard]] bool live() const { return state == LinkState::Live; }

  link::Link link{{}, std::make_unique<link::WireCodec>()};
  LinkUpdateDesk desk;
  SessionServer server;
  std::vector<SessionNews> news;
  std::uint64_t accepted{};
  LinkState state{};
};

/// Between two sites, so that one can fall silent without a word and come back elsewhere.
class Relay {
 public:
  explicit Relay(const Endpoint& patient) : patient_{patient} {}
  [[nodiscard]] std::uint16_t port() const { return front_.local().port(); }
  void lead_to(const Endpoint& patient) { patient_ = patient; }
  void cut() { patient_ = {}; }
  /// As a NAT that forgets: the patient sees another port from now on.
  void rebind() { back_ = test::PlainSocket{}; }
  void pump() {
    while (auto taken = front_.take()) {
      surgeon_ = taken->from;
      pass(back_, patient_, taken->bytes);
    }
    while (auto taken = back_.take()) {
      if (taken->from == patient_) {
        pass(front_, surgeon_, taken->bytes);
      }
    }
  }

 private:
  static void pass(test::PlainSocket& way, const Endpoint& to, const test::Bytes& bytes) {
    if (to.valid()) {
      way.send_to(to, bytes);
    }
  }
  test::PlainSocket front_;
  test::PlainSocket back_;
  Endpoint surgeon_;
  Endpoint patient_;
};

/// Ticks all sites once a millisecond until `done`. @returns false: not within ten seconds.
bool run_until(const std::vector<Site*>& sites, Relay* relay, const std::function<bool()>& done) {
  const SteadyClock clock;
  TimePoint next = clock.now();
  return test::wait_until([&] {
    if (relay != nullptr) {
      relay->pump();
    }
    if (const TimePoint now = clock.now(); now >= next) {
      next = now + milliseconds{1};
      for (Site* site : sites) {
        site->tick(now);
      }
    }
    return done();
  });
}

bool meet(Site& surgeon, Site& patient, Relay* relay = nullptr) {
  return run_until({&surgeon, &patient}, relay, [&] { return surgeon.live() && patient.live(); });
}

TEST(SessionServerTest, SitesMeetAndTelegramsFlow) {
  Site patient{Role::Patient, 0};
  Site surgeon{Role::Surgeon, patient.server.local().port()};
  ASSERT_TRUE(meet(surgeon, patient));
  ASSERT_EQ(patient.news.size(), 1U);
  EXPECT_EQ(patient.news[0].kind, SessionNews::Kind::Established);
  EXPECT_THAT(patient.news[0].sentence,
              HasSubstr("session with the surgeon site at 127.0.0.1:" +
                        std::to_string(surgeon.server.local().port())));
  EXPECT_THAT(surgeon.news.at(0).sentence,
              HasSubstr("session with the patient site at " + patient.server.local().to_string()));
  EXPECT_GT(patient.accepted, 0U);
  EXPECT_GT(surgeon.accepted, 0U);
  EXPECT_GT(patient.server.socket_counts().received, 0U);
  EXPECT_GT(patient.server.socket_counts().sent, 0U);
}

/// Counts what passes and lets it pass.
class Counting final : public link::Transport {
 public:
  Counting(std::unique_ptr<link::Transport> inner, std::atomic<int>& received)
      : inner_{std::move(inner)}, received_{received} {}
  bool send(std::span<const std::byte> datagram, TimePoint now) noexcept override {
    return inner_->send(datagram, now);
  }
  std::optional<link::Datagram> receive(std::span<std::byte, link::kDatagramSizeMax> buffer,
                                        TimePoint now) noexcept override {
    const auto datagram = inner_->receive(buffer, now);
    if (datagram) {
      ++received_;
    }
    return datagram;
  }

 private:
  std::unique_ptr<link::Transport> inner_;
  std::atomic<int>& received_;
};

TEST(SessionServerTest, WhatIsPutBetweenSocketAndLinkCarriesTheTelegrams) {
  std::atomic<int> received{0};
  SessionServerConfig config = config_of(Role::Patient, 0, "direct");
  config.wrap_transport = [&received](std::unique_ptr<link::Transport> socket) {
    return std::make_unique<Counting>(std::move(socket), received);
  };
  Site patient{config};
  Site surgeon{Role::Surgeon, patient.server.local().port()};
  ASSERT_TRUE(meet(surgeon, patient));
  EXPECT_GE(received, static_cast<int>(patient.accepted));
  EXPECT_GT(received, 0);
}

TEST(SessionServerTest, SurgeonMayComeFirst) {
  std::uint16_t port = 0;
  { port = test::PlainSocket{}.local().port(); }
  Site surgeon{Role::Surgeon, port};
  const SteadyClock clock;
  const TimePoint later = clock.now() + milliseconds{30};
  ASSERT_TRUE(run_until({&surgeon}, nullptr, [&] { return clock.now() > later; }));
  Site patient{Role::Patient, port};
  EXPECT_TRUE(meet(surgeon, patient));
}

TEST(SessionServerTest, OrderlyCloseIsToldAndEndsTheLink) {
  Site patient{Role::Patient, 0};
  auto surgeon = std::make_unique<Site>(Role::Surgeon, patient.server.local().port());
  ASSERT_TRUE(meet(*surgeon, patient));
  surgeon->server.close("the operator went home");
  ASSERT_TRUE(run_until({&patient}, nullptr, [&] { return patient.state == LinkState::Down; }));
  ASSERT_EQ(patient.count(SessionNews::Kind::Closed), 1);
  EXPECT_THAT(patient.news.back().sentence, HasSubstr("the operator went home"));

  surgeon = std::make_unique<Site>(Role::Surgeon, patient.server.local().port());
  EXPECT_TRUE(meet(*surgeon, patient));
  EXPECT_EQ(patient.count(SessionNews::Kind::Established), 2);
}

TEST(SessionServerTest, WhoOnlyTriesTheCertificatesDisturbsNoSession) {
  const test::KeysFolder keys{"try"};
  const auto surgeons = keys.credentials(Role::Surgeon);
  const auto patients = keys.credentials(Role::Patient);
  SessionServerConfig config = config_of(Role::Patient, 0, "direct");
  config.credentials = patients.get();
  Site patient{config};
  const std::uint16_t port = patient.server.local().port();
  config = config_of(Role::Surgeon, port, "direct");
  config.credentials = surgeons.get();
  Site surgeon{config};
  ASSERT_TRUE(meet(surgeon, patient));
  const std::uint64_t session = patient.link.health(SteadyClock{}.now()).session_id;
  const auto tried = try_handshake({.host = "127.0.0.1", .port = port}, *surgeons);
  ASSERT_TRUE(tried);
  EXPECT_TRUE(tried->good) << tried->advice;
  const SteadyClock clock;
  const TimePoint later = clock.now() + milliseconds{300};
  ASSERT_TRUE(run_until({&surgeon, &patient}, nullptr, [&] { return clock.now() > later; }));
  EXPECT_EQ(patient.link.health(clock.now()).session_id, session);
  EXPECT_EQ(patient.count(SessionNews::Kind::Established), 1);
}

TEST(SessionServerTest, ManySessionsInARowUseUpNothing) {
  Site patient{Role::Patient, 0};
  for (int session = 1; session <= 12; ++session) {
    Site surgeon{Role::Surgeon, patient.server.local().port()};
    ASSERT_TRUE(meet(surgeon, patient)) << "session " << session;
    surgeon.server.close("next one");
    ASSERT_TRUE(run_until({&patient}, nullptr, [&] { return patient.state == LinkState::Down; }));
  }
}

TEST(SessionServerTest, SilentlyRestartedPatientIsANewSession) {
  auto patient = std::make_unique<Site>(Role::Patient, std::uint16_t{0});
  Relay relay{patient->server.local()};
  Site surgeon{Role::Surgeon, relay.port()};
  ASSERT_TRUE(meet(surgeon, *patient, &relay));
  const std::uint64_t first = surgeon.link.health(SteadyClock{}.now()).session_id;

  relay.cut();
  patient = std::make_unique<Site>(Role::Patient, std::uint16_t{0});
  ASSERT_TRUE(run_until({&surgeon}, &relay, [&] { return surgeon.state == LinkState::Lost; }));
  relay.lead_to(patient->server.local());
  ASSERT_TRUE(meet(surgeon, *patient, &relay));
  EXPECT_NE(surgeon.link.health(SteadyClock{}.now()).session_id, first);
  EXPECT_EQ(surgeon.count(SessionNews::Kind::Established), 2);
}

TEST(SessionServerTest, SilentlyRestartedSurgeonIsANewSession) {
  Site patient{Role::Patient, 0};
  Relay relay{patient.server.local()};
  auto surgeon = std::make_unique<Site>(Role::Surgeon, relay.port());
  ASSERT_TRUE(meet(*surgeon, patient, &relay));
  const std::uint64_t first = patient.link.health(SteadyClock{}.now()).session_id;

  relay.cut();
  surgeon.reset();
  ASSERT_TRUE(run_until({&patient}, &relay, [&] { return patient.state == LinkState::Lost; }));
  relay.lead_to(patient.server.local());
  surgeon = std::make_unique<Site>(Role::Surgeon, relay.port());
  ASSERT_TRUE(meet(*surgeon, patient, &relay));
  EXPECT_NE(patient.link.health(SteadyClock{}.now()).session_id, first);
  EXPECT_EQ(patient.count(SessionNews::Kind::Established), 2);
}

TEST(SessionServerTest, FloodOfJunkBreaksNothing) {
  Site patient{Role::Patient, 0};
  test::PlainSocket stranger;
  std::uint8_t first = 0;
  const auto send_junk = [&](int count) {
    for (int i = 0; i < count; ++i) {
      stranger.send_to(patient.server.local(), test::bytes_of(first, 40U + first));
      ++first;
    }
  };
  const SteadyClock clock;
  TimePoint next = clock.now();
  const auto flood = [&] {  // 40,000 a second
    if (clock.now() >= next) {
      next = clock.now() + milliseconds{1};
      send_junk(40);
    }
  };
  send_junk(2000);
  Site surgeon{Role::Surgeon, patient.server.local().port()};
  ASSERT_TRUE(run_until({&surgeon, &patient}, nullptr, [&] {
    flood();
    return surgeon.live() && patient.live();
  }));
  const std::uint64_t accepted = patient.accepted;
  ASSERT_TRUE(run_until({&surgeon, &patient}, nullptr, [&] {
    flood();
    return patient.accepted > accepted + 100;
  }));
  EXPECT_GT(patient.server.noise().malformed, 0U);
  EXPECT_EQ(patient.count(SessionNews::Kind::Established), 1);
  EXPECT_EQ(surgeon.count(SessionNews::Kind::Established), 1);
}

/// A site that proves itself.
SessionServerConfig secure_config(Role role,
                                  std::uint16_t port,
                                  const Credentials& credentials,
                                  Duration rekey_after = std::chrono::hours{1}) {
  SessionServerConfig config = config_of(role, port, "direct");
  config.credentials = &credentials;
  config.rekey_after = rekey_after;
  return config;
}

TEST(SecureSessionTest, SitesMeetAndReplaceTheirKeys) {
  const test::KeysFolder keys{"server"};
  const auto surgeon_keys = keys.credentials(Role::Surgeon);
  const auto patient_keys = keys.credentials(Role::Patient);
  Site patient{secure_config(Role::Patient, 0, *patient_keys)};
  const std::uint16_t port = patient.server.local().port();
  Site surgeon{secure_config(Role::Surgeon, port, *surgeon_keys, milliseconds{100})};
  ASSERT_TRUE(meet(surgeon, patient));
  EXPECT_THAT(patient.news.at(0).sentence, HasSubstr("proven by test surgeon site"));
  std::set<std::uint8_t> ids;
  ASSERT_TRUE(run_until({&surgeon, &patient}, nullptr, [&] {
    ids.insert(patient.link.health(SteadyClock{}.now()).key);
    return ids.size() >= 3;
  }));
  EXPECT_EQ(patient.link.health(SteadyClock{}.now()).forged, 0U);
  EXPECT_EQ(patient.count(SessionNews::Kind::Established), 1);
  surgeon.server.close("done");
  EXPECT_TRUE(run_until({&patient}, nullptr, [&] { return patient.state == LinkState::Down; }));
}

TEST(SecureSessionTest, TheSessionSurvivesRebindingsOfTheOutsidePort) {
  const test::KeysFolder keys{"rebind"};
  const auto surgeon_keys = keys.credentials(Role::Surgeon);
  const auto patient_keys = keys.credentials(Role::Patient);
  Site patient{secure_config(Role::Patient, 0, *patient_keys)};
  Relay relay{patient.server.local()};
  Site surgeon{secure_config(Role::Surgeon, relay.port(), *surgeon_keys)};
  ASSERT_TRUE(meet(surgeon, patient, &relay));
  for (int i = 1; i <= 4; ++i) {
    relay.rebind();
    const std::uint64_t before = patient.accepted;
    ASSERT_TRUE(run_until({&surgeon, &patient},
                          &relay,
                          [&] {
                            return patient.accepted > before + 20 &&
                                   patient.count(SessionNews::Kind::Moved) == i;
                          }))
        << "rebinding " << i;
  }
  EXPECT_TRUE(patient.live() && surgeon.live());
  EXPECT_EQ(patient.count(SessionNews::Kind::Established), 1) << "no new session";
}

TEST(SecureSessionTest, APlainSurgeonIsNotHeard) {
  const test::KeysFolder keys{"plain"};
  const auto patient_keys = keys.credentials(Role::Patient);
  Site patient{secure_config(Role::Patient, 0, *patient_keys)};
  Site surgeon{Role::Surgeon, patient.server.local().port()};
  ASSERT_TRUE(
      run_until({&surgeon, &patient}, nullptr, [&] { return patient.server.noise().foreign > 3; }));
  EXPECT_TRUE(patient.news.empty());
  EXPECT_TRUE(surgeon.news.empty());
}

TEST(SecureSessionTest, ASecureSurgeonDoesNotStoopToAPlainPatient) {
  const test::KeysFolder keys{"mixed"};
  const auto surgeon_keys = keys.credentials(Role::Surgeon);
  Site patient{Role::Patient, 0};
  Site surgeon{secure_config(Role::Surgeon, patient.server.local().port(), *surgeon_keys)};
  ASSERT_TRUE(run_until(
      {&surgeon, &patient}, nullptr, [&] { return patient.server.noise().malformed > 3; }));
  EXPECT_TRUE(patient.news.empty());
  EXPECT_TRUE(surgeon.news.empty());
}

TEST(SessionServerTest, DifferentSettingsAreRefusedForGood) {
  Site patient{Role::Patient, 0, "direct"};
  Site surgeon{Role::Surgeon, patient.server.local().port(), "wave"};
  ASSERT_TRUE(run_until({&surgeon, &patient}, nullptr, [&] {
    return surgeon.count(SessionNews::Kind::Refused) > 0;
  }));
  EXPECT_TRUE(surgeon.news.back().final);
  EXPECT_THAT(surgeon.news.back().sentence, HasSubstr("surgeon wave, patient direct"));
}

/// What the constructor complains of.
std::string complaint(const SessionServerConfig& config) {
  LinkUpdateDesk desk;
  try {
    const SessionServer server{config, desk};
  } catch (const std::runtime_error& refusal) {
    return refusal.what();
  }
  return "none";
}

TEST(SessionServerTest, AddressInUseIsOneSentence) {
  test::PlainSocket owner;
  EXPECT_EQ(complaint(config_of(Role::Patient, owner.local().port(), "direct")),
            "cannot listen on " + owner.local().to_string() + ": address already in use");
}

TEST(SessionServerTest, PortIsNotSharedWithAnOwnerWhoWould) {
  test::PlainSocket owner{0, true};
  EXPECT_THAT(complaint(config_of(Role::Patient, owner.local().port(), "direct")),
              HasSubstr("address already in use"));
}

TEST(SessionServerTest, NobodyCanShareThePortOfOneInSession) {
  Site patient{Role::Patient, 0};
  Site surgeon{Role::Surgeon, patient.server.local().port()};
  ASSERT_TRUE(meet(surgeon, patient));
  EXPECT_THAT(complaint(config_of(Role::Patient, patient.server.local().port(), "direct")),
              HasSubstr("address already in use"));
  EXPECT_FALSE(test::can_share(patient.server.local()));
}

TEST(SessionServerTest, HostThatDoesNotExistAndPortZeroAreOneSentence) {
  SessionServerConfig config = config_of(Role::Surgeon, 9000, "direct");
  config.address.host = "no-such-host.invalid";
  EXPECT_THAT(complaint(config), HasSubstr("cannot find host \"no-such-host.invalid\": "));
  EXPECT_EQ(complaint(config_of(Role::Surgeon, 0, "direct")),
            "cannot call 127.0.0.1:0: the port must be 1 to 65535");
}

}  // namespace
}  // namespace palp::io
