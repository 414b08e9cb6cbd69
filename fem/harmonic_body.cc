#include "fem/harmonic_body.h"

#include <algorithm>
#include <cstddef>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>

#include "common/core/check.h"
#include "fem/trailing_block.h"

namespace palp::fem {
namespace {

constexpr std::size_t kComponents = 27;  // of an element
constexpr std::size_t kTriangle = kComponents * (kComponents + 1) / 2;

}  // namespace

HarmonicBody::HarmonicBody(const Mesh& mesh, const std::vector<int>& surface)
    : elements_{mesh.elements}, surface_{surface} {
  const double tiny = 1e-9 * mesh.height;
  for (const Node& node : mesh.nodes) {
    base_.push_back(node.z <= -mesh.height + tiny);
    axis_.push_back(node.r < tiny);
  }
  for (const Element& element : elements_) geometry_.push_back(make_geometry(mesh, element));
  order_nodes(mesh);
  for (int order = 0; order < 3; ++order) {
    layouts_[static_cast<std::size_t>(order)] = lay_out(order);
  }
}

/// Approximate minimum degree of the nodes: their components go together. The surface's nodes count
/// as all coupled, which they are once the rest is gone.
void HarmonicBody::order_nodes(const Mesh& mesh) {
  const auto count = static_cast<int>(mesh.nodes.size());
  std::vector<Eigen::Triplet<double>> pairs;
  const auto couple = [&](int a, int b) {
    if (a > b) pairs.emplace_back(a, b, 1);
  };
  for (const Element& element : elements_) {
    for (const int a : element.nodes) {
      for (const int b : element.nodes) couple(a, b);
    }
  }
  for (const int a : surface_) {
    for (const int b : surface_) couple(a, b);
  }
  for (int node = 0; node < count; ++node) pairs.emplace_back(node, node, 1);
  SparseMatrix graph{count, count};
  graph.setFromTriplets(pairs.begin(), pairs.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int> minimum_degree;
  minimum_degree(graph.selfadjointView<Eigen::Lower>(), order);
  std::vector<bool> last(mesh.nodes.size());
  for (const int node : surface_) last[static_cast<std::size_t>(node)] = true;
  for (int i = 0; i < count; ++i) {
    const int node = order.indices()[i];
    if (!last[static_cast<std::size_t>(node)]) sorted_.push_back(node);
  }
  sorted_.insert(sorted_.end(), surface_.begin(), surface_.end());
}

HarmonicBody::Layout HarmonicBody::lay_out(int order) const {
  Layout layout;
  layout.order = order;
  number(layout);
  lay_pattern(layout);
  return layout;
}

void HarmonicBody::number(Layout& layout) const {
  layout.places.resize(base_.size());
  std::vector<bool> on_surface(base_.size());
  for (const int node : surface_) on_surface[static_cast<std::size_t>(node)] = true;
  const auto give = [&](Place& place) { place.equation = layout.equations++; };
  for (const int node : sorted_) {
    const auto i = static_cast<std::size_t>(node);
    auto& [r, z, phi] = layout.places[i];
    if (base_[i]) continue;
    if (axis_[i]) {
      if (layout.order == 1) {  // a sideways shift: the same vector at every phi
        give(r);
        phi = {r.equation, -1};
      }
      if (layout.order == 0 && !on_surface[i]) give(z);
      continue;
    }
    give(r);
    if (!on_surface[i]) give(z);
    if (layout.order > 0) give(phi);  // order 0 without torsion
  }
  for (const int node : surface_) {
    const auto i = static_cast<std::size_t>(node);
    if (!base_[i] && !(axis_[i] && layout.order > 0)) give(layout.places[i][1]);
    layout.loaded.push_back(layout.places[i][1].equation);
  }
}

std::array<HarmonicBody::Place, 27> HarmonicBody::places_of(const Layout& layout,
                                                            const Element& element) {
  std::array<Place, kComponents> out{};
  for (std::size_t i = 0; i < kComponents; ++i) {
    out[i] = layout.places[static_cast<std::size_t>(element.nodes[i % 9])][i / 9];
  }
  return out;
}

void HarmonicBody::lay_pattern(Layout& layout) const {
  std::vector<std::vector<int>> columns(static_cast<std::size_t>(layout.equations));
  for (const Element& element : elements_) {
    const auto places = places_of(layout, element);
    for (const Place& column : places) {
      if (column.equation < 0) continue;
      for (const Place& row : places) {
        if (row.equation < column.equation) continue;
        columns[static_cast<std::size_t>(column.equation)].push_back(row.equation);
      }
    }
  }
  layout.pattern.resize(layout.equations, layout.equations);
  for (int column = 0; column < layout.equations; ++column) {
    std::vector<int>& rows = columns[static_cast<std::size_t>(column)];
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    layout.pattern.startVec(column);
    for (const int row : rows) layout.pattern.insertBack(row, column) = 0;
  }
  layout.pattern.finalize();
  layout.slots.reserve(elements_.size() * kTriangle);
  for (const Element& element : elements_) {
    const auto places = places_of(layout, element);
    for (std::size_t i = 0; i < kComponents; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        const int a = places[i].equation;
        const int b = places[j].equation;
        if (a < 0 || b < 0) {
          layout.slots.push_back(-1);
          continue;
        }
        const int* rows = layout.pattern.innerIndexPtr();
        const int* begin = rows + layout.pattern.outerIndexPtr()[std::min(a, b)];
        const int* end = rows + layout.pattern.outerIndexPtr()[std::min(a, b) + 1];
        layout.slots.push_back(
            static_cast<int>(std::lower_bound(begin, end, std::max(a, b)) - rows));
      }
    }
  }
}

SparseMatrix HarmonicBody::assemble(const Layout& layout,
                                    const std::vector<Material>& materials,
                                    int order) const {
  SparseMatrix matrix = layout.pattern;
  std::size_t entry = 0;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const auto places = places_of(layout, elements_[e]);
    const Material& material = materials.at(static_cast<std::size_t>(elements_[e].material));
    const HarmonicMatrix stiffness = harmonic_stiffness(geometry_[e], material, order);
    for (std::size_t i = 0; i < kComponents; ++i) {
      const Place& row = places[i];
      for (std::size_t j = 0; j <= i; ++j, ++entry) {
        const int slot = layout.slots[entry];
        if (slot < 0) continue;
        const Place& column = places[j];
        // Two components in one equation meet twice on the diagonal.
        const bool twice = i != j && row.equation == column.equation;
        matrix.valuePtr()[slot] += (twice ? 2 : 1) * row.sign * column.sign * stiffness[i][j];
      }
    }
  }
  return matrix;
}

