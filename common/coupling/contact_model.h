#pragma once

#include <array>
#include <cstddef>

#include "common/message/port_sample.h"

/// The passive contact law that the coupling `mmt` sends instead of delayed forces.
namespace palp::coupling {

/// The shapes [-] at a scaled depth xi [-] >= 0, in the order of ModelPayload::c.
[[nodiscard]] std::array<double, kModelTerms> model_shapes(double xi) noexcept;

/// Data deeper than this are not believed [m]: the stage does not go there.
inline constexpr double kModelDepthMax = 8e-3;

/// The stiffness [N/m] at each of kModelKnots, straight lines between, constant beyond the last.
using KnotStiffness = std::array<double, kModelKnots.size()>;

/// [m], the force at `depth` [m] of a stiffness of 1 N/m at that knot alone.
[[nodiscard]] double knot_ramp(std::size_t knot, double depth) noexcept;

/// The elastic part, a spring without memory: with coefficients and stiffness >= 0 its force is
/// rising in the depth and 0 at the surface, so that whatever is sent is passive. Deeper than
/// `reach` it goes on along its tangent: what nobody measured is not extrapolated. A value.
struct ContactModel {
  double surface{};                     ///< [m]
  std::array<double, kModelTerms> c{};  ///< [N], each >= 0
  double reach{};                       ///< [m], below the surface
  KnotStiffness stiffness{};            ///< [N/m], each >= 0

  [[nodiscard]] double force(double depth) const noexcept;   ///< [m] -> [N]
  [[nodiscard]] double energy(double depth) const noexcept;  ///< [m] -> [J], integral of force
  [[nodiscard]] double slope(double depth) const noexcept;   ///< [m] -> [N/m]
  /// [N] -> [m], where the force is that; kModelDepthMax at most.
  [[nodiscard]] double depth(double force) const noexcept;
};

/// The elastic spring and what it was lately: a tissue that relaxes (quasi-linear, Fung 1993). With
/// a past that stands still its force is rising in the depth, like the elastic one's, and what it
/// stores is the integral of it. A value.
class RelaxingContact {
 public:
  using Shares = std::array<double, kModelTimes.size()>;

  /// Another tissue with the same past. `relaxing` [-], each >= 0.
  void become(const ContactModel& elastic, const Shares& relaxing) noexcept;
  void forget() noexcept;
  /// `span` [s] at `depth` [m].
  void age(double depth, double span) noexcept;
  /// Both in one: so aged, it becomes another.
  void age_into(const ContactModel& elastic,
                const Shares& relaxing,
                double depth,
                double span) noexcept;

  [[nodiscard]] double force(double depth) const noexcept;   ///< [m] -> [N]
  [[nodiscard]] double energy(double depth) const noexcept;  ///< [m] -> [J], integral of force
  [[nodiscard]] const ContactModel& elastic() const noexcept { return elastic_; }
  [[nodiscard]] const Shares& relaxing() const noexcept { return relaxing_; }

 private:
  void remember(double depth, double span) noexcept;
  void find_onset() noexcept;

  ContactModel elastic_;
  Shares relaxing_{};
  Shares past_{};          ///< [N], elastic force on exponential averages
  double gain_{1};         ///< [-], of the elastic force
  double pull_{};          ///< [N], what the past takes away
  double onset_{};         ///< [m], where a force begins: tissue does not pull
  double onset_energy_{};  ///< [J], elastic, there
};

/// What a receiver may believe: numbers, c and stiffness >= 0, shares between 0 and 1, and a
/// surface within `travel` [m] of 0.
[[nodiscard]] bool is_sound(const ModelPayload& model, double travel) noexcept;

/// How far beyond the deepest data a model is trusted [m].
inline constexpr double kModelReachBeyond = 2e-3;
[[nodiscard]] ContactModel contact_model(const ModelPayload& model) noexcept;
/// The same, nowhere steeper than `slope_max` [N/m]: what a device can show of a stiffer tissue.
[[nodiscard]] ContactModel no_steeper(const ContactModel& model, double slope_max) noexcept;
/// [-], how much steeper a tissue is to a quick hand, of whose force such shares [-] relax.
[[nodiscard]] double quick_gain(const RelaxingContact::Shares& relaxing) noexcept;

}  // namespace palp::coupling
