#include "depth/depth_database.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "common/core/check.h"
#include "common/core/conventions.h"
#include "common/core/formatted.h"
#include "common/core/whole_file.h"
#include "depth/axis_stencil.h"
#include "depth/embedded_database.h"

namespace palp::depth {
namespace {

constexpr std::size_t kShapes = 2;
constexpr double kAnyRatio = 10;      // whether an inclusion fits does not depend on it
constexpr double kFarExponent = 1.5;  // Hertz, where the table has no rows yet

std::size_t shape_index(fem::InclusionShape shape) {
  return shape == fem::InclusionShape::Cylinder ? 1 : 0;
}

std::string number(double value) { return formatted("%.4g", value); }

fem::Specimen specimen_of(const fem::DepthGrid& grid, const DepthDatabase::Query& query) {
  return {.block = grid.block,
          .inclusion = {.shape = query.shape,
                        .depth = query.depth,
                        .radius = query.radius,
                        .height = fem::kCylinderHeightOverRadius * query.radius,
                        .ratio = query.ratio,
                        .poisson = grid.inclusion_poisson},
          .indenter = {.radius = grid.indenter_radius}};
}

Result<void> in_range(const char* name,
                      double value,
                      const std::vector<double>& axis,
                      double unit,
                      const char* unit_name) {
  if (value >= axis.front() * (1 - 1e-9) && value <= axis.back() * (1 + 1e-9)) return {};
  return fail(std::string{name} + " is " + number(value / unit) + unit_name + ", expected " +
              number(axis.front() / unit) + " to " + number(axis.back() / unit) + unit_name +
              " (the depth database)");
}

}  // namespace

Result<DepthDatabase> DepthDatabase::make(const fem::DepthTable& table) {
  for (const fem::InclusionShape shape :
       {fem::InclusionShape::Ball, fem::InclusionShape::Cylinder}) {
    std::size_t wanted = 0;  // what does not fit into the block is missing, and no more
    for (const double depth : table.grid.depths) {
      for (const double radius : table.grid.radii) {
        const Query query{.shape = shape, .depth = depth, .radius = radius, .ratio = kAnyRatio};
        if (fem::check(specimen_of(table.grid, query))) wanted += table.grid.ratios.size();
      }
    }
    const auto count = static_cast<std::size_t>(std::count_if(
        table.members.begin(), table.members.end(), [&](const fem::DepthMember& member) {
          return member.shape == shape;
        }));
    if (count < wanted) {
      return fail("the depth database is unfinished: " + std::to_string(count) + " of " +
                  std::to_string(wanted) + " members of shape " + std::string{to_string(shape)});
    }
  }
  return DepthDatabase{table};
}

DepthDatabase::DepthDatabase(const fem::DepthTable& table) : grid_{table.grid} {
  const auto log_of = [](const std::vector<double>& values) {
    std::vector<double> out;
    out.reserve(values.size());
    for (const double value : values) out.push_back(std::log(value));
    return out;
  };
  depth_axis_ = log_of(grid_.depths);
  radius_axis_ = log_of(grid_.radii);
  indentation_axis_ = log_of(grid_.indentations);
  log_plain_ = log_of(table.plain);
  for (const double ratio : grid_.ratios) ratio_axis_.push_back(ratio_coordinate(ratio));
  const std::size_t members =
      kShapes * grid_.depths.size() * grid_.radii.size() * grid_.ratios.size();
  solved_.assign(members, 0);
  log_excess_.assign(members * indentation_axis_.size(), std::numeric_limits<double>::quiet_NaN());
  for (const fem::DepthMember& member : table.members) {
    const std::size_t at =
        index(shape_index(member.shape), member.depth, member.radius, member.ratio);
    solved_[at] = member.excess.size();
    for (std::size_t j = 0; j < member.excess.size(); ++j) {
      log_excess_[at * indentation_axis_.size() + j] =
          std::log(static_cast<double>(member.excess[j]));
    }
  }
  for (std::size_t shape = 0; shape < kShapes; ++shape) fill_gaps(shape);
  if (table.off_axis) beside_.emplace(*table.off_axis);
}

std::size_t DepthDatabase::index(std::size_t shape,
                                 std::size_t depth,
                                 std::size_t radius,
                                 std::size_t ratio) const noexcept {
  return ((shape * grid_.depths.size() + depth) * grid_.radii.size() + radius) *
             grid_.ratios.size() +
         ratio;
}

/// What could not be solved (no room, or squeezed too far) is extrapolated along the depth from the
/// two members beside it: a support for the slopes of what was solved, never an answer of its own.
void DepthDatabase::fill_gaps(std::size_t shape) {
  const std::size_t depths = grid_.depths.size();
  const std::size_t rows = indentation_axis_.size();
  const auto fill = [&](std::size_t radius, std::size_t ratio, std::size_t j) {
    const auto value = [&](std::size_t i) -> double& {
      return log_excess_[index(shape, i, radius, ratio) * rows + j];
    };
    const auto from_line = [&](std::size_t i, std::size_t a, std::size_t b) {
      const double t = (depth_axis_[i] - depth_axis_[a]) / (depth_axis_[b] - depth_axis_[a]);
      value(i) = value(a) + t * (value(b) - value(a));
    };
    for (std::size_t i = depths - 2; i-- > 0;) {
      if (std::isnan(value(i)) && !std::isnan(value(i + 2))) from_line(i, i + 1, i + 2);
    }
    for (std::size_t i = 2; i < depths; ++i) {
      if (std::isnan(value(i))) from_line(i, i - 1, i - 2);
    }
  };
  for (std::size_t radius = 0; radius < grid_.radii.size(); ++radius) {
    for (std::size_t ratio = 0; ratio < grid_.ratios.size(); ++ratio) {
      for (std::size_t j = 0; j < rows; ++j) fill(radius, ratio, j);
    }
  }
}

Result<void> DepthDatabase::contains(const Query& query, double block_height) const {
  for (const auto& ok :
       {in_range("the inclusion's depth", query.depth, grid_.depths, kMillimetre, " mm"),
        in_range("the inclusion's radius", query.radius, grid_.radii, kMillimetre, " mm"),
        in_range("the stiffness ratio", query.ratio, grid_.ratios, 1, "")}) {
    if (!ok) return ok;
  }
  fem::Specimen specimen = specimen_of(grid_, query);
  specimen.block.height = block_height;
  return fem::check(specimen);
}

DepthDatabase::Curve DepthDatabase::plain() const {
  return {.log_force = log_plain_, .indentation_max = grid_.indentations.back()};
}

DepthDatabase::Curve DepthDatabase::curve(const Query& query) const {
  const std::size_t rows = indentation_axis_.size();
  const std::size_t shape = shape_index(query.shape);
  const AxisStencil depth = axis_stencil(depth_axis_, std::log(query.depth));
  const AxisStencil radius = axis_stencil(radius_axis_, std::log(query.radius));
  const AxisStencil ratio = axis_stencil(ratio_axis_, ratio_coordinate(query.ratio));
  Curve out;
  out.log_force.assign(rows, 0);
  for (std::size_t i = 0; i < depth.count; ++i) {
    for (std::size_t j = 0; j < radius.count; ++j) {
      const std::size_t from = index(shape, depth.first + i, radius.first + j, ratio.first);
      for (std::size_t k = 0; k < ratio.count; ++k) {
        const double weight = depth.weight[i] * radius.weight[j] * ratio.weight[k];
        const double* values = &log_excess_[(from + k) * rows];
        for (std::size_t row = 0; row < rows; ++row) out.log_force[row] += weight * values[row];
      }
    }
  }
  for (std::size_t row = 0; row < rows; ++row) {
    out.log_force[row] = log_plain_[row] + std::log1p(std::exp(out.log_force[row]));
  }
  // As far as both depths round the query were solved.
  const auto above =
      std::upper_bound(grid_.depths.begin() + 1, grid_.depths.end() - 1, query.depth);
  const auto cell = static_cast<std::size_t>(above - grid_.depths.begin()) - 1;
  std::size_t solved = rows;
  for (const std::size_t step : {std::size_t{0}, std::size_t{1}}) {
    for (std::size_t j = 0; j < radius.count; ++j) {
      for (std::size_t k = 0; k < ratio.count; ++k) {
        const std::size_t here =
            solved_[index(shape, cell + step, radius.first + j, ratio.first + k)];
        if (here > 0) solved = std::min(solved, here);
      }
    }
  }
  out.indentation_max = grid_.indentations[solved - 1];
  return out;
}

double DepthDatabase::log_at(const std::vector<double>& log_force, double x) const noexcept {
  const AxisStencil at = axis_stencil(indentation_axis_, x);
  double sum = 0;
  for (std::size_t i = 0; i < at.count; ++i) sum += at.weight[i] * log_force[at.first + i];
  return sum;
}

double DepthDatabase::force(const Curve& curve, double indentation) const noexcept {
  if (!(indentation > 0)) return 0;
  const double x = std::log(indentation);
  if (x < indentation_axis_.front()) {
    return std::exp(curve.log_force.front() + kFarExponent * (x - indentation_axis_.front()));
  }
  return std::exp(log_at(curve.log_force, x));
}

double DepthDatabase::log_excess(const Curve& curve, double indentation) const noexcept {
  if (!(indentation > grid_.indentations.front()))
    return curve.log_force.front() - log_plain_.front();
  const double x = std::log(indentation);
  return log_at(curve.log_force, x) - log_at(log_plain_, x);
}

LateralShape::OfBall DepthDatabase::shape(const Query& ball) const {
  PALP_CHECK(beside_.has_value(), "solved_beside() has been asked");
  return beside_->of(ball.depth, ball.radius, ball.ratio);
}

double DepthDatabase::share(const LateralShape::OfBall& ball,
                            double offset,
                            double indentation) const noexcept {
  return beside_->share(ball, offset, indentation);
}

double DepthDatabase::log_excess(const Curve& curve,
                                 const LateralShape::OfBall& ball,
                                 double offset,
                                 double indentation) const noexcept {
  return log_excess(curve, indentation) * share(ball, offset, indentation);
}

Result<DepthDatabase> default_database() {
  const auto table = fem::parse_table(embedded_database());
  if (!table) return tl::unexpected<Error>(table.error());
  return DepthDatabase::make(*table);
}

Result<DepthDatabase> load_database(const std::string& path) {
  constexpr std::size_t kSizeMax = 256U << 20U;  // [bytes], a hundred times the shipped one
  const auto bytes = read_whole_file(path, kSizeMax);
  if (!bytes) return fail("depth database", bytes.error());
  const auto table = fem::parse_table(*bytes);
  if (!table) return fail(path + ": " + table.error().text);
  return DepthDatabase::make(*table);
}

}  // namespace palp::depth