Eigen::MatrixXd HarmonicBody::compliance(const std::vector<Material>& materials, int order) {
  PALP_CHECK(order >= 0, "harmonics are counted from 0");
  const Layout& layout = layouts_[static_cast<std::size_t>(std::min(order, 2))];
  using Factor = Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::NaturalOrdering<int>>;
  const Factor factor{assemble(layout, materials, order)};
  PALP_CHECK(factor.info() == Eigen::Success, "the stiffness of a bonded block is regular");
  const auto held = [](int equation) { return equation >= 0; };
  const auto size =
      static_cast<int>(std::count_if(layout.loaded.begin(), layout.loaded.end(), held));
  const Eigen::MatrixXd lower = trailing_block(factor.matrixL().nestedExpression(), size);
  const Eigen::MatrixXd half =
      lower.triangularView<Eigen::UnitLower>().solve(Eigen::MatrixXd::Identity(size, size));
  const Eigen::MatrixXd own =
      half.transpose() * factor.vectorD().tail(size).cwiseInverse().asDiagonal() * half;
  const auto count = static_cast<Eigen::Index>(surface_.size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(count, count);
  const int first = layout.equations - size;
  for (Eigen::Index i = 0; i < count; ++i) {
    const int row = layout.loaded[static_cast<std::size_t>(i)];
    if (row < 0) continue;
    for (Eigen::Index j = 0; j < count; ++j) {
      const int column = layout.loaded[static_cast<std::size_t>(j)];
      if (column >= 0) out(i, j) = own(row - first, column - first);
    }
  }
  return out;
}

}  // namespace palp::fem
