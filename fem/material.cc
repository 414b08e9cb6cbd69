#include "fem/material.h"

#include <cmath>
#include <cstddef>

namespace palp::fem {

double volume_ratio(const Gradient& f) noexcept { return f[4] * (f[0] * f[3] - f[1] * f[2]); }

Gradient cofactor(const Gradient& f) noexcept {
  return {f[4] * f[3], -f[4] * f[2], -f[4] * f[1], f[4] * f[0], f[0] * f[3] - f[1] * f[2]};
}

GradientMatrix volume_curvature(const Gradient& f) noexcept {
  GradientMatrix h{};
  h[0][3] = h[3][0] = f[4];
  h[1][2] = h[2][1] = -f[4];
  h[0][4] = h[4][0] = f[3];
  h[3][4] = h[4][3] = f[0];
  h[1][4] = h[4][1] = -f[2];
  h[2][4] = h[4][2] = -f[1];
  return h;
}

Isochoric isochoric(const Gradient& f, double shear) noexcept {
  const double j = volume_ratio(f);
  const Gradient c = cofactor(f);
  const GradientMatrix h = volume_curvature(f);
  double i1 = 0;
  for (const double component : f) i1 += component * component;
  const double cube = std::cbrt(j);
  const double scale = shear / (cube * cube);
  Isochoric out;
  out.energy = 0.5 * (scale * i1 - 3 * shear);
  for (std::size_t i = 0; i < 5; ++i) {
    out.stress[i] = scale * (f[i] - i1 / (3 * j) * c[i]);
    for (std::size_t k = 0; k < 5; ++k) {
      out.tangent[i][k] =
          scale * ((i == k ? 1.0 : 0.0) - 2 / (3 * j) * (f[i] * c[k] + c[i] * f[k]) +
                   5 * i1 / (9 * j * j) * c[i] * c[k] - i1 / (3 * j) * h[i][k]);
    }
  }
  return out;
}

}  // namespace palp::fem
