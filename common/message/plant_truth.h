#pragma once

#include <cstdint>

#include "common/core/place.h"
#include "common/core/time.h"
#include "common/message/field.h"

namespace palp {

/// What is true in a simulation of both sites at one of its ticks, and what no site could tell:
/// only the lab writes it, for whoever judges the run. Forces at the hand are + out of the tissue.
struct PlantTruth {
  TimePoint at{};
  Duration run_time{};     ///< since the run began
  Duration script_time{};  ///< of the hand's script
  // The stretch of the script that the hand is in.
  std::uint32_t phase_kind{};   ///< judge::PhaseKind
  std::uint32_t phase_index{};  ///< of the tap or the hold
  Duration phase_began{};       ///< script time
  Duration phase_duration{};
  Place phase_place;
  bool performing{};       ///< the script runs, and the surgeon's process lives
  bool counted{};          ///< the surgeon's site is Engaged or in Hold
  bool guarded{};          ///< the surgeon's process lives, and its pedal is down
  bool held{};             ///< the surgeon's process stands still
  bool resumed{};          ///< a process of either site stood still at the last tick, or lies
  bool dark{};             ///< the path carries nothing
  double hand{};           ///< [m], past the surface
  double hand_velocity{};  ///< [m/s]
  double hand_force{};     ///< [N], on the hand
  double hand_work{};      ///< [J], of the hand on the device since the start
  double force_true{};     ///< [N], of the tissue, had the hand pressed it
  double surface{};        ///< [m], where it is now, of its place at rest
  double tip{};            ///< [m], past the surface
  double tip_velocity{};   ///< [m/s], of the stage
  Place tip_place;         ///< of the stage
  double contact_force{};  ///< [N], largest since the last tick
  double tissue_energy{};  ///< [J], that the tip gave to the tissue
};

namespace message {

template <std::same_as<PlantTruth> S>
inline constexpr auto fields<S> = list({.log = "PlantTruth"},
                                       aside<&S::at>("at_ns"),
                                       field<1, &S::run_time>("run_time_ns"),
                                       field<2, &S::script_time>("script_time_ns"),
                                       field<3, &S::phase_kind>("phase_kind"),
                                       field<4, &S::phase_index>("phase_index"),
                                       field<5, &S::phase_began>("phase_began_ns"),
                                       field<6, &S::phase_duration>("phase_duration_ns"),
                                       field<7, &S::phase_place, &Place::x>("phase_x_m"),
                                       field<8, &S::phase_place, &Place::y>("phase_y_m"),
                                       field<9, &S::performing>("performing"),
                                       field<10, &S::counted>("counted"),
                                       field<11, &S::guarded>("guarded"),
                                       field<12, &S::held>("held"),
                                       field<13, &S::resumed>("resumed"),
                                       field<14, &S::dark>("dark"),
                                       field<15, &S::hand>("hand_m"),
                                       field<16, &S::hand_velocity>("hand_velocity_m_per_s"),
                                       field<17, &S::hand_force>("hand_force_n"),
                                       field<18, &S::hand_work>("hand_work_j"),
                                       field<19, &S::force_true>("force_true_n"),
                                       field<20, &S::surface>("surface_m"),
                                       field<21, &S::tip>("tip_m"),
                                       field<22, &S::tip_velocity>("tip_velocity_m_per_s"),
                                       field<23, &S::tip_place, &Place::x>("tip_x_m"),
                                       field<24, &S::tip_place, &Place::y>("tip_y_m"),
                                       field<25, &S::contact_force>("contact_force_n"),
                                       field<26, &S::tissue_energy>("tissue_energy_j"));

}  // namespace message
}  // namespace palp
