#include "fem/shape_builder.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/core/conventions.h"
#include "fem/off_axis_contact.h"

namespace palp::fem {
namespace {

constexpr double kSqueezeMax = 0.8;  // of the cover
constexpr double kShapeMin = 1e-4;   // what is less is noise of the cells

Specimen ball_in(const DepthGrid& grid, double depth, double radius, double ratio) {
  Specimen specimen;
  specimen.block = grid.block;
  specimen.indenter.radius = grid.indenter_radius;
  specimen.inclusion = {.shape = InclusionShape::Ball,
                        .depth = depth,
                        .radius = radius,
                        .ratio = ratio,
                        .poisson = grid.inclusion_poisson};
  return specimen;
}

}  // namespace

ShapeTable shape_axes() {
  ShapeTable axes;
  constexpr int kDepths = 12;
  for (int i = 0; i < kDepths; ++i) axes.depths.push_back(3e-3 * std::pow(9.0, i / 11.0));
  for (const double mm : {3.0, 4.0, 5.2, 6.8, 8.8, 11.0, 13.5, 16.0}) {
    axes.radii.push_back(mm * kMillimetre);
  }
  axes.ratios = {3, 20, 900};
  axes.offsets = {0.1, 0.2, 0.3, 0.4, 0.5, 0.65, 0.8, 1, 1.25, 1.5, 2, 2.5, 3};
  axes.indentations = {0.5e-3, 1.5e-3, 3e-3, 5e-3};
  return axes;
}

Result<std::vector<float>> solve_shape(const DepthGrid& grid,
                                       const ShapeTable& axes,
                                       std::size_t depth,
                                       std::size_t radius,
                                       std::size_t ratio,
                                       Accuracy accuracy) {
  const double top = axes.depths[depth];
  std::size_t fits = radius;
  while (fits > 0 && !check(ball_in(grid, top, axes.radii[fits], axes.ratios[ratio]))) --fits;
  const Specimen specimen = ball_in(grid, top, axes.radii[fits], axes.ratios[ratio]);
  if (auto ok = check(specimen); !ok) return tl::unexpected<Error>(ok.error());
  const double middle = top + axes.radii[fits];
  const double most = std::min(offset_limit(specimen), axes.offsets.back() * middle);
  OffAxisContact contact{specimen, most, accuracy};
  std::vector<float> out(axes.ball_size());
  for (std::size_t j = 0; j < axes.indentations.size(); ++j) {
    const double indentation = std::min(axes.indentations[j], kSqueezeMax * top);
    const auto above = contact.excess(indentation, 0);
    if (!above) return tl::unexpected<Error>(above.error());
    double fall = 0;
    for (std::size_t i = 0; i < axes.offsets.size(); ++i) {
      const double s = axes.offsets[i];
      if (s * middle <= most * (1 + 1e-9)) {
        const auto beside = contact.excess(indentation, std::min(s * middle, most));
        if (!beside) return tl::unexpected<Error>(beside.error());
        fall = -std::log(std::clamp(*beside / *above, kShapeMin, 1 - kShapeMin)) / (s * s);
      }
      out[i * axes.indentations.size() + j] =
          static_cast<float>(std::max(kShapeMin, std::exp(-fall * s * s)));
    }
  }
  return out;
}

Result<ShapeTable> solve_shape_table(const DepthGrid& grid, ShapeTable axes, Accuracy accuracy) {
  axes.shape.clear();
  for (std::size_t i = 0; i < axes.depths.size(); ++i) {
    for (std::size_t j = 0; j < axes.radii.size(); ++j) {
      for (std::size_t k = 0; k < axes.ratios.size(); ++k) {
        const auto values = solve_shape(grid, axes, i, j, k, accuracy);
        if (!values) return tl::unexpected<Error>(values.error());
        axes.shape.insert(axes.shape.end(), values->begin(), values->end());
      }
    }
  }
  return axes;
}

}  // namespace palp::fem
