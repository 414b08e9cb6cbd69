#pragma once

#include <cstdint>

#include "common/core/device_facts.h"
#include "common/core/place.h"
#include "common/core/site_state.h"
#include "common/core/time.h"
#include "common/core/user_command.h"
#include "common/message/enumerators.h"
#include "common/message/field.h"

/// What a tick is given, raw, so that it can be done again: what the devices said, what the link
/// said besides the samples, what the user asked. A tick's records end with its LinkHeard.
namespace palp {

/// The hand, once a tick.
struct HandReading {
  TimePoint at{};
  Duration age{};     ///< of the reading at `at`
  double position{};  ///< [m], device axis; not a number where the device gave none
  double velocity{};  ///< [m/s]
  Place place;
  bool pedal_held{};
  bool emergency_stop{};
  bool faulted{};
  std::uint32_t script_phase{};  ///< of a scripted operator, 1, 2, ...; 0: none has begun
};

/// The stage, once a tick.
struct StageReading {
  TimePoint at{};
  Duration age{};     ///< of the reading at `at`
  double position{};  ///< [m], tip
  double velocity{};  ///< [m/s]
  Place place;
  bool at_limit{};
  bool faulted{};
};

/// The force sensor, once a tick.
struct ForceReading {
  TimePoint at{};
  bool fresh{};    ///< false: it had none, and the rest says nothing
  Duration age{};  ///< of the reading at `at`
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
  Place peer_place;
  std::uint32_t depth_number{};  ///< of the peer's report; at the patient's: of its own estimate
};

/// The user's commands, when they change and at the first tick.
struct UserAsked {
  TimePoint at{};
  UserCommand command;
};

/// Devices as they describe themselves: one's own at the first tick, the peer's when a session
/// begins; none when it ends.
struct DevicesTold {
  TimePoint at{};
  bool of_peer{};
  DeviceFacts facts;
};

namespace message {

template <std::same_as<HandReading> S>
inline constexpr auto fields<S> = list({.log = "HandReading"},
                                       aside<&S::at>("at_ns"),
                                       field<1, &S::position>("position_m"),
                                       field<2, &S::velocity>("velocity_m_per_s"),
                                       field<3, &S::place, &Place::x>("x_m"),
                                       field<4, &S::pedal_held>("pedal_held"),
                                       field<5, &S::emergency_stop>("emergency_stop"),
                                       field<6, &S::faulted>("faulted"),
                                       field<7, &S::age>("age_ns"),
                                       field<8, &S::script_phase>("script_phase"),
                                       field<9, &S::place, &Place::y>("y_m"));

template <std::same_as<StageReading> S>
inline constexpr auto fields<S> = list({.log = "StageReading"},
                                       aside<&S::at>("at_ns"),
                                       field<1, &S::position>("position_m"),
                                       field<2, &S::velocity>("velocity_m_per_s"),
                                       field<3, &S::place, &Place::x>("x_m"),
                                       field<4, &S::at_limit>("at_limit"),
                                       field<5, &S::faulted>("faulted"),
                                       field<6, &S::age>("age_ns"),
                                       field<7, &S::place, &Place::y>("y_m"));

template <std::same_as<ForceReading> S>
inline constexpr auto fields<S> = list({.log = "ForceReading"},
                                       aside<&S::at>("at_ns"),
                                       field<1, &S::fresh>("fresh"),
                                       field<2, &S::force>("force_n"),
                                       field<3, &S::saturated>("saturated"),
                                       field<4, &S::age>("age_ns"));

template <std::same_as<LinkHeard> S>
inline constexpr auto fields<S> = list({.log = "LinkHeard"},
                                       aside<&S::at>("at_ns"),
                                       field<1, &S::state>("state"),
                                       field<2, &S::session_id>("session_id", fixed_width),
                                       field<3, &S::gap>("gap_ns"),
                                       field<4, &S::round_trip>("round_trip_ns"),
                                       field<5, &S::key>("key"),
                                       field<6, &S::peer_heard>("peer_heard"),
                                       field<7, &S::peer_state>("peer_state"),
                                       field<8, &S::peer_epoch>("peer_epoch"),
                                       field<9, &S::peer_place, &Place::x>("peer_x_m"),
                                       field<10, &S::depth_number>("depth_number"),
                                       field<11, &S::peer_place, &Place::y>("peer_y_m"));

template <std::same_as<UserCommand> S>
inline constexpr auto fields<S> = list({},
                                       field<1, &S::emergency_stop>("emergency_stop"),
                                       field<2, &S::resets>("resets"));

template <std::same_as<UserAsked> S>
inline constexpr auto fields<S> = list({.log = "UserCommand"},
                                       aside<&S::at>("at_ns"),
                                       spread<0, &S::command>(""));

template <std::same_as<HandFacts> S>
inline constexpr auto fields<S> = list({},
                                       field<1, &S::axes>("axes", always),
                                       field<2, &S::force_peak>("force_peak_n", always),
                                       field<3, &S::force_continuous>("force_continuous_n", always),
                                       field<4, &S::rate>("rate_hz", always),
                                       field<20, &S::lag>("lag_s", always));

template <std::same_as<StageFacts> S>
inline constexpr auto fields<S> = list({},
                                       field<1, &S::axes>("axes", always),
                                       field<2, &S::travel_min>("travel_min_m", always),
                                       field<3, &S::travel_max>("travel_max_m", always),
                                       field<4, &S::travel_side>("travel_side_m", always),
                                       field<5, &S::speed>("speed_m_per_s", always),
                                       field<6, &S::acceleration>("acceleration_m_per_s2", always),
                                       field<7, &S::rate>("rate_hz", always),
                                       field<8, &S::lag>("lag_s", always),
                                       field<9, &S::drags>("drags", always));

template <std::same_as<ForceSensorFacts> S>
inline constexpr auto fields<S> = list({},
                                       field<1, &S::pole>("pole_hz", always),
                                       field<2, &S::step>("step_n", always),
                                       field<3, &S::range>("range_n", always),
                                       field<4, &S::noise>("noise_n", always),
                                       field<5, &S::rate>("rate_hz", always),
                                       field<6, &S::lag>("lag_s", always),
                                       field<8, &S::yield>("yield_m_per_n", always));

template <std::same_as<DeviceFacts> S>
inline constexpr auto fields<S> = list({.shared = "Devices"},
                                       spread<0, &S::hand>("hand_"),
                                       spread<4, &S::stage>("stage_"),
                                       spread<13, &S::sensor>("sensor_"));

template <std::same_as<DevicesTold> S>
inline constexpr auto fields<S> = list({.log = "DevicesTold"},
                                       aside<&S::at>("at_ns"),
                                       field<1, &S::of_peer>("of_peer"),
                                       field<2, &S::facts>("devices"));

}  // namespace message
}  // namespace palp
