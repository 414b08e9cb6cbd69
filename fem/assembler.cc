#include "fem/assembler.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <Eigen/OrderingMethods>

#include "common/core/check.h"

namespace palp::fem {

Assembler::Assembler(const Mesh& mesh,
                     const std::vector<Material>& materials,
                     const std::vector<bool>& fixed,
                     const std::vector<int>& last)
    : equation_(2 * mesh.nodes.size(), -1) {
  PALP_CHECK(fixed.size() == equation_.size(), "one flag per displacement component");
  std::vector<bool> free(fixed.size());
  for (const Element& element : mesh.elements) {
    std::array<int, 18>& components = components_.emplace_back();
    for (std::size_t k = 0; k < 9; ++k) {
      components[k] = r_of(element.nodes[k]);
      components[k + 9] = z_of(element.nodes[k]);
    }
    for (const int component : components) {
      const auto i = static_cast<std::size_t>(component);
      free[i] = !fixed[i];
    }
    material_.push_back(materials.at(static_cast<std::size_t>(element.material)));
    geometry_.push_back(make_geometry(mesh, element));
  }
  number(free, last);
  lay_pattern();
  lay_places();
}

void Assembler::number(const std::vector<bool>& free, const std::vector<int>& last) {
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (free[i]) equation_[i] = equations_++;
  }
  lay_pattern();
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int> minimum_degree;
  minimum_degree(with_clique(last).selfadjointView<Eigen::Lower>(), order);
  const auto inverse = order.inverse().eval();
  std::vector<int> component_at(static_cast<std::size_t>(equations_));
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (free[i]) component_at[static_cast<std::size_t>(inverse.indices()[equation_[i]])] = int(i);
  }
  std::vector<bool> at_end(free.size());
  std::vector<int> end;
  for (const int node : last) {
    for (const int component : {r_of(node), z_of(node)}) {
      const auto i = static_cast<std::size_t>(component);
      if (free[i]) end.push_back(component);
      at_end[i] = true;
    }
  }
  int next = 0;
  for (const int component : component_at) {
    const auto i = static_cast<std::size_t>(component);
    if (!at_end[i]) equation_[i] = next++;
  }
  for (const int component : end) equation_[static_cast<std::size_t>(component)] = next++;
}

/// The pattern, and every component of the nodes `last` beside every other: what is left of the
/// graph when all else has been eliminated. Ordered so, the rest does not fill the way to them.
SparseMatrix Assembler::with_clique(const std::vector<int>& last) const {
  std::vector<Eigen::Triplet<double>> entries;
  for (int column = 0; column < equations_; ++column) {
    for (SparseMatrix::InnerIterator it{pattern_, column}; it; ++it) {
      entries.emplace_back(static_cast<int>(it.row()), column, 1);
    }
  }
  std::vector<int> members;
  for (const int node : last) {
    for (const int component : {r_of(node), z_of(node)}) {
      if (equation(component) >= 0) members.push_back(equation(component));
    }
  }
  for (const int i : members) {
    for (const int j : members) {
      if (i > j) entries.emplace_back(i, j, 1);
    }
  }
  SparseMatrix graph{equations_, equations_};
  graph.setFromTriplets(entries.begin(), entries.end());
  return graph;
}

void Assembler::lay_pattern() {
  std::vector<std::vector<int>> columns(static_cast<std::size_t>(equations_));
  for (const std::array<int, 18>& components : components_) {
    for (const int i : components) {
      const int column = equation(i);
      if (column < 0) continue;
      for (const int j : components) {
        if (equation(j) >= column) columns[static_cast<std::size_t>(column)].push_back(equation(j));
      }
    }
  }
  pattern_.resize(equations_, equations_);
  for (int column = 0; column < equations_; ++column) {
    std::vector<int>& rows = columns[static_cast<std::size_t>(column)];
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    pattern_.startVec(column);
    for (const int row : rows) pattern_.insertBack(row, column) = 0;
  }
  pattern_.finalize();
}

void Assembler::lay_places() {
  places_.resize(components_.size());
  for (std::size_t e = 0; e < components_.size(); ++e) {
    std::size_t slot = 0;
    for (std::size_t i = 0; i < 18; ++i) {
      for (std::size_t j = 0; j <= i; ++j, ++slot) {
        const int a = equation(components_[e][i]);
        const int b = equation(components_[e][j]);
        places_[e][slot] = -1;
        if (a < 0 || b < 0) continue;
        const int* begin = pattern_.innerIndexPtr() + pattern_.outerIndexPtr()[std::min(a, b)];
        const int* end = pattern_.innerIndexPtr() + pattern_.outerIndexPtr()[std::min(a, b) + 1];
        const int* place = std::lower_bound(begin, end, std::max(a, b));
        places_[e][slot] = static_cast<int>(place - pattern_.innerIndexPtr());
      }
    }
  }
}

