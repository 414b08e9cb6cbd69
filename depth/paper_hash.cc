#include "depth/paper_hash.h"

#include <cmath>

#include "common/core/conventions.h"

namespace palp::depth {

double hash(const Cubic& cubic) noexcept {
  return cubic.c[0] + cubic.c[1] + cubic.c[2] + cubic.c[3];
}

double depth_of_hash(double hash) noexcept {
  const double numerator = ((9008 * hash - 2124) * hash + 168.5) * hash - 4.372;  // paper eq. (3)
  return numerator / (hash - 0.05914) * kMillimetre;
}

HashVerdict judge_hash(double hash) noexcept {
  if (!std::isfinite(hash)) return {DepthVerdict::Invalid, DepthReason::HashOutOfRange, 0};
  if (hash < kHashMin) return {DepthVerdict::None, DepthReason::Ok, 0};
  if (hash > kHashMax) return {DepthVerdict::Invalid, DepthReason::HashOutOfRange, 0};
  return {DepthVerdict::Found, DepthReason::Ok, depth_of_hash(hash)};
}

}  // namespace palp::depth
