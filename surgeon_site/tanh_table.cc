#include "surgeon_site/tanh_table.h"

#include <cmath>

namespace palp::surgeon {

TanhTable::TanhTable() noexcept {
  for (std::size_t i = 0; i < kNodeCount; ++i) {
    nodes_[i] = std::tanh(static_cast<double>(i) / kNodesPerUnit);
  }
}

double TanhTable::operator()(double argument) const noexcept {
  const double size = std::abs(argument);
  if (!(size < kEnd)) return std::copysign(1.0, argument);
  const double place = size * kNodesPerUnit;
  const auto left = static_cast<std::size_t>(place);
  const double u = place - static_cast<double>(left);
  const double y0 = nodes_[left];
  const double y1 = nodes_[left + 1];
  const double m0 = (1 - y0 * y0) / kNodesPerUnit;  // tanh' = 1 - tanh^2, per node step
  const double m1 = (1 - y1 * y1) / kNodesPerUnit;
  const double rise = y1 - y0;
  const double value = y0 + u * (m0 + u * (3 * rise - 2 * m0 - m1 + u * (m0 + m1 - 2 * rise)));
  return std::copysign(value, argument);
}

}  // namespace palp::surgeon
