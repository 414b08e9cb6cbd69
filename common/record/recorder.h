#pragma once

#include <array>
#include <cstdint>
#include <type_traits>
#include <variant>

#include "common/core/device_facts.h"
#include "common/core/site_state.h"
#include "common/core/time.h"
#include "common/core/user_command.h"
#include "common/link/telegram.h"
#include "common/message/depth.h"
#include "common/message/port_sample.h"

/// What a site writes down. Typed, complete, safe to write from rt: a Recorder only copies.
namespace palp::record {

/// One tick of a node: what the law was given, what it said, what the gate let through.
struct SiteTick {
  TimePoint at{};
  SiteState state{};
  std::uint32_t epoch{};
  double position{};      ///< [m], as given to the law
  double velocity{};      ///< [m/s]
  double force{};         ///< [N]; surgeon: as applied last tick, patient: contact force measured
  double lateral{};       ///< [m]
  double command{};       ///< [N] to the hand or [m] to the stage, behind the gate
  bool gate_acted{};      ///< the gate changed what the law asked for
  Duration round_trip{};  ///< as given to the law
  PortSample sent;        ///< to the peer
};

/// Each sample that arrived: a replay needs them all.
struct Arrived {
  TimePoint at{};
  Incoming incoming;
};

/// State of the link, 10 times a second.
struct LinkStatus {
  TimePoint at{};
  LinkHealth health;
};

/// A numbered event; its text stands in notes.h.
struct Note {
  TimePoint at{};
  std::uint16_t code{};
  double detail{};  ///< [by code], as notes.h says
};

/// A change of the site's state.
struct Transition {
  TimePoint at{};
  SiteState from{};
  SiteState to{};
  std::uint16_t reason{};  ///< notes.h
};

/// The depth as it arrived at the surgeon's.
struct DepthArrived {
  TimePoint at{};
  DepthReport report;
};

/// The rest is what a tick was given, raw, so that it can be done again: what the devices said,
/// what the link said besides the samples, what the user asked. A tick's records end with its
/// LinkHeard.

/// The hand, once a tick.
struct HandReading {
  TimePoint at{};
  TimePoint sampled_at{};
  double position{};  ///< [m], device axis; not a number where the device gave none
  double velocity{};  ///< [m/s]
  double lateral{};   ///< [m]
  bool pedal_held{};
  bool emergency_stop{};
  bool faulted{};
  std::uint32_t script_phase{};  ///< of a scripted operator, 1, 2, ...; 0: none has begun
};

/// The stage, once a tick.
struct StageReading {
  TimePoint at{};
  TimePoint sampled_at{};
  double position{};  ///< [m], tip
  double velocity{};  ///< [m/s]
  double lateral{};   ///< [m]
  bool at_limit{};
  bool faulted{};
};

/// The force sensor, once a tick.
struct ForceReading {
  TimePoint at{};
  bool fresh{};  ///< false: it had none, and the rest says nothing
  TimePoint sampled_at{};
  double force{};  ///< [N], contact
  bool saturated{};
};

/// What the link said of itself and of the peer in a tick.
struct LinkHeard {
  TimePoint at{};
  LinkState state{};
  std::uint64_t session_id{};
  Duration gap{};
  Duration round_trip{};
  std::uint8_t key{};
  bool peer_heard{};
  SiteState peer_state{};
  std::uint32_t peer_epoch{};
  double peer_lateral{};         ///< [m]
  std::uint32_t depth_number{};  ///< of the peer's report; at the patient's: of its own estimate
};

/// The user's commands, when they change and at the first tick.
struct UserAsked {
  TimePoint at{};
  UserCommand command;
};

/// Devices as they describe themselves: one's own at the first tick, the peer's when a session
/// begins.
struct DevicesTold {
  TimePoint at{};
  bool of_peer{};
  DeviceFacts facts;
};

using Record = std::variant<SiteTick,
                            Arrived,
                            LinkStatus,
                            Note,
                            Transition,
                            ContactSample,
                            DepthEstimate,
                            DepthArrived,
                            HandReading,
                            StageReading,
                            ForceReading,
                            LinkHeard,
                            UserAsked,
                            DevicesTold>;
static_assert(std::is_trivially_copyable_v<Record>, "crosses threads by copy");

/// Their names in summaries and reports, in the same order.
inline constexpr std::array<const char*, std::variant_size_v<Record>> kRecordNames{"tick",
                                                                                   "arrived",
                                                                                   "link",
                                                                                   "note",
                                                                                   "transition",
                                                                                   "contact",
                                                                                   "depth_estimate",
                                                                                   "depth_arrived",
                                                                                   "hand",
                                                                                   "stage",
                                                                                   "force",
                                                                                   "heard",
                                                                                   "user",
                                                                                   "devices"};

/// Thread: rt. Never blocks, never allocates.
class Recorder {
 public:
  virtual ~Recorder() = default;
  /// @returns false: queue full, the record is lost and counted.
  virtual bool record(const Record& record) noexcept = 0;
};

}  // namespace palp::record
