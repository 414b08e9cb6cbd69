#include "fem/database_builder.h"

#include <algorithm>
#include <cmath>

#include "fem/dense_solver.h"
#include "fem/finite_contact.h"

namespace palp::fem {
namespace {

constexpr double kSqueeze = 0.8;  // of the cover
constexpr int kSmoothTerms = 5;   // of the polynomial below

std::vector<double> forces(const Mesh& mesh,
                           const Specimen& specimen,
                           const std::vector<double>& indentations,
                           double limit) {
  std::vector<double> out;
  FiniteContact contact{mesh, specimen};
  for (const double indentation : indentations) {
    if (indentation > limit) break;
    const auto row = contact.press(indentation);
    if (!row) break;
    out.push_back(row->force);
  }
  return out;
}

/// log(excess) over log(indentation) is nearly a straight line; what a polynomial of fourth degree
/// does not follow is the contact's edge crossing elements of the mesh.
void smooth(const std::vector<double>& indentations, std::vector<float>& excess) {
  const auto count = static_cast<Eigen::Index>(excess.size());
  if (count < kSmoothTerms + 2) return;
  Eigen::MatrixXd powers(count, kSmoothTerms);
  Eigen::VectorXd values(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    // The excess of a shallow indentation is noisier: its contact has few elements.
    const double weight = std::sqrt(indentations[k] / indentations[0]);
    const double t = std::log(indentations[k] / indentations[0]);
    for (int p = 0; p < kSmoothTerms; ++p) powers(i, p) = weight * std::pow(t, p);
    values[i] = weight * std::log(static_cast<double>(excess[k]));
  }
  const Eigen::VectorXd c = least_squares(powers, values);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double t = std::log(indentations[k] / indentations[0]);
    double sum = 0;
    for (int p = kSmoothTerms; p-- > 0;) sum = sum * t + c[p];
    excess[k] = static_cast<float>(std::exp(sum));
  }
}

}  // namespace

Specimen specimen_of(
    const DepthGrid& grid, InclusionShape shape, double depth, double radius, double ratio) {
  Specimen specimen;
  specimen.block = grid.block;
  specimen.indenter.radius = grid.indenter_radius;
  specimen.inclusion = {.shape = shape,
                        .depth = depth,
                        .radius = radius,
                        .height = kCylinderHeightOverRadius * radius,
                        .ratio = ratio,
                        .poisson = grid.inclusion_poisson};
  return specimen;
}

std::vector<GridCell> cells_of(const DepthGrid& grid) {
  std::vector<GridCell> cells;
  for (const InclusionShape shape : {InclusionShape::Ball, InclusionShape::Cylinder}) {
    for (std::uint32_t i = 0; i < grid.depths.size(); ++i) {
      for (std::uint32_t j = 0; j < grid.radii.size(); ++j) {
        if (!check(specimen_of(grid, shape, grid.depths[i], grid.radii[j], 10))) continue;
        cells.push_back({shape, i, j});
      }
    }
  }
  return cells;
}

double indentation_limit(const DepthGrid& grid, double depth) {
  return std::min(kSqueeze * depth * (1 + 1e-9), grid.indentations.back());
}

std::vector<DepthMember> solve_cell(const DepthGrid& grid,
                                    const GridCell& cell,
                                    Accuracy accuracy) {
  const double depth = grid.depths[cell.depth];
  const double limit = indentation_limit(grid, depth);
  Specimen specimen = specimen_of(grid, cell.shape, depth, grid.radii[cell.radius], 1);
  specimen.inclusion.poisson = grid.block.poisson;
  const Mesh mesh = make_mesh(specimen, accuracy);
  const std::vector<double> plain = forces(mesh, specimen, grid.indentations, limit);
  specimen.inclusion.poisson = grid.inclusion_poisson;
  std::vector<DepthMember> members;
  for (std::uint32_t k = 0; k < grid.ratios.size(); ++k) {
    specimen.inclusion.ratio = grid.ratios[k];
    const std::vector<double> with = forces(mesh, specimen, grid.indentations, limit);
    DepthMember member{cell.shape, cell.depth, cell.radius, k, {}};
    for (std::size_t i = 0; i < std::min(with.size(), plain.size()); ++i) {
      const double excess = with[i] / plain[i] - 1;
      if (!(excess > 0)) break;
      member.excess.push_back(static_cast<float>(excess));
    }
    smooth(grid.indentations, member.excess);
    members.push_back(std::move(member));
  }
  return members;
}

Result<std::vector<double>> solve_plain(const DepthGrid& grid) {
  CurveRequest request;
  request.specimen = specimen_of(grid, InclusionShape::None, 10e-3, 5e-3, 10);
  request.model = Model::NeoHookean;
  request.accuracy = Accuracy::Fine;
  request.indentations = grid.indentations;
  request.with_error = false;
  const auto curve = solve_curve(request);
  if (!curve) return tl::unexpected<Error>(curve.error());
  std::vector<double> out;
  for (const CurveRow& row : curve->rows) out.push_back(row.force);
  return out;
}

}  // namespace palp::fem
