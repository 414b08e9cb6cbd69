#include "fem/off_axis_curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "common/core/conventions.h"
#include "fem/figure_text.h"
#include "fem/off_axis_contact.h"

namespace palp::fem {
namespace {

constexpr double kTiltMax = 20 * std::numbers::pi / 180;  // farther nothing was compared
constexpr double kCurvatureMax = 0.25;                    // per tip radius
constexpr double kBlockMin = 5;                           // tip radii, of its height and width
constexpr double kLastShareMax = 1e-3;                    // of the harmonics that are left out
constexpr double kNoExcess = 1e-9;                        // ln F of a ball as soft as the block

std::string in_deg(double angle) { return figure_text(angle * 180 / std::numbers::pi) + " deg"; }

double walked(const Approach& approach, double indentation) {
  return std::abs(approach.offset + indentation * std::sin(approach.tilt));
}

Result<void> check_approach(const CurveRequest& request, const Approach& approach) {
  const Specimen& specimen = request.specimen;
  if (auto ok = check(specimen); !ok) return ok;
  const InclusionShape shape = specimen.inclusion.shape;
  if (shape != InclusionShape::None && shape != InclusionShape::Ball) {
    return fail("beside the axis the inclusion is a ball or none, not a " +
                std::string{to_string(shape)});
  }
  if (specimen.indenter.shape != IndenterShape::Sphere) {
    return fail("beside the axis the tip is a sphere");
  }
  const double radius = specimen.indenter.radius;
  const double smaller = std::min(specimen.block.height, specimen.block.half_width);
  if (!(smaller >= kBlockMin * radius)) {
    return fail("the block's height or half width is " + length_text(smaller) +
                ", expected at least " + length_text(kBlockMin * radius) + " beside the axis");
  }
  if (!(std::abs(approach.tilt) <= kTiltMax * (1 + 1e-9))) {
    return fail("the tilt is " + in_deg(approach.tilt) + ", expected at most " + in_deg(kTiltMax) +
                " either way");
  }
  if (!(std::abs(approach.surface_curvature) <= kCurvatureMax / radius * (1 + 1e-9))) {
    return fail("the surface's radius is " + length_text(1 / approach.surface_curvature) +
                ", expected at least " + length_text(radius / kCurvatureMax) + " either way");
  }
  double farthest = std::abs(approach.offset);
  for (const double indentation : request.indentations) {
    farthest = std::max(farthest, walked(approach, indentation));
  }
  if (!(farthest <= offset_limit(specimen))) {
    return fail("the tip is " + length_text(farthest) + " beside the axis, expected at most " +
                length_text(offset_limit(specimen)));
  }
  return {};
}

/// Axisymmetric curves along the normal: with the ball, and without it on the same mesh.
struct AxisCurves {
  std::vector<CurveRow> with;
  std::vector<CurveRow> without;
};

Result<AxisCurves> solve_axis(CurveRequest request, double cosine) {
  for (double& indentation : request.indentations) indentation *= cosine;
  auto with = solve_curve(request);
  if (!with) return tl::unexpected<Error>(with.error());
  AxisCurves out{.with = std::move(with->rows), .without = {}};
  if (request.specimen.inclusion.shape == InclusionShape::None) {
    out.without = out.with;
    return out;
  }
  request.specimen.inclusion.ratio = 1;
  request.specimen.inclusion.poisson = request.specimen.block.poisson;
  request.with_error = false;
  auto without = solve_curve(request);
  if (!without) return tl::unexpected<Error>(without.error());
  out.without = std::move(without->rows);
  return out;
}

/// Part of the ball's effect that is left `offset` beside its axis. [-]
Result<double> shape_of(OffAxisContact& contact, double indentation, double offset) {
  if (offset == 0) return 1;
  auto above = contact.excess(indentation, 0);
  if (!above) return above;
  if (std::abs(*above) < kNoExcess) return 0;
  auto beside = contact.excess(indentation, offset);
  if (!beside) return beside;
  return *beside / *above;
}

}  // namespace

Result<std::vector<CurveRow>> solve_off_axis_curve(const CurveRequest& request,
                                                   const Approach& approach) {
  if (auto ok = check_approach(request, approach); !ok) return tl::unexpected<Error>(ok.error());
  const double cosine = std::cos(approach.tilt);
  const auto axis = solve_axis(request, cosine);
  if (!axis) return tl::unexpected<Error>(axis.error());
  double farthest = 0;
  for (const double d : request.indentations) farthest = std::max(farthest, walked(approach, d));
  OffAxisContact contact{request.specimen, farthest, request.accuracy};
  if (contact.last_share() > kLastShareMax) {
    return fail("a ball of radius " + length_text(request.specimen.inclusion.radius) + " is " +
                length_text(request.specimen.inclusion.depth) +
                " below the surface, expected deeper: its harmonics do not settle");
  }
  std::vector<CurveRow> rows;
  for (std::size_t i = 0; i < request.indentations.size(); ++i) {
    const double indentation = request.indentations[i];
    CurveRow row{.indentation = indentation};
    if (indentation > 0) {
      const double normal = indentation * cosine;
      const CurveRow& with = axis->with[i];
      const CurveRow& without = axis->without[i];
      const auto shape = shape_of(contact, normal, walked(approach, indentation));
      if (!shape) return tl::unexpected<Error>(shape.error());
      const auto curved = contact.plain(approach.surface_curvature).press(normal);
      const auto flat = contact.plain(0).press(normal);
      // The plain force times the ball's factor to the power g.
      const double force = without.force * std::pow(with.force / without.force, *shape);
      row.force = cosine * force * curved.force / flat.force;
      row.error = row.force * with.error / with.force;
      row.contact_radius = without.contact_radius *
                           std::pow(with.contact_radius / without.contact_radius, *shape) *
                           curved.contact_radius / flat.contact_radius;
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace palp::fem
