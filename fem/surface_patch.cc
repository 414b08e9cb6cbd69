#include "fem/surface_patch.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include "common/core/conventions.h"
#include "fem/dense_solver.h"
#include "fem/figure_text.h"

namespace palp::fem {
namespace {

constexpr int kPatchPassesMax = 60;  // of the active set; a handful is usual

}  // namespace

double love_sinking(double x, double y, double half) noexcept {
  const auto term = [](double along, double high, double low) {
    const double top = high + std::hypot(high, along);
    const double bottom = low + std::hypot(low, along);
    return along * std::log(top / bottom);
  };
  return (term(x + half, y + half, y - half) + term(y + half, x + half, x - half) +
          term(x - half, y - half, y + half) + term(y - half, x - half, x + half)) /
         std::numbers::pi;
}

SurfacePatch::SurfacePatch(double radius, double cell) : radius_{radius}, cell_{cell} {
  const int reach = static_cast<int>(std::floor(radius / cell));
  for (int row = 0; row <= reach; ++row) {
    for (int column = -reach; column <= reach; ++column) {
      if (std::hypot(row, column) * cell > radius) continue;
      cells_.push_back({column * cell, row * cell});
      columns_.push_back(column);
      rows_.push_back(row);
    }
  }
}

Eigen::MatrixXd SurfacePatch::half_space(double modulus) const {
  const int side = 2 * static_cast<int>(std::floor(radius_ / cell_)) + 1;
  Eigen::MatrixXd lattice(side, side);  // by the distance in cells
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      lattice(i, j) = love_sinking(i * cell_, j * cell_, 0.5 * cell_) / (cell_ * cell_ * modulus);
    }
  }
  const auto count = static_cast<Eigen::Index>(cells_.size());
  Eigen::MatrixXd out(count, count);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    for (std::size_t j = 0; j < cells_.size(); ++j) {
      const int along = std::abs(columns_[i] - columns_[j]);
      const double own = lattice(along, std::abs(rows_[i] - rows_[j]));
      const double image = lattice(along, rows_[i] + rows_[j]);
      out(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = 0.5 * (own + image);
    }
  }
  return out;
}

Result<SurfacePatch::Press> SurfacePatch::press(const Eigen::MatrixXd& compliance,
                                                const std::function<double(double r)>& profile,
                                                double indentation) const {
  if (!(indentation > 0)) return Press{};
  const std::string at = "at an indentation of " + length_text(indentation);
  const auto count = static_cast<Eigen::Index>(cells_.size());
  Eigen::VectorXd wanted(count);  // sinking in contact
  for (Eigen::Index i = 0; i < count; ++i) {
    const Cell& cell = cells_[static_cast<std::size_t>(i)];
    wanted[i] = indentation - profile(std::hypot(cell.x, cell.y));
  }
  std::vector<bool> active(cells_.size());
  // Hertz: contact ends where the profile is half the indentation.
  for (std::size_t i = 0; i < active.size(); ++i) {
    active[i] = wanted[static_cast<Eigen::Index>(i)] > 0.5 * indentation;
  }
  for (int pass = 0; pass < kPatchPassesMax; ++pass) {
    std::vector<Eigen::Index> on;
    for (Eigen::Index i = 0; i < count; ++i) {
      if (active[static_cast<std::size_t>(i)]) on.push_back(i);
    }
    const auto solution = solve_positive(compliance(on, on), wanted(on));
    if (!solution) break;
    Eigen::VectorXd force = Eigen::VectorXd::Zero(count);
    force(on) = *solution;
    const Eigen::VectorXd sunk = compliance * force;
    bool changed = false;
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const bool was = active[k];
      active[k] = was ? force[i] > 0 : wanted[i] - sunk[i] > 1e-9 * indentation;
      changed |= active[k] != was;
    }
    if (changed) continue;
    Press press{.force = force.sum()};
    for (const Eigen::Index i : on) {
      const Cell& cell = cells_[static_cast<std::size_t>(i)];
      if (std::hypot(cell.x, cell.y) + cell_ > radius_) {
        return fail("the contact reaches farther than " + length_text(radius_) +
                    " from the tip's axis " + at);
      }
      press.area += (cell.y > 0 ? 2 : 1) * cell_ * cell_;
    }
    return press;
  }
  return fail("the contact does not settle " + at);
}

}  // namespace palp::fem
