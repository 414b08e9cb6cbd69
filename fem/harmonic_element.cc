#include "fem/harmonic_element.h"

#include <cstddef>

#include "common/core/check.h"
#include "common/core/matrix3.h"

namespace palp::fem {
namespace {

constexpr std::size_t kZ = 9;     // first component along z
constexpr std::size_t kPhi = 18;  // first component along phi

/// Adds what keeps the volume, 2 mu dev e : dev e, of one point. With the derivatives a along r and
/// b along z and h = N / r of the shape functions the strains of a node are
///   e_rr = a u, e_zz = b w, e_pp = h (u + n v),
///   g_rz = b u + a w, g_rp = (a - h) v - n h u, g_zp = b v - n h w.
void add_shear(const ElementGeometry::Point& point, double shear, int order, HarmonicMatrix& k) {
  const double mu = point.volume * shear;
  const double same = 4.0 / 3 * mu;
  const double cross = -2.0 / 3 * mu;
  const double n = order;
  for (std::size_t i = 0; i < 9; ++i) {
    const double ai = point.dr[i];
    const double bi = point.dz[i];
    const double hi = point.hoop[i];
    for (std::size_t j = 0; j < 9; ++j) {
      const double aj = point.dr[j];
      const double bj = point.dz[j];
      const double hj = point.hoop[j];
      k[i][j] += same * (ai * aj + hi * hj) + cross * (ai * hj + hi * aj) +
                 mu * (n * n * hi * hj + bi * bj);
      k[kZ + i][j] += cross * bi * (aj + hj) + mu * ai * bj;
      k[kZ + i][kZ + j] += same * bi * bj + mu * (ai * aj + n * n * hi * hj);
      k[kPhi + i][j] += n * (cross * hi * aj + same * hi * hj - mu * (ai - hi) * hj);
      k[kPhi + i][kZ + j] += n * (cross * hi * bj - mu * bi * hj);
      k[kPhi + i][kPhi + j] += same * n * n * hi * hj + mu * ((ai - hi) * (aj - hj) + bi * bj);
    }
  }
}

}  // namespace

HarmonicMatrix harmonic_stiffness(const ElementGeometry& geometry,
                                  const Material& material,
                                  int order) {
  PALP_CHECK(order >= 0, "harmonics are counted from 0");
  HarmonicMatrix k{};
  std::array<std::array<double, 27>, 3> squeeze{};  // [m^3/m], moments of the divergence
  for (const ElementGeometry::Point& point : geometry.points) {
    add_shear(point, material.shear(), order, k);
    for (std::size_t m = 0; m < 3; ++m) {
      const double weight = point.volume * point.pressure[m];
      for (std::size_t i = 0; i < 9; ++i) {
        squeeze[m][i] += weight * (point.dr[i] + point.hoop[i]);
        squeeze[m][kZ + i] += weight * point.dz[i];
        squeeze[m][kPhi + i] += weight * order * point.hoop[i];
      }
    }
  }
  // The geometry's volume goes all round; the square of a cosine is half of it.
  const double round = order == 0 ? 1 : 0.5;
  for (std::size_t i = 0; i < k.size(); ++i) {
    Vector3 scaled{};
    for (std::size_t m = 0; m < 3; ++m) {
      for (std::size_t l = 0; l < 3; ++l) {
        scaled[m] += material.bulk() * geometry.mass_inverse[m][l] * squeeze[l][i];
      }
    }
    for (std::size_t j = 0; j <= i; ++j) {
      k[i][j] += scaled[0] * squeeze[0][j] + scaled[1] * squeeze[1][j] + scaled[2] * squeeze[2][j];
      k[i][j] *= round;
    }
  }
  return k;
}

}  // namespace palp::fem
