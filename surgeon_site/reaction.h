#pragma once

#include <array>
#include <cstddef>

#include "common/core/time.h"

namespace palp::surgeon {

/// How a hand reacts to what moves it, beside its passive impedance. By default it does not.
struct ReactionConfig {
  double reflex{};  ///< [-], share of the grip's stiffness, 0: none
  Duration reflex_delay{std::chrono::milliseconds{50}};  ///< 20 to 150 ms
  double co_contraction{};  ///< [1/N], by which the stiffness grows with the load, 0: none
};

/// Stretch reflex and co-contraction of a hand. After van der Helm, Schouten, de Vlugt and Brouwn
/// (J Neurosci Methods 119, 2002): intrinsic impedance, and beside it a feedback of stretch through
/// a neural delay and the activation of the muscle. Here the feedback is of position alone, and
/// the activation two lags in series, of excitation and contraction. In a grip load-dependent
/// reactions begin after 60 to 90 ms (Cole and Abbs, J Neurophysiol 60, 1988), and stiffness grows
/// linearly with grip force (Hoeppner, McIntyre and van der Smagt, PLoS ONE 8, 2013). A value;
/// thread: rt-safe.
class Reaction {
 public:
  static constexpr double kExcitation = 0.03;   ///< [s], lag of the muscle's excitation
  static constexpr double kContraction = 0.04;  ///< [s], lag of its contraction
  static constexpr double kTensing = 0.3;       ///< [s], lag of the co-contraction
  static constexpr double kTensest = 2;         ///< [-], most by which the stiffness grows
  static constexpr Duration kDelayMin = std::chrono::milliseconds{20};
  static constexpr Duration kDelayMax = std::chrono::milliseconds{150};

  explicit Reaction(const ReactionConfig& config) noexcept;

  [[nodiscard]] bool none() const noexcept { return none_; }
  /// The steps to come take `dt` [s] > 0.
  void set_step(double dt) noexcept;
  /// A step of a handle that is `stretch` [m] behind its intent, under `load` [N].
  void step(double stretch, double load) noexcept;

  /// What the reflex adds to the stretch that the grip's stiffness works against [m].
  [[nodiscard]] double reflex() const noexcept { return config_.reflex * contracted_; }
  /// Factor of the grip's stiffness [-]; damping grows with its root, so its ratio stays.
  [[nodiscard]] double tension() const noexcept;

 private:
  /// The stretch is kept in a raster, so that the delay does not depend on how time is cut.
  static constexpr double kRaster = 1e-4;  ///< [s]
  static constexpr std::size_t kKept = 1536;

  void keep(double stretch) noexcept;                  ///< [m]
  [[nodiscard]] double late_stretch() const noexcept;  ///< [m]

  ReactionConfig config_;
  bool none_;
  double dt_{};                       ///< [s]
  double excitation_gain_{};          ///< [-], of a step
  double contraction_gain_{};         ///< [-]
  double tensing_gain_{};             ///< [-]
  std::array<double, kKept> kept_{};  ///< [m], before the start the hand was at rest
  std::size_t newest_{};              ///< index in `kept_`
  double since_{};                    ///< [s], since the newest
  double stretch_{};                  ///< [m], of the step before
  double excited_{};                  ///< [m]
  double contracted_{};               ///< [m]
  double load_{};                     ///< [N], smooth
};

}  // namespace palp::surgeon
