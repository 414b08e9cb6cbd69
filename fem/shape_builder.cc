#include "fem/shape_builder.h"

#include <algorithm>
#include <cmath>
#include <vector>

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

Result<ShapeTable> solve_shape_table(const DepthGrid& grid,
                                     ShapeTable axes,
                                     Accuracy accuracy,
                                     const ForEach& for_each) {
  const std::size_t ratios = axes.ratios.size();
  std::vector<Result<std::vector<float>>> balls(axes.depths.size() * axes.radii.size() * ratios);
  for_each(balls.size(), [&](std::size_t i) {
    const std::size_t geometry = i / ratios;
    const std::size_t depth = geometry / axes.radii.size();
    const std::size_t radius = geometry % axes.radii.size();
    balls[i] = solve_shape(grid, axes, depth, radius, i % ratios, accuracy);
  });
  axes.shape.clear();
  for (const Result<std::vector<float>>& ball : balls) {
    if (!ball) return tl::unexpected<Error>(ball.error());
    axes.shape.insert(axes.shape.end(), ball->begin(), ball->end());
  }
  return axes;
}

}  // namespace palp::fem
