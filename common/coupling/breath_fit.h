#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/core/small_solver.h"
#include "common/coupling/breath_path.h"
#include "common/message/port_sample.h"

namespace palp::coupling {

/// Of model_shapes(), what a breathing tissue is made of: the second to the fourth.
inline constexpr std::size_t kBreathShapes = 3;
inline constexpr std::size_t kBreathSurface = kBreathShapes;
inline constexpr std::size_t kBreathRelaxes = kBreathSurface + 1;
inline constexpr std::size_t kBreathRate = kBreathRelaxes + kModelTimes.size();
inline constexpr std::size_t kBreathUnknowns = kBreathRate + 1;

/// The shapes [N], each >= 0, to a quick tip; the mean surface [mm]; the shares [-] that relax,
/// each >= 0; the pace of the breath [rad/s].
using BreathTissue = std::array<double, kBreathUnknowns>;

/// What is expected of a tissue, and how closely.
struct BreathPrior {
  BreathTissue tissue{};
  std::array<BreathTissue, kBreathUnknowns> closely{};  ///< inverse covariance
};

/// What the tip met at an instant.
struct BreathSample {
  double at{};                                    ///< [s]
  double position{};                              ///< [m]
  double force{};                                 ///< [N]
  std::array<double, kModelTimes.size()> past{};  ///< [N], the force on exponential averages
};

/// A tissue and the way of its surface, found together for one pace of breath: the surface is
/// followed through all samples, and what it did not foresee improves the tissue (Gauss and
/// Newton, damped as by Marquardt). A time through the samples is begin(), add() for each in their
/// order, and improve(). Thread: rt; bounded work. A value.
class BreathFit {
 public:
  using Path = BreathPath<kBreathUnknowns>;

  BreathFit() = default;  ///< surface at rest
  /// A pace of `rate` [rad/s], or by a share of `band` more or less.
  BreathFit(double rate, double band) noexcept;

  void begin() noexcept { pass_ = {}; }
  /// `here`: at this place, else at the last one, whose tissue is taken as it was found.
  void add(const BreathSample& sample, bool here) noexcept;
  void improve(const BreathPrior& prior) noexcept;
  /// The path goes on with a sample from after the last time through.
  void follow(const BreathSample& sample) noexcept;

  [[nodiscard]] const BreathTissue& tissue() const noexcept { return here_; }
  /// Its pace stays.
  void suppose(const BreathTissue& tissue) noexcept;
  /// The surface is supposed where this force [N] at `position` [m] would have it, if it is now
  /// displaced by so much [m].
  void seek(double position, double force, double displacement) noexcept;
  /// Another place.
  void leave() noexcept { before_ = here_; }

  /// The surface, as foreseen for a time [s] after the last sample.
  [[nodiscard]] Path at(double time) const noexcept;
  [[nodiscard]] double seen_at() const noexcept { return seen_at_; }      ///< [s], last sample
  [[nodiscard]] double square() const noexcept { return square_; }        ///< [N^2], not foreseen
  [[nodiscard]] double cost() const noexcept { return cost_; }            ///< [-]
  [[nodiscard]] double amplitude() const noexcept { return amplitude_; }  ///< [m]
  /// The tissue as it will be expected, and how closely it is known.
  /// Its pace is not expected of a tissue.
  [[nodiscard]] BreathPrior found() const noexcept;

 private:
  /// One time through the samples.
  struct Pass {
    std::optional<Path> path;
    double at{};                            ///< [s], of the sample before
    SmallSystem<kBreathUnknowns> system{};  ///< for a step of the tissue
    double square{};                        ///< [N^2], sum, weighted
    double cost{};                          ///< [-]
    double away{};                          ///< [mm^2], sum
    double count{};                         ///< [-], of samples
  };
  /// The surface, as a sample shows it.
  struct Sight {
    double displacement{};  ///< [mm], of it from its mean
    double variance{};      ///< [mm^2]
    double slope{};         ///< [N/mm], of the tissue there
    BreathTissue by{};      ///< [mm], by which it grows with each unknown
  };

  [[nodiscard]] static std::optional<Sight> sight(const BreathTissue& tissue,
                                                  const Path& path,
                                                  const BreathSample& sample) noexcept;
  void expect(const BreathPrior& prior) noexcept;
  [[nodiscard]] BreathTissue step() const noexcept;

  Path path_;      ///< through all samples, with the tissue here
  double rate_{};  ///< [rad/s], in the middle of its paces; 0: at rest
  double band_{};  ///< [-]
  BreathTissue here_{};
  BreathTissue before_{};
  Pass pass_;
  double seen_at_{};                                   ///< [s]
  double square_{};                                    ///< [N^2], mean
  double cost_{};                                      ///< [-]
  double amplitude_{};                                 ///< [m]
  std::array<BreathTissue, kBreathUnknowns> known_{};  ///< as BreathPrior has it
};

/// Before anything was felt anywhere.
[[nodiscard]] BreathPrior first_breath_prior() noexcept;
/// Of a new place, `distance` [m] from one of which so much is known.
[[nodiscard]] BreathPrior prior_beside(const BreathPrior& found, double distance) noexcept;

}  // namespace palp::coupling
