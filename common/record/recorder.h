#pragma once

#include <array>
#include <cstdint>
#include <type_traits>
#include <variant>

#include "common/core/site_state.h"
#include "common/core/time.h"
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
  double position{};  ///< [m], as given to the law
  double velocity{};  ///< [m/s]
  double force{};     ///< [N]; surgeon: as applied last tick, patient: contact force measured
  Place place{};
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

using Record = std::variant<SiteTick,
                            Arrived,
                            LinkStatus,
                            Note,
                            Transition,
                            ContactSample,
                            DepthEstimate,
                            DepthArrived>;
static_assert(std::is_trivially_copyable_v<Record>, "crosses threads by copy");

/// Their names in summaries and reports, in the same order.
inline constexpr std::array<const char*, std::variant_size_v<Record>> kRecordNames{
    "tick", "arrived", "link", "note", "transition", "contact", "depth_estimate", "depth_arrived"};

/// Thread: rt. Never blocks, never allocates.
class Recorder {
 public:
  virtual ~Recorder() = default;
  /// @returns false: queue full, the record is lost and counted.
  virtual bool record(const Record& record) noexcept = 0;
};

}  // namespace palp::record
