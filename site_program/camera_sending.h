#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "common/io/net/media_door.h"
#include "common/io/realtime/background_loop.h"
#include "site_program/address_proof.h"
#include "site_program/camera_recording.h"
#include "site_program/status_line.h"
#include "video/camera.h"
#include "video/media_seal.h"
#include "video/sender.h"

namespace palp::site_program {

struct CameraSendingConfig {
  bool jpeg{};            ///< for browsers that do not know H.264
  double max_kbps{1000};  ///< [kbit/s]
};

/// The patient's site sends what its camera sees, on a thread and a socket of its own. It knows
/// nothing of force but what the records say, and yields to it. Thread: its maker's.
class CameraSending {
 public:
  /// All outlive it.
  CameraSending(const CameraSendingConfig& config,
                video::Camera& camera,
                io::MediaDoor& door,
                CameraRecording& recording);
  ~CameraSending();
  CameraSending(const CameraSending&) = delete;
  CameraSending& operator=(const CameraSending&) = delete;

  /// No picture leaves any more. Idempotent.
  void stop();

  /// Says once what keeps pictures away for good.
  void tell_news(StatusLine& line);

 private:
  class Io;
  std::unique_ptr<Io> io_;
  bool encodes_;
  std::unique_ptr<io::BackgroundLoop> loop_;
  bool told_{};
};

}  // namespace palp::site_program
