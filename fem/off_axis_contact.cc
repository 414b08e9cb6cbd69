#include "fem/off_axis_contact.h"

#include <cmath>
#include <vector>

#include "common/core/check.h"
#include "fem/linear_contact.h"

namespace palp::fem {
namespace {

// In tip radii. The cells reach beyond the tip, which no contact does; 0.3 mm under the paper's
// tip, where cells of 0.2 mm move F / F_plain by at most 5e-4.
constexpr double kPatchRadius = 1.07;
constexpr double kCell = 0.06;
constexpr double kFitted = 0.4;      // indentation at which the block's constant is right: 2 mm
constexpr double kClearance = 0.93;  // between the patch and the block's side
constexpr int kDepthPassesMax = 20;
constexpr double kDepthTolerance = 1e-6;  // of the force

double modulus_of(const Block& block) {
  return block.youngs_modulus / (1 - block.poisson * block.poisson);
}

/// With a constant c the tip at depth d presses a half space as at d - c F.
double fitted_constant(Specimen specimen) {
  specimen.inclusion.shape = InclusionShape::None;
  const double radius = specimen.indenter.radius;
  const double indentation = kFitted * radius;
  LinearContact contact{make_mesh(specimen, Accuracy::Normal), specimen, indentation};
  const auto press = contact.press(indentation);
  PALP_CHECK(press, "a plain block is pressed");
  const SneddonSphere half_space{.radius = radius, .modulus = modulus_of(specimen.block)};
  double low = 0;
  double high = 2 * radius;
  for (int pass = 0; pass < 60; ++pass) {
    const double middle = 0.5 * (low + high);
    (half_space.press(middle).force < press->force ? low : high) = middle;
  }
  return (indentation - low) / press->force;
}

}  // namespace

double offset_limit(const Specimen& specimen) noexcept {
  // A limit of whole millimetres must not be missed by its last bit.
  constexpr double kRounding = 1e-12;
  return specimen.block.half_width - (kPatchRadius + kClearance) * specimen.indenter.radius +
         kRounding;
}

OffAxisContact::OffAxisContact(const Specimen& specimen, double offset_max, Accuracy accuracy)
    : specimen_{specimen},
      patch_{kPatchRadius * specimen.indenter.radius, kCell * specimen.indenter.radius},
      block_constant_{fitted_constant(specimen)},
      plain_{patch_.half_space(modulus_of(specimen.block))} {
  PALP_CHECK(std::abs(offset_max) <= offset_limit(specimen), "offset_limit() has been asked");
  PALP_CHECK(specimen.indenter.shape == IndenterShape::Sphere, "the tip is a sphere");
  plain_.array() += block_constant_;
  if (specimen.inclusion.shape == InclusionShape::None) return;
  const double reach = std::abs(offset_max) + kPatchRadius * specimen.indenter.radius;
  kernel_.emplace(specimen, reach, accuracy);
}

Result<SurfacePatch::Press> OffAxisContact::press(const Eigen::MatrixXd& compliance,
                                                  double indentation) const {
  return patch_.press(
      compliance, [&](double r) { return specimen_.indenter.profile(r); }, indentation);
}

Result<double> OffAxisContact::plain_depth(double force, double guess) const {
  double depth = guess;
  for (int pass = 0; pass < kDepthPassesMax; ++pass) {
    const auto there = press(plain_, depth);
    if (!there) return tl::unexpected<Error>(there.error());
    const double off = force / there->force;
    depth *= std::pow(off, 1 / 1.5);  // Newton's method in logarithms: F goes about as depth^1.5
    if (std::abs(off - 1) < kDepthTolerance) break;
  }
  return depth;
}

SneddonSphere OffAxisContact::plain(double surface_curvature) const noexcept {
  return {.radius = specimen_.indenter.radius,
          .modulus = modulus_of(specimen_.block),
          .surface_curvature = surface_curvature,
          .constant = block_constant_};
}

void OffAxisContact::move_to(double offset) {
  if (offset_ == offset) return;
  std::vector<SurfacePoint> points;
  for (const SurfacePatch::Cell& cell : patch_.cells()) {
    const double x = offset + cell.x;
    points.push_back({std::hypot(x, cell.y), std::atan2(cell.y, x)});
  }
  compliance_ = plain_ + kernel_->mirrored(points);
  offset_ = offset;
}

Result<double> OffAxisContact::excess(double indentation, double offset) {
  if (!kernel_) return 0;
  move_to(offset);
  const auto with = press(compliance_, indentation);
  if (!with) return tl::unexpected<Error>(with.error());
  auto depth = plain_depth(with->force, indentation);
  if (!depth) return depth;
  return std::log(plain(0).press(*depth).force / plain(0).press(indentation).force);
}

}  // namespace palp::fem
