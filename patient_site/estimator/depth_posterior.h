#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fem/depth_database.h"
#include "patient_site/estimator/contact_curve.h"

namespace palp::estimator {

/// What is known of an inclusion before it was touched. Equal ends: known exactly; so is, unless
/// told otherwise, the paper's.
struct DepthPrior {
  double depth_min{3e-3};    ///< [m], uniform between
  double depth_max{27e-3};   ///< [m]
  double radius_min{15e-3};  ///< [m], uniform between
  double radius_max{15e-3};  ///< [m]
  double ratio_min{856.2};   ///< [-], uniform in the logarithm
  double ratio_max{856.2};   ///< [-]
  fem::InclusionShape shape{fem::InclusionShape::Ball};
};

/// Of Young's modulus over that of the database, and of how the force grows with the rate.
struct StiffnessPrior {
  double scale{1};                 ///< [-]
  double scale_stddev{0.1};        ///< [-]
  double rate_factor{0.5};         ///< [s/m]
  double rate_factor_stddev{0.5};  ///< [s/m]
};

/// What the points of one place say.
struct DepthPosterior {
  double depth{};         ///< [m], mean, given that there is an inclusion
  double depth_stddev{};  ///< [m]
  double depth_low{};     ///< [m], 95 % interval
  double depth_high{};    ///< [m]
  double log_evidence{};  ///< [-], of an inclusion over none
  double gain{};          ///< [-], twice the log-likelihood the best inclusion gains over none
  double misfit{};        ///< [N], rms of the points, each weighted by its samples
  double excluded{};      ///< [m]: an inclusion of 5 mm or more above this depth would have shown
  StiffnessPrior plain;   ///< what the points say of the block if there is no inclusion
};

/// Compares the binned strokes of one place with every curve of the database: a grid over depth,
/// radius and ratio; for each curve the stiffness, the surface and the rate factor, in which the
/// force is linear, are integrated out by Laplace's method. The log-likelihood is smooth on the
/// scale of the curves, however sharp the answer: it is computed on a coarse grid and interpolated.
/// A value, immutable after construction. Thread: estimator.
class DepthModel {
 public:
  DepthModel(const fem::DepthDatabase& database, const DepthPrior& prior);

  struct Input {
    std::span<const ContactPoint> points;
    double surface{};  ///< [m], near it
    double noise{};    ///< [N], rms of one sample
    StiffnessPrior stiffness;
  };
  [[nodiscard]] DepthPosterior update(const Input& input) const;

 private:
  struct Table {
    std::vector<double> force;  ///< [N], every kStep
  };
  /// A point against the tables: where between two entries it lies.
  struct Place {
    std::size_t entry{};
    double share{};        ///< [-]
    double indentation{};  ///< [m]
    double force{};        ///< [N]
    double rate{};         ///< [m/s]
    double weight{};       ///< [1/N^2]
  };
  struct Match {
    double log_likelihood{};      ///< [-], integrated
    double misfit{};              ///< [-], sum of weighted squares
    double scale{};               ///< [-]
    double scale_stddev{};        ///< [-]
    double rate_factor{};         ///< [s/m]
    double rate_factor_stddev{};  ///< [s/m]
    double shift{};               ///< [m], of the surface, into the tissue
  };
  [[nodiscard]] Table tabulate(const fem::DepthDatabase& database,
                               const fem::DepthDatabase::Curve& curve) const;
  [[nodiscard]] std::vector<Place> locate(const Input& input, double surface) const;
  [[nodiscard]] Match match(const Table& table,
                            std::span<const Place> places,
                            const StiffnessPrior& stiffness) const;
  void summarise(const std::vector<double>& log_likelihood,
                 double plain,
                 DepthPosterior& posterior) const;

  DepthPrior prior_;
  std::vector<double> depths_;  ///< [m], nodes
  std::vector<double> radii_;   ///< [m]
  std::vector<double> ratios_;  ///< [-]
  std::vector<Table> tables_;   ///< by depth, radius, ratio
  Table plain_;
};

}  // namespace palp::estimator
