#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "common/core/result.h"
#include "fem/mesh.h"
#include "fem/specimen.h"

namespace palp::fem {

/// L1: small strain, linearised Signorini contact. N: finite strain, neo-Hookean, contact of the
/// deformed surface. A force of one says nothing about the other: they differ by 2 to 5 %.
enum class Model { Linear, NeoHookean };

[[nodiscard]] constexpr std::string_view to_string(Model model) noexcept {
  return model == Model::Linear ? "l1" : "neo";
}

/// One point of a force-indentation curve.
struct CurveRow {
  double indentation{};     ///< [m]
  double force{};           ///< [N]
  double contact_radius{};  ///< [m], on the undeformed surface
  double error{};           ///< [N], of the mesh, estimated; 0: not asked for
};

/// Displacement of every node at one indentation: r, z, r, z, ... [m]
using Field = std::vector<double>;

struct CurveRequest {
  Specimen specimen;
  Model model{Model::Linear};
  Accuracy accuracy{Accuracy::Normal};
  std::vector<double> indentations;  ///< [m], in any order
  bool with_error{true};             ///< solves another mesh as well
};

struct Curve {
  std::vector<CurveRow> rows;  ///< in the order asked
  Mesh mesh;
  Field field;  ///< at the largest indentation [m]
  int equations{};
};

/// Solves one curve, or says in one sentence what cannot be.
[[nodiscard]] Result<Curve> solve_curve(const CurveRequest& request);

}  // namespace palp::fem
