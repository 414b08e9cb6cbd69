#include "fem/vtu.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "common/core/conventions.h"
#include "common/core/formatted.h"
#include "fem/element.h"
#include "fem/linear_contact.h"

namespace palp::fem {
namespace {

constexpr int kBiquadraticQuad = 28;  // VTK's number of a nine-node quadrilateral
/// Its order of nodes: corners, middles of the sides, centre.
constexpr std::array<std::size_t, 9> kVtkOrder{0, 2, 8, 6, 1, 5, 7, 3, 4};

std::string digits(double value) { return formatted("%.9g", value); }

/// Equivalent of the Cauchy stress's deviator at F: from the isochoric part alone. Small strain
/// takes F = 1 + grad u to first order.
double von_mises(const Gradient& f, double shear, Model model) {
  std::array<double, 4> s{};  // rr, zz, hoop, rz
  if (model == Model::Linear) {
    const std::array<double, 3> strain{f[0] - 1, f[3] - 1, f[4] - 1};
    const double mean = (strain[0] + strain[1] + strain[2]) / 3;
    for (std::size_t i = 0; i < 3; ++i) s[i] = 2 * shear * (strain[i] - mean);
    s[3] = shear * (f[1] + f[2]);
  } else {
    const Isochoric part = isochoric(f, shear);
    const double j = volume_ratio(f);
    s = {(part.stress[0] * f[0] + part.stress[1] * f[1]) / j,
         (part.stress[2] * f[2] + part.stress[3] * f[3]) / j,
         part.stress[4] * f[4] / j,
         (part.stress[0] * f[2] + part.stress[1] * f[3]) / j};
  }
  return std::sqrt(1.5 * (s[0] * s[0] + s[1] * s[1] + s[2] * s[2] + 2 * s[3] * s[3]));
}

std::vector<double> node_stress(const Curve& curve, const Specimen& specimen, Model model) {
  const std::vector<Material> materials = materials_of(specimen);
  std::vector<double> sum(curve.mesh.nodes.size());
  std::vector<double> count(curve.mesh.nodes.size());
  for (const Element& element : curve.mesh.elements) {
    const ElementGeometry geometry = make_geometry(curve.mesh, element);
    ElementVector u{};
    for (std::size_t k = 0; k < 9; ++k) {
      const auto node = static_cast<std::size_t>(element.nodes[k]);
      u[k] = curve.field[2 * node];
      u[k + 9] = curve.field[2 * node + 1];
    }
    const double shear = materials[static_cast<std::size_t>(element.material)].shear();
    for (std::size_t k = 0; k < 9; ++k) {  // each node reads the quadrature point nearest to it
      const auto node = static_cast<std::size_t>(element.nodes[k]);
      sum[node] += von_mises(gradient_at(geometry.points[k], u), shear, model);
      count[node] += 1;
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] /= count[i] > 0 ? count[i] : 1;
  return sum;
}

void open_array(std::string& to, const std::string& type, const std::string& name, int components) {
  to += "        <DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
        std::to_string(components) + "\" format=\"ascii\">\n";
}
const char* const kCloseArray = "        </DataArray>\n";

void add_point_data(std::string& out, const Curve& curve, const Specimen& specimen, Model model) {
  out += "      <PointData Vectors=\"displacement_mm\">\n";
  open_array(out, "Float64", "displacement_mm", 3);
  for (std::size_t i = 0; i < curve.mesh.nodes.size(); ++i) {
    out += digits(curve.field[2 * i] / kMillimetre) + ' ' +
           digits(curve.field[2 * i + 1] / kMillimetre) + " 0\n";
  }
  out += kCloseArray;
  open_array(out, "Float64", "von_mises_kpa", 1);
  for (const double stress : node_stress(curve, specimen, model))
    out += digits(stress / 1e3) + '\n';
  out += kCloseArray;
  out += "      </PointData>\n";
}

void add_cells(std::string& out, const Mesh& mesh) {
  out += "      <Cells>\n";
  open_array(out, "Int32", "connectivity", 1);
  for (const Element& element : mesh.elements) {
    for (const std::size_t k : kVtkOrder) out += std::to_string(element.nodes[k]) + ' ';
    out += '\n';
  }
  out += kCloseArray;
  open_array(out, "Int32", "offsets", 1);
  for (std::size_t i = 1; i <= mesh.elements.size(); ++i) out += std::to_string(9 * i) + '\n';
  out += kCloseArray;
  open_array(out, "UInt8", "types", 1);
  for (std::size_t i = 0; i < mesh.elements.size(); ++i) {
    out += std::to_string(kBiquadraticQuad) + '\n';
  }
  out += kCloseArray;
  out += "      </Cells>\n";
}

}  // namespace

std::string vtu_text(const Curve& curve, const Specimen& specimen, Model model) {
  const Mesh& mesh = curve.mesh;
  std::string out =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
      "byte_order=\"LittleEndian\">\n  <UnstructuredGrid>\n";
  out += "    <Piece NumberOfPoints=\"" + std::to_string(mesh.nodes.size()) +
         "\" NumberOfCells=\"" + std::to_string(mesh.elements.size()) + "\">\n";
  add_point_data(out, curve, specimen, model);
  out += "      <CellData Scalars=\"material\">\n";
  open_array(out, "Int32", "material", 1);
  for (const Element& element : mesh.elements) out += std::to_string(element.material) + '\n';
  out += kCloseArray;
  out += "      </CellData>\n      <Points>\n";
  open_array(out, "Float64", "Points", 3);
  for (const Node& node : mesh.nodes) {
    out += digits(node.r / kMillimetre) + ' ' + digits(node.z / kMillimetre) + " 0\n";
  }
  out += kCloseArray;
  out += "      </Points>\n";
  add_cells(out, mesh);
  return out + "    </Piece>\n  </UnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace palp::fem
