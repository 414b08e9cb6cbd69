#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "depth/lateral_shape.h"
#include "fem/depth_table.h"

namespace palp::depth {

/// Forces of phantoms with one inclusion: a table that fem solved, interpolated. Cubic with
/// continuous slope in log(depth), log(radius), (k - 1)/(k + 1.5) and log(indentation), of the
/// logarithm of the excess: in these coordinates the curves are nearly straight.
/// A value, immutable: any thread may read it.
class DepthDatabase {
 public:
  [[nodiscard]] static Result<DepthDatabase> make(const fem::DepthTable& table);

  [[nodiscard]] const fem::DepthGrid& grid() const noexcept { return grid_; }

  struct Query {
    fem::InclusionShape shape{fem::InclusionShape::Ball};
    double depth{};   ///< [m]
    double radius{};  ///< [m]
    double ratio{};   ///< [-]
  };
  /// In range and inside the block; the sentence names field, value and limits.
  [[nodiscard]] Result<void> contains(const Query& query) const {
    return contains(query, grid_.block.height);
  }
  /// The same of a block of another height. [m]
  [[nodiscard]] Result<void> contains(const Query& query, double block_height) const;

  /// One force curve, a value of its own.
  struct Curve {
    std::vector<double> log_force;  ///< [-], of the force in N, at the grid's indentations
    double indentation_max{};       ///< [m]
  };
  /// Of a query that contains() accepts; outside it is extrapolated.
  [[nodiscard]] Curve curve(const Query& query) const;
  [[nodiscard]] Curve plain() const;

  /// Of the block with the grid's Young's modulus; 0 outside the tissue. [m] -> [N]
  [[nodiscard]] double force(const Curve& curve, double indentation) const noexcept;
  /// ln(F / F_plain), on the inclusion's axis. [-] Allocates nothing; `indentation` [m].
  [[nodiscard]] double log_excess(const Curve& curve, double indentation) const noexcept;

  /// Whether it knows what a tip beside a ball's axis feels; the three below ask for it.
  [[nodiscard]] bool solved_beside() const noexcept { return beside_.has_value(); }
  /// What is left of this ball's effect beside its axis, over offset and indentation.
  [[nodiscard]] LateralShape::OfBall shape(const Query& ball) const;
  /// g, see LateralShape::share(). `offset` from the axis, on either side [m]. Allocates nothing.
  [[nodiscard]] double share(const LateralShape::OfBall& ball,
                             double offset,
                             double indentation) const noexcept;
  /// ln(F / F_plain) beside the axis: that on the axis times g. Several balls far apart add up.
  /// [-] `curve` and `ball` of one query; allocates nothing.
  [[nodiscard]] double log_excess(const Curve& curve,
                                  const LateralShape::OfBall& ball,
                                  double offset,
                                  double indentation) const noexcept;

 private:
  explicit DepthDatabase(const fem::DepthTable& table);
  void fill_gaps(std::size_t shape);
  /// A curve's logarithm at the logarithm x of an indentation.
  [[nodiscard]] double log_at(const std::vector<double>& log_force, double x) const noexcept;
  [[nodiscard]] std::size_t index(std::size_t shape,
                                  std::size_t depth,
                                  std::size_t radius,
                                  std::size_t ratio) const noexcept;

  fem::DepthGrid grid_;
  std::vector<double> depth_axis_;        ///< [-], log of m
  std::vector<double> radius_axis_;       ///< [-], log of m
  std::vector<double> ratio_axis_;        ///< [-]
  std::vector<double> indentation_axis_;  ///< [-], log of m
  std::vector<double> log_plain_;         ///< [-], log of N
  std::vector<double> log_excess_;        ///< [-], by shape, depth, radius, ratio, indentation
  std::vector<std::size_t> solved_;       ///< indentations of each member that were solved
  std::optional<LateralShape> beside_;
};

/// The database that comes with the program.
[[nodiscard]] Result<DepthDatabase> default_database();
/// Another one.
[[nodiscard]] Result<DepthDatabase> load_database(const std::string& path);

}  // namespace palp::depth
