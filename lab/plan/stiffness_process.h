#pragma once

#include <cstddef>
#include <vector>

#include "common/core/place.h"
#include "depth/place_data.h"

namespace palp::lab {

/// How stiff the tissue is at one touched place.
struct StiffnessReading {
  Place place;
  double value{};   ///< [-], logarithm of the force over that of the plain block of the database
  double stddev{};  ///< [-], by the noise of its samples alone
};

/// Of a place, its curve taken for that of a plain block.
[[nodiscard]] StiffnessReading stiffness_reading(const depth::PlaceData& place) noexcept;

/// What a Gaussian process says of one place.
struct StiffnessTold {
  double mean{};    ///< [-], logarithm, as the readings
  double stddev{};  ///< [-], of the smooth part: what a place has of its own is not in it
};

/// The stiffness over the plane as a Gaussian process, as others search for inclusions (Garg et al.
/// 2016): no ball, no depth. Squared-exponential covariance, an unknown mean, and at each place
/// something of its own besides the noise. Rasmussen and Williams, Gaussian Processes for Machine
/// Learning (2006), eqs. 2.25, 2.26, 2.41 and 5.8. A value, immutable. Thread: any.
class StiffnessProcess {
 public:
  struct Kernel {
    double length{6e-3};    ///< [m]
    double spread{0.1};     ///< [-], standard deviation of the smooth part
    double own{0.01};       ///< [-], of what each place has of its own
    double mean{};          ///< [-], expected before
    double mean_stddev{1};  ///< [-], of it
  };

  /// At least one reading.
  StiffnessProcess(std::vector<StiffnessReading> readings, const Kernel& kernel);
  /// The kernel of the largest marginal likelihood: length 4 to 15 mm, spread 2 to 30 %, own 0.3
  /// to 5 %.
  [[nodiscard]] static StiffnessProcess fitted(const std::vector<StiffnessReading>& readings);

  [[nodiscard]] StiffnessTold at(const Place& place) const;
  /// Logarithm of the marginal likelihood. [-]
  [[nodiscard]] double log_evidence() const noexcept { return log_evidence_; }
  [[nodiscard]] const Kernel& kernel() const noexcept { return kernel_; }

 private:
  [[nodiscard]] double covariance(const Place& a, const Place& b) const noexcept;
  /// Solves L x = right in place, L the root of the readings' covariance.
  void forward(std::vector<double>& right) const noexcept;

  std::vector<StiffnessReading> readings_;
  Kernel kernel_;
  std::vector<double> root_;    ///< [-], lower triangle, row by row
  std::vector<double> solved_;  ///< [-], L^-1 (values - mean)
  double log_evidence_{};       ///< [-]
};

/// The place of a square field, 2 mm apart, where mean + `trust` standard deviations is largest:
/// UCB for 2, the stiffest place for 0. `half` [m]: of the field's side; its middle is the origin.
[[nodiscard]] Place stiffest_place(const StiffnessProcess& process, double half, double trust);

}  // namespace palp::lab
