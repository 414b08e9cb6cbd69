#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <thread>

#include <gtest/gtest.h>

#include "common/io/realtime/steady_clock.h"
#include "common/io/secure/session_server.h"
#include "common/link/codec_wire.h"
#include "site_program/camera_sending.h"
#include "site_program/camera_watching.h"

/// Two sites on loopback, unprotected, that have met; their video is the caller's. This thread is
/// rt and record of both.
namespace palp::site_program::test {

struct CameraSite {
  explicit CameraSite(link::Role role, std::uint16_t port = 0)
      : server{config_of(role, port, door), desk} {}

  static io::SessionServerConfig config_of(link::Role role,
                                           std::uint16_t port,
                                           io::MediaDoor& door) {
    io::SessionServerConfig config;
    config.session.role = role;
    config.session.coupling = "direct";
    config.address = {.host = "127.0.0.1", .port = port};
    config.media = &door;
    return config;
  }
  void tick(TimePoint now) {
    desk.serve(link, now);
    (void)link.receive(now);
    link.send({}, now);
    const LinkHealth health = link.health(now);
    state = health.state;
    LinkHeard heard;
    heard.at = now;
    heard.state = health.state;
    heard.session_id = health.session_id;
    recording.force().take(heard);
    recording.force().tell();
    recording.write_to(nullptr, link::Role::Patient, {});
  }

  link::Link link{{}, std::make_unique<link::WireCodec>()};
  io::LinkUpdateDesk desk;
  io::MediaDoor door;
  CameraRecording recording;
  io::SessionServer server;
  LinkState state{};
};

/// A camera that can be unplugged.
class Plug final : public video::Camera {
 public:
  [[nodiscard]] int width() const noexcept override { return camera_.width(); }
  [[nodiscard]] int height() const noexcept override { return camera_.height(); }
  [[nodiscard]] video::Shot shoot(TimePoint now) override {
    ++asked;
    return plugged ? camera_.shoot(now) : video::Shot{};
  }
  std::atomic<bool> plugged{true};
  std::atomic<int> asked{};

 private:
  video::TestCamera camera_;
};

struct CameraRig {
  bool run_until(const std::function<bool()>& done) {
    const io::SteadyClock clock;
    const TimePoint deadline = clock.now() + std::chrono::seconds{20};
    for (TimePoint next = clock.now(); !done();) {
      const TimePoint now = clock.now();
      if (now > deadline) return false;
      if (now < next) {
        std::this_thread::yield();
        continue;
      }
      next = now + std::chrono::milliseconds{1};
      patient.tick(now);
      if (surgeon) surgeon->tick(now);
    }
    return true;
  }
  /// The surgeon's site calls, and there is a session.
  void meet() {
    surgeon.emplace(link::Role::Surgeon, patient.server.local().port());
    ASSERT_TRUE(run_until([this] { return patient.state == LinkState::Live; }));
  }
  [[nodiscard]] bool take(video::CameraFrame& frame) { return feed.frames.take(frame); }

  CameraSite patient{link::Role::Patient};
  std::optional<CameraSite> surgeon;
  Plug camera;
  monitor::CameraFeed feed;
};

}  // namespace palp::site_program::test
