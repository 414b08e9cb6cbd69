#pragma once

#include <cstdint>
#include <optional>

#include "common/core/device_facts.h"
#include "common/core/filters.h"
#include "common/core/limits.h"
#include "common/coupling/breathing_estimator.h"
#include "common/coupling/contact_estimator.h"
#include "common/coupling/contact_model.h"
#include "common/coupling/contradiction.h"
#include "common/coupling/coupling.h"
#include "common/coupling/late_device.h"
#include "common/coupling/paired_readings.h"
#include "common/coupling/release_line.h"

/// Coupling `mmt`: the patient site says what the tissue is like, not what it just did. The
/// surgeon site renders that model at the device's rate, behind a tank that pays for every change
/// of it: whatever arrives, and whenever, the hand gets no more energy than it gave plus one
/// fixed amount.
namespace palp::coupling {

/// One list, as message Mmt of the configuration has it.
struct MmtConfig {
  /// [J], full at first, and the guarantee: the most that the hand can get from any moment on at
  /// which nothing is shown.
  double tank{1e-3};
  double slew{4};           ///< [N/s], of the force while a new model comes in
  double slew_short{12};    ///< [N/s], the same below `round_trip_short`
  double slew_small{9};     ///< [N/s], the same where little force is missing
  double gap_small{0.1};    ///< [N], of missing force: up to here it is little
  double gap_large{0.3};    ///< [N], and from here on it is not
  double slew_speed{0.06};  ///< [m/s], of a hand moving in: from here on all of it comes in
  double slew_rest{0.1};    ///< [-], share of it under a hand at rest; none a little faster out
  double slew_beside{1};    ///< [N/s], of a new model beside what motion alone does
  Duration round_trip_short{std::chrono::milliseconds{8}};
  ReleaseLineConfig release;      ///< of a force that the tank cannot pay the spring of
  double blend{0.05};             ///< [s], time constant of changes of the model
  double believed{0.4};           ///< [N], so much may a peer take back as it learns
  double doubt{0.2};              ///< [N], beyond that, with which `blend` doubles
  double slowest{40};             ///< [-], so many times `blend` at most: what lasts is shown
  double surface_speed{8e-3};     ///< [m/s], at most, of a shown surface that swings or drifts
  double surface_believed{8e-3};  ///< [m], so much of its way may a peer take back
  double surface_doubt{3e-3};     ///< [m], beyond that, with which `surface_speed` halves
  double fall{25};                ///< [N/s], most by which they let the force fall
  double brake{2};                ///< [N s/m], on the way in, while a force is still to come in
  double contact_damping{0.2};    ///< [N s/m], on the way out: the way in is what a finger judges
  double air_damping{0.3};        ///< [N s/m], fills the tank
  double repay_contact{3};        ///< [N s/m], on top on the way out while the tank is empty
  double repay_air{0.7};          ///< [N s/m], the same in the air
  double empty_damping{2};        ///< [N s/m], on top while the tank is overdrawn
  double overdraft{5e-6};         ///< [J], with which that is reached
  double velocity_cut_off{60};    ///< [Hz]
  double fade{1};                 ///< [s], of the model in Retract
  double period{1e-3};            ///< [s]
  double lead_max{25e-3};         ///< [s], most that the target runs ahead of the hand's position
  double lead_cut_off{15};        ///< [Hz], of the velocity that is told for it
  /// [N], so much harder than the hand is told, and by `unfelt_share` of what it is told, the tip
  /// presses before it gives way.
  double unfelt{0.35};
  double unfelt_share{0.1};        ///< [-]
  double braked_beyond{0.2};       ///< [N], above that: from there on the gate brakes it
  double unfelt_drag{0.02};        ///< [N], as `unfelt`, of a tip that is dragged: it waits there
  double unfelt_drag_share{0.03};  ///< [-]
  double drag_memory{0.3};         ///< [s], for so long after it came to another place
  double yield{6e-3};              ///< [m/s per N], at which the tip gives way to more than that
  double yield_most{4e-3};         ///< [m]
  double travel{60e-3};            ///< [m], a surface farther from 0 is not believed
  double slope_max{1500};          ///< [N/m], of a stiffer tissue no more is shown
  ContactEstimatorConfig estimator;
};

/// Renders the newest believable model. Its books, at every tick: tank + stored energy <= what they
/// were at any earlier one + work of the hand since then, with the force that was really applied;
/// the stored energy never exceeds what the tank can pay, and the tank never holds more than at
/// first. Nothing in them depends on the network. Thread: rt.
class MmtSurgeon {
 public:
  explicit MmtSurgeon(const MmtConfig& config, const HandFacts& hand = {}) noexcept;
  void begin_epoch(double position) noexcept;
  SurgeonOutput step(const SurgeonInput& in, const Lapse& lapse) noexcept;

