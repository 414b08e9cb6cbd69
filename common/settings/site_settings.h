#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "common/core/result.h"
#include "common/core/time.h"
#include "common/coupling/any_coupling.h"
#include "common/link/link.h"

namespace palp::proto::config {
class Camera;
class Coupling;
class Impairment;
class Link;
class Loop;
class Monitor;
class Record;
}  // namespace palp::proto::config

/// What the settings of both sites have in common: messages of proto/config.proto become the frozen
/// structs of the parts. Units change here, once. Absent fields give the structs' own defaults.
namespace palp::settings {

/// Of the control loop in real time.
struct LoopSettings {
  Duration period{std::chrono::milliseconds{1}};
  Duration spin{std::chrono::microseconds{50}};  ///< busy wait before each deadline
  int priority{80};                              ///< SCHED_FIFO; 0: an ordinary thread
  bool lock_memory{true};
};

/// Of what arrives. `spec` in the words of netem; if given, the numbers are unused.
struct ImpairmentSettings {
  std::string spec{};
  Duration delay{};
  Duration jitter{};  ///< standard deviation of the delay
  double loss{};      ///< [1]

  [[nodiscard]] bool any() const noexcept {
    return !spec.empty() || delay > Duration{0} || jitter > Duration{0} || loss > 0;
  }
};

/// At most one of `file` and `files`; neither: no session file.
struct RecordSettings {
  std::string file{};   ///< of the whole run
  std::string files{};  ///< a file for each session: this and 001.mcap, 002.mcap, ...
  std::size_t queue_records{16384};
};

/// Of the page that shows the session live.
struct MonitorSettings {
  bool serve{};
  std::uint16_t port{8080};  ///< 0: any free one
  std::string origin{};      ///< of a page from elsewhere that may ask too; empty: none
};

/// Of the patient site's pictures.
struct CameraSettings {
  std::string source{"none"};
  bool jpeg{};
  double rate_max_kbps{1000};  ///< [kbit/s]

  [[nodiscard]] bool any() const noexcept { return source != "none"; }
};

/// Of the link: who may hear and say something on it.
struct ProtectionSettings {
  bool insecure{};         ///< plain datagrams are accepted
  std::string identity{};  ///< folder of certificate and key; empty: none
  Duration rekey_after{std::chrono::hours{1}};
  std::string through{};  ///< HOST:PORT of a relay; empty: the surgeon calls the patient
  std::string room{};     ///< its name there
};

/// The sentence lists the couplings there are.
[[nodiscard]] Result<coupling::CouplingConfig> make_coupling(
    const proto::config::Coupling& message);
/// `period`: of the control loop, which is that of sending.
[[nodiscard]] link::LinkConfig make_link(const proto::config::Link& message, Duration period);
[[nodiscard]] ProtectionSettings make_protection(const proto::config::Link& message);
[[nodiscard]] LoopSettings make_loop(const proto::config::Loop& message);
[[nodiscard]] ImpairmentSettings make_impairment(const proto::config::Impairment& message);
/// The sentence lists the sources there are.
[[nodiscard]] Result<CameraSettings> make_camera(const proto::config::Camera& message);
[[nodiscard]] MonitorSettings make_monitor(const proto::config::Monitor& message);
/// The sentence says that both were asked for.
[[nodiscard]] Result<RecordSettings> make_record(const proto::config::Record& message);

/// Of all that both sites must agree on: the law with its numbers, and the control period.
[[nodiscard]] std::uint64_t agreement_hash(const proto::config::Coupling& message, Duration period);

}  // namespace palp::settings