ElementVector Assembler::gather(std::size_t element, const Eigen::VectorXd& from) const {
  ElementVector out{};
  for (std::size_t i = 0; i < 18; ++i) out[i] = from[components_[element][i]];
  return out;
}

template <typename Respond>
Assembler::Result Assembler::add_up(const Respond& respond_of,
                                    SparseMatrix& tangent,
                                    Eigen::VectorXd& force) const {
  Result result;
  std::fill(tangent.valuePtr(), tangent.valuePtr() + tangent.nonZeros(), 0.0);
  force.setZero(components());
  for (std::size_t e = 0; e < components_.size(); ++e) {
    const ElementResponse response = respond_of(e);
    result.volume_ratio_min = std::min(result.volume_ratio_min, response.volume_ratio_min);
    if (!(response.volume_ratio_min > 0)) return result;
    result.energy += response.energy;
    int slot = 0;
    for (std::size_t i = 0; i < 18; ++i) {
      force[components_[e][i]] += response.force[i];
      for (std::size_t j = 0; j <= i; ++j, ++slot) {
        const int place = places_[e][static_cast<std::size_t>(slot)];
        if (place < 0) continue;
        // Nodes that coincide meet twice on the diagonal.
        const bool twice = i != j && components_[e][i] == components_[e][j];
        tangent.valuePtr()[place] += (twice ? 2 : 1) * response.tangent[i][j];
      }
    }
  }
  return result;
}

Assembler::Result Assembler::assemble(Strain strain,
                                      const Eigen::VectorXd& displacement,
                                      SparseMatrix& tangent,
                                      Eigen::VectorXd& force) const {
  return add_up(
      [&](std::size_t e) {
        return respond(geometry_[e], material_[e], strain, gather(e, displacement));
      },
      tangent,
      force);
}

Assembler::Result Assembler::assemble(const Eigen::VectorXd& displacement,
                                      const std::vector<Pressure>& pressures,
                                      SparseMatrix& tangent,
                                      Eigen::VectorXd& force) const {
  return add_up(
      [&](std::size_t e) {
        return respond(geometry_[e], material_[e], gather(e, displacement), pressures[e]);
      },
      tangent,
      force);
}

std::vector<Pressure> Assembler::pressures_after(const Eigen::VectorXd& displacement,
                                                 const Eigen::VectorXd& step) const {
  std::vector<Pressure> out;
  out.reserve(geometry_.size());
  for (std::size_t e = 0; e < geometry_.size(); ++e) {
    out.push_back(
        pressure_after(geometry_[e], material_[e], gather(e, displacement), gather(e, step)));
  }
  return out;
}

Assembler::Result Assembler::balance(const Eigen::VectorXd& displacement,
                                     Eigen::VectorXd& force) const {
  Result result;
  force.setZero(components());
  for (std::size_t e = 0; e < components_.size(); ++e) {
    const ElementForces forces =
        internal_forces(geometry_[e], material_[e], gather(e, displacement));
    result.volume_ratio_min = std::min(result.volume_ratio_min, forces.volume_ratio_min);
    if (!(forces.volume_ratio_min > 0)) return result;
    result.energy += forces.energy;
    for (std::size_t i = 0; i < 18; ++i) force[components_[e][i]] += forces.force[i];
  }
  return result;
}

double Assembler::energy(const Eigen::VectorXd& displacement) const {
  double sum = 0;
  for (std::size_t e = 0; e < components_.size(); ++e) {
    sum += stored_energy(geometry_[e], material_[e], gather(e, displacement));
    if (sum == std::numeric_limits<double>::infinity()) return sum;
  }
  return sum;
}

std::vector<bool> bonded_base(const Mesh& mesh) {
  std::vector<bool> fixed(2 * mesh.nodes.size());
  const double tiny = 1e-9 * mesh.height;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const bool base = mesh.nodes[i].z <= -mesh.height + tiny;
    fixed[2 * i] = base || mesh.nodes[i].r < tiny;
    fixed[2 * i + 1] = base;
  }
  return fixed;
}

}  // namespace palp::fem
