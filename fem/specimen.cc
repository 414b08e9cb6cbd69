#include "fem/specimen.h"

#include <cmath>
#include <limits>
#include <string>

#include "common/core/conventions.h"
#include "fem/figure_text.h"

namespace palp::fem {
namespace {

// What must stay between the inclusion and the next boundary, of the block's height or width: the
// mesh there would be slivers.
constexpr double kCoverMin = 0.004;

/// `value` in [low, high], shown in `scale`.
Result<void> in_range(
    const std::string& name, double value, double low, double high, const std::string& unit) {
  if (value >= low && value <= high) return {};
  return fail(name + " is " + figure_text(value) + ", expected " + figure_text(low) + " to " +
              figure_text(high) + (unit.empty() ? "" : " " + unit));
}

Result<void> check_poisson(const std::string& name, double poisson) {
  // Beyond 0.49999 the mixed form is still stable, but the condition number eats the digits.
  if (poisson >= 0 && poisson <= 0.49999) return {};
  return fail(name + " is " + figure_text(poisson) + ", expected 0 to 0.49999 (below 0.5)");
}

Result<void> check_inclusion(const Block& block, const Inclusion& inclusion) {
  if (inclusion.shape == InclusionShape::None) return {};
  const double cover = kCoverMin * block.height;
  if (!(inclusion.depth >= cover)) {
    return fail("the depth of the inclusion's top is " + length_text(inclusion.depth) +
                ", expected at least " + length_text(cover));
  }
  if (!(inclusion.radius > 0)) {
    return fail("the inclusion's radius is " + length_text(inclusion.radius) +
                ", expected above 0");
  }
  const double wide = block.half_width * (1 - 0.02);
  if (!(inclusion.radius <= wide)) {
    return fail("the inclusion's radius is " + length_text(inclusion.radius) +
                ", expected at most " + length_text(wide) + " in a block of half width " +
                length_text(block.half_width));
  }
  if (inclusion.shape == InclusionShape::Cylinder && !(inclusion.height > 0)) {
    return fail("the cylinder's height is " + length_text(inclusion.height) + ", expected above 0");
  }
  const double low = block.height - cover;
  const double bottom = inclusion.bottom(block.height);
  if (inclusion.shape == InclusionShape::Column ? !(inclusion.depth <= low) : !(bottom <= low)) {
    return fail("the inclusion reaches " + length_text(std::max(bottom, inclusion.depth)) +
                " below the surface, expected at most " + length_text(low) +
                " in a block of height " + length_text(block.height));
  }
  if (auto ok = in_range("the stiffness ratio", inclusion.ratio, 1e-3, 1e5, ""); !ok) return ok;
  return check_poisson("the inclusion's Poisson's ratio", inclusion.poisson);
}

}  // namespace

double Inclusion::bottom(double block_height) const noexcept {
  switch (shape) {
    case InclusionShape::None:
      return 0;
    case InclusionShape::Ball:
      return depth + 2 * radius;
    case InclusionShape::Cylinder:
      return depth + height;
    case InclusionShape::Column:
      return block_height;
  }
  return 0;
}

double Indenter::profile(double r) const noexcept {
  constexpr double kBeyond = std::numeric_limits<double>::infinity();
  switch (shape) {
    case IndenterShape::Sphere:
      return r < radius ? radius - std::sqrt(radius * radius - r * r) : kBeyond;
    case IndenterShape::Paraboloid:
      return r * r / (2 * radius);
    case IndenterShape::FlatPunch:
      return r <= radius * (1 + 1e-9) ? 0 : kBeyond;
    case IndenterShape::Cone:
      return r * slope;
  }
  return kBeyond;
}

Result<void> check(const Specimen& specimen) {
  const Block& block = specimen.block;
  const double radius = specimen.indenter.radius;
  if (auto ok = in_range("the indenter's radius", radius / kMillimetre, 0.1, 100, "mm"); !ok) {
    return ok;
  }
  // The contact's mesh reaches to 1.2 radii and needs some block beyond.
  if (auto ok = in_range("the half width",
                         block.half_width / kMillimetre,
                         1.5 * radius / kMillimetre,
                         1e5 * radius / kMillimetre,
                         "mm");
      !ok) {
    return ok;
  }
  if (auto ok = in_range("the height",
                         block.height / kMillimetre,
                         0.2 * radius / kMillimetre,
                         1e5 * radius / kMillimetre,
                         "mm");
      !ok) {
    return ok;
  }
  if (auto ok = in_range("Young's modulus", block.youngs_modulus / 1e3, 1e-3, 1e9, "kPa"); !ok) {
    return ok;
  }
  if (auto ok = check_poisson("Poisson's ratio", block.poisson); !ok) return ok;
  return check_inclusion(block, specimen.inclusion);
}

}  // namespace palp::fem
