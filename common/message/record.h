#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <variant>

#include "common/core/place.h"
#include "common/core/site_state.h"
#include "common/core/time.h"
#include "common/message/depth.h"
#include "common/message/enumerators.h"
#include "common/message/field.h"
#include "common/message/link_health.h"
#include "common/message/map_report.h"
#include "common/message/plant_truth.h"
#include "common/message/port_sample.h"
#include "common/message/readings.h"

/// What a site writes down: typed and complete.
namespace palp {

/// One tick of a node: what the law was given, what it said, what the gate let through.
struct SiteTick {
  TimePoint at{};
  SiteState state{};
  std::uint32_t epoch{};
  double position{};  ///< [m], as given to the law
  double velocity{};  ///< [m/s]
  double force{};     ///< [N]; surgeon: as applied last tick, patient: contact force measured
  Place place;
  double command{};        ///< [N] to the hand or [m] to the stage, behind the gate
  bool gate_acted{};       ///< the gate changed what the law asked for
  Duration round_trip{};   ///< as given to the law
  PortSample sent;         ///< to the peer
  double force_missing{};  ///< [N], surgeon: of what the law believes in, what it cannot give
  double short_by{};       ///< [N], surgeon: so much less than the tissue's, as it is told
  /// Surgeon: of the note that says why (record::NoteCode), while it is told; 0: it is not.
  std::uint16_t short_note{};
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
  std::uint64_t records_dropped{};  ///< by the full queue, so far; the session's writer says it
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

/// What the touches at all places say together, at the patient's.
struct MapEstimate {
  TimePoint at{};  ///< the last of these strokes ended
  MapReport report{};
};

/// The same as it arrived at the surgeon's.
struct MapArrived {
  TimePoint at{};
  MapReport report{};
};

using Record = std::variant<SiteTick,
                            Arrived,
                            LinkStatus,
                            Note,
                            Transition,
                            DepthEstimate,
                            DepthArrived,
                            HandReading,
                            StageReading,
                            ForceReading,
                            LinkHeard,
                            UserAsked,
                            DevicesTold,
                            PlantTruth,
                            MapEstimate,
                            MapArrived,
                            MapCell>;
static_assert(std::is_trivially_copyable_v<Record>, "crosses threads by copy");

/// Their names in summaries and reports, in the same order.
inline constexpr std::array<const char*, std::variant_size_v<Record>> kRecordNames{"tick",
                                                                                   "arrived",
                                                                                   "link",
                                                                                   "note",
                                                                                   "transition",
                                                                                   "depth_estimate",
                                                                                   "depth_arrived",
                                                                                   "hand",
                                                                                   "stage",
                                                                                   "force",
                                                                                   "heard",
                                                                                   "user",
                                                                                   "devices",
                                                                                   "truth",
                                                                                   "map_estimate",
                                                                                   "map_arrived",
                                                                                   "map_cell"};

namespace message {

/// Notes and changes of state as the log has them, on one topic.
enum class EventKind : std::uint8_t { Note, Transition };
struct Event {
  TimePoint at{};
  EventKind kind{};
  std::uint16_t code{};   ///< of the note, or of the reason
  std::string_view text;  ///< the same for people
  double detail{};        ///< [by code], of notes
  SiteState from{};       ///< of transitions, as the next
  SiteState to{};
};

template <std::same_as<SiteTick> S>
inline constexpr auto fields<S> = list({},
                                       aside<&S::at>("at_ns"),
                                       field<1, &S::state>("state"),
                                       field<2, &S::epoch>("epoch"),
                                       field<3, &S::position>("position_m"),
                                       field<4, &S::velocity>("velocity_m_per_s"),
                                       field<5, &S::force>("force_n"),
                                       field<6, &S::place, &Place::x>("x_m"),
                                       field<7, &S::command>({"command_n", "command_m"}),
                                       field<8, &S::gate_acted>("gate_acted"),
                                       field<9, &S::round_trip>("round_trip_ns"),
                                       spread<9, &S::sent>("sent_"),
                                       field<16, &S::place, &Place::y>("y_m"),
                                       field<18, &S::force_missing>("force_missing_n"),
                                       field<21, &S::short_by>("force_short_n"),
                                       field<22, &S::short_note>("short_note"));

template <std::same_as<Arrived> S>
inline constexpr auto fields<S> = list({.log = "ArrivedSample"},
                                       aside<&S::at>("at_ns"),
                                       spread<0, &S::incoming>(""));

template <std::same_as<LinkStatus> S>
inline constexpr auto fields<S> = list({.log = "LinkStatus"},
                                       aside<&S::at>("at_ns"),
                                       spread<0, &S::health>(""),
                                       field<20, &S::records_dropped>("records_dropped"));

template <std::same_as<Note> S>
inline constexpr auto fields<S> =
    list({}, aside<&S::at>("at_ns"), aside<&S::code>("code"), aside<&S::detail>("detail"));

template <std::same_as<Transition> S>
inline constexpr auto fields<S> = list({},
                                       aside<&S::at>("at_ns"),
                                       aside<&S::from>("from"),
                                       aside<&S::to>("to"),
                                       aside<&S::reason>("reason"));

template <std::same_as<DepthArrived> S>
inline constexpr auto fields<S> = list({.log = "DepthReport"},
                                       aside<&S::at>("at_ns"),
                                       spread<0, &S::report>(""));

template <std::same_as<MapEstimate> S>
inline constexpr auto fields<S> = list({.log = "MapEstimate"},
                                       aside<&S::at>("at_ns"),
                                       spread<0, &S::report>(""));

template <std::same_as<MapArrived> S>
inline constexpr auto fields<S> = list({.log = "MapReport"},
                                       aside<&S::at>("at_ns"),
                                       spread<0, &S::report>(""));

template <std::same_as<EventKind> E>
inline constexpr auto enumerators<E> = enumeration("Kind", "Event", "NOTE", "TRANSITION");

template <std::same_as<Event> S>
inline constexpr auto fields<S> = list({.log = "Event"},
                                       aside<&S::at>("at_ns"),
                                       field<1, &S::kind>("kind"),
                                       field<2, &S::code>("code"),
                                       field<3, &S::text>("text", text_limit<100>),
                                       field<4, &S::detail>("detail"),
                                       field<5, &S::from>("from"),
                                       field<6, &S::to>("to"));

}  // namespace message
}  // namespace palp
