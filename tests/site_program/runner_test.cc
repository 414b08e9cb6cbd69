// Goal: two sites meet, tick and part in real time, and the accounts say so.
// Method: two runners on loopback with real links; waiting, never sleeping for a fixed time.
#include "site_program/runner.h"

#include <atomic>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/io/realtime/steady_clock.h"
#include "common/link/codec_wire.h"

namespace palp::site_program {
namespace {

RunnerConfig config_of(link::Role role, const std::string& address) {
  RunnerConfig config;
  config.session.role = role;
  config.session.coupling = "direct";
  config.address = parse_host_and_port(address).value();
  config.loop = {.priority = 0, .lock_memory = false};
  return config;
}

struct Site {
  Site(link::Role role, const std::string& address) : runner{config_of(role, address)} {
    runner.start(link, [this](TimePoint now) {
      (void)link.receive(now);
      link.send({}, now);
      live = link.health(now).state == LinkState::Live;
    });
  }
  ~Site() { runner.halt(); }
  Site(const Site&) = delete;
  Site& operator=(const Site&) = delete;

  link::Link link{{}, std::make_unique<link::WireCodec>()};
  std::atomic<bool> live{};
  Runner runner;
};

bool wait_until(const std::function<bool()>& done) {
  const io::SteadyClock clock;
  const TimePoint give_up = clock.now() + std::chrono::seconds{20};
  while (!done()) {
    if (clock.now() > give_up) return false;
    std::this_thread::yield();
  }
  return true;
}

TEST(RunnerTest, SitesMeetAndPartAndTheAccountsSaySo) {
  Site patient{link::Role::Patient, "127.0.0.1:0"};
  Site surgeon{link::Role::Surgeon, patient.runner.local()};
  ASSERT_TRUE(wait_until([&] { return patient.live && surgeon.live; }));
  surgeon.runner.stop("done");
  EXPECT_TRUE(wait_until([&] { return !patient.live; })) << "it was told";
  patient.runner.stop("done");
  StatusLine line;
  EXPECT_FALSE(surgeon.runner.tell_news(line)) << "nothing hopeless";
  SiteReport report;
  surgeon.runner.account(report);
  EXPECT_EQ(report.sessions, 1U);
  EXPECT_GT(report.loop.ticks, 0U);
}

TEST(RunnerTest, AnAddressInUseIsOneSentence) {
  const Runner first{config_of(link::Role::Patient, "127.0.0.1:0")};
  try {
    const Runner second{config_of(link::Role::Patient, first.local())};
    FAIL() << "two owners of one port";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("address already in use"));
  }
}

}  // namespace
}  // namespace palp::site_program
