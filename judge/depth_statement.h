#pragma once

#include <optional>
#include <string>

#include "common/message/depth.h"

namespace palp::judge {

/// An estimate as reports print it: what does not apply is absent.
struct DepthStatement {
  DepthVerdict verdict{};
  std::optional<double> depth;     ///< [m]
  std::optional<double> low;       ///< [m], 95 % interval
  std::optional<double> high;      ///< [m]
  std::optional<double> stddev;    ///< [m]
  std::optional<double> excluded;  ///< [m], as DepthEstimate::depth_low of verdict None
  std::string says;                ///< for people
};
[[nodiscard]] DepthStatement statement_of(const DepthEstimate& estimate);

}  // namespace palp::judge
