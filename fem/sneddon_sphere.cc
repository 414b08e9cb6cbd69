#include "fem/sneddon_sphere.h"

#include <cmath>

namespace palp::fem {

double SneddonSphere::force_at(double contact_radius) const noexcept {
  const double a = contact_radius;
  const double spread = 2 * std::atanh(a / radius);
  const double sphere = 0.5 * (a * a + radius * radius) * spread - a * radius;
  return modulus * (sphere + 4.0 / 3 * a * a * a * surface_curvature);
}

double SneddonSphere::indentation_at(double contact_radius) const noexcept {
  const double a = contact_radius;
  const double half_space = a * std::atanh(a / radius) + a * a * surface_curvature;
  return half_space + constant * force_at(a);
}

SneddonSphere::Press SneddonSphere::press(double indentation) const noexcept {
  double low = 0;
  double high = radius;
  for (int pass = 0; pass < 60; ++pass) {
    const double middle = 0.5 * (low + high);
    (indentation_at(middle) < indentation ? low : high) = middle;
  }
  return {.force = force_at(low), .contact_radius = low};
}

}  // namespace palp::fem
