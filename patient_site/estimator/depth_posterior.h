#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "fem/depth_database.h"
#include "patient_site/estimator/curve_lattice.h"
#include "patient_site/estimator/curve_match.h"
#include "patient_site/estimator/depth_distribution.h"

namespace palp::estimator {

/// "Excluded" speaks of inclusions at least so large and so much stiffer than the tissue.
inline constexpr double kShowingRadius = 5e-3;  // [m]
inline constexpr double kShowingRatio = 10;

/// What the strokes at one place say.
struct DepthPosterior {
  double depth{};         ///< [m], median, given that there is an inclusion
  double depth_stddev{};  ///< [m]
  double depth_low{};     ///< [m], 95 % interval
  double depth_high{};    ///< [m]
  double log_evidence{};  ///< [-], of an inclusion over none
  double gain{};          ///< [-], twice the log-likelihood the best inclusion gains over none
  double misfit{};        ///< [N], rms of the samples, weighted
  double excluded{};      ///< [m]: an inclusion of kShowingRadius or more above would have shown
  StiffnessPrior plain;   ///< what the samples say of the block if there is no inclusion
  TouchModel best;        ///< what fits best, inclusion or not
};

/// Compares the strokes of one place with every curve of the database; for each curve the
/// stiffness, the surface and the rate factor are integrated out (CurveMatcher).
///
/// The likelihood of a strong signal is a ridge through depth, radius and ratio that is far
/// narrower than any grid. So for one radius and one ratio the best depth is found exactly and
/// integrated round it; pairs of radius and ratio are cells that are halved until the signal
/// changes by less than its noise within each, by the Fisher information, and forgotten where the
/// ridge is out of reach. A weak signal leaves the cells as they are, a strong one follows the
/// ridge. A value, immutable after construction. Thread: estimator.
class DepthModel {
 public:
  DepthModel(const fem::DepthDatabase& database, const DepthPrior& prior);

  struct Input {
    std::span<const Touch> touches;
    double surface{};                    ///< [m], near it
    double noise{};                      ///< [N], rms of one sample, the steps' share included
    double quantum{};                    ///< [N], of the transducer; 0: no steps
    double cut_off{};                    ///< [Hz], of its pole; 0: none
    StiffnessPrior stiffness;            ///< before this place was touched
    std::optional<TouchModel> expected;  ///< what the touches will show, if that is known
    const NormalEquations* settled{};    ///< earlier touches, nullptr: none
  };
  [[nodiscard]] DepthPosterior update(const Input& input) const;

  /// What the touches leave of themselves once the surface is known.
  void settle(const Input& input, const TouchModel& expected, NormalEquations& to) const;

 private:
  /// A range of radius and ratio, and the best depth at its middle.
  struct Cell {
    double radius{};        ///< [m]
    double radius_width{};  ///< [m]
    double log_ratio{};     ///< [-]
    double ratio_width{};   ///< [-], of the logarithm
    double log_depth{};     ///< [-], of m, the best; a guess before look()
    double depth_stddev{};  ///< [-], of the logarithm, other things equal; 0: there is no guess
    CurveMatch best;
    double radius_reach{};  ///< [-], how far the signal moves to the cell's edge, in stddevs
    double ratio_reach{};   ///< [-]
    double radius_shift{};  ///< [-], how far log_depth moves to the cell's edge
    double ratio_shift{};   ///< [-]
    bool looked{};
  };
  [[nodiscard]] std::vector<Cell> first_cells() const;
  [[nodiscard]] double deepest(double radius) const noexcept;
  void look(const CurveMatcher& points, Cell& cell) const;
  static void split(const Cell& cell, bool wide, bool hard, std::vector<Cell>& out);
  [[nodiscard]] std::vector<Cell> refine(const CurveMatcher& points,
                                         std::vector<Cell> cells,
                                         double shift_max) const;
  [[nodiscard]] std::vector<Cell> cells_of(const CurveMatcher& points,
                                           std::vector<Cell> cells) const;
  void measure(const CurveMatcher& points, const CurveTerms& best, bool pinned, Cell& cell) const;
  [[nodiscard]] static double blur(const Cell& cell) noexcept;
  [[nodiscard]] static double share(const Cell& cell) noexcept;  ///< [m], if there is a range
  void spread(const Cell& cell, std::vector<DepthMass>& out) const;
  void integrate(const CurveMatcher& points, const Cell& cell, std::vector<DepthMass>& out) const;
  [[nodiscard]] double log_prior_total() const;
  [[nodiscard]] NormalEquations sums(const Input& input,
                                     double surface,
                                     const std::optional<TouchModel>& expected) const;
  [[nodiscard]] double excluded(const CurveMatcher& points, double plain) const;

  DepthPrior prior_;
  double height_;  ///< [m], of the block
  CurveLattice lattice_;
  CurveLattice showing_;  ///< what `excluded` speaks of
  CurveBasis basis_;
};

}  // namespace palp::estimator