  [[nodiscard]] double tank() const noexcept { return tank_; }      ///< [J]
  [[nodiscard]] double stored() const noexcept { return stored_; }  ///< [J], in the shown model
  [[nodiscard]] const RelaxingContact& shown() const noexcept { return shown_; }
  [[nodiscard]] std::uint64_t refused() const noexcept { return refused_; }  ///< models

 private:
  void hear(const SurgeonInput& in) noexcept;
  [[nodiscard]] double told_force(double position) const noexcept;
  [[nodiscard]] double place_shown(double position) const noexcept;
  [[nodiscard]] double too_stiff(double position) const noexcept;
  void drop_model() noexcept;
  [[nodiscard]] SurgeonOutput let_go(const SurgeonInput& in, double work) noexcept;
  void swing_shown(ContactModel& elastic, double span) noexcept;
  void approach_candidate(double position, double depth, const Lapse& lapse) noexcept;
  [[nodiscard]] double depth_at(double position) const noexcept {
    return position - shown_.elastic().surface;
  }
  [[nodiscard]] double slew_for(double position, Duration round_trip) const noexcept;
  void give_way(double moved) noexcept;
  [[nodiscard]] double force_now() const noexcept;
  [[nodiscard]] double energy_now() const noexcept;
  void choose_depth(double position, double energy_max, double force_max) noexcept;
  void brake(double missing, double speed, double rise_max) noexcept;
  [[nodiscard]] double debt() const noexcept;
  [[nodiscard]] double damp(double force, double depth, double speed) const noexcept;

  MmtConfig config_;
  LateDevice device_;
  VelocityEstimate velocity_;
  LowPass told_velocity_;     ///< [m/s]
  double position_before_{};  ///< [m]
  double tank_;               ///< [J]
  double stored_{};           ///< [J]
  double shown_force_{};      ///< [N], of the shown model, last tick
  double depth_{};  ///< [m], of the shown model; less than the hand's while force is missing
  ReleaseLine release_;
  double brake_{};  ///< [N]
  RelaxingContact shown_;
  bool showing_{};
  Swing swing_;                                   ///< of the newest model, when it was sent
  double swing_age_{};                            ///< [s], since then
  double swung_{};                                ///< [m], of the shown surface, towards it
  std::optional<ContactModel> candidate_;         ///< none: nothing was learned yet
  ContactModel told_;                             ///< the same, as steep as it was told
  RelaxingContact::Shares candidate_relaxing_{};  ///< [-]
  Contradiction force_contradiction_{30e-3};      ///< [N]
  Contradiction surface_contradiction_{30e-6};    ///< [m]
  std::uint32_t version_{};
  Ramp presence_{1};
  std::uint64_t refused_{};
};

/// The stage follows the newest hand position, ahead of it by what servo and path take away, so
/// that the tip is where the hand is; the estimator watches.
class MmtPatient {
 public:
  /// The estimator's sensor is that of `devices`.
  explicit MmtPatient(const MmtConfig& config, const PatientDevices& devices = {}) noexcept;
  void begin_epoch(double position) noexcept;
  PatientOutput step(const PatientInput& in, const Lapse& lapse) noexcept;

 private:
  [[nodiscard]] double target(const PatientInput& in, const Lapse& lapse) noexcept;
  [[nodiscard]] double allowed() const noexcept;
  [[nodiscard]] double behind_in_drag(double led) const noexcept;
  void give_way(double force, double span) noexcept;
  void notice_drag(const PatientInput& in, double span) noexcept;

  MmtConfig config_;
  double stage_lead_;  ///< [s], what the servo takes away, in whole ticks
  PairedReadings paired_;
  ContactEstimator estimator_;
  double hand_{};           ///< [m], newest
  double hand_velocity_{};  ///< [m/s], newest, as smooth as it was told
  double hand_force_{};     ///< [N], newest
  double yielded_{};        ///< [m]
  double since_drag_;       ///< [s]
  TimePoint heard_at_{};
  Place place_;
  bool began_{};
};

static_assert(HalfOfLaw<MmtSurgeon, SurgeonInput, SurgeonOutput>);
static_assert(HalfOfLaw<MmtPatient, PatientInput, PatientOutput>);

}  // namespace palp::coupling
