#pragma once

#include <string>
#include <vector>

#include "common/config/command_line.h"
#include "fem/depth_database.h"
#include "lab/plan/depth_bound.h"

namespace palp::lab {

/// `palp-lab visible`: the smallest ball that differs from plain tissue by five standard
/// deviations, by depth and stiffness ratio. What the sensor allows, whoever estimates.
struct VisibilityFlags {
  std::uint64_t taps{4};
  std::uint64_t reference_taps{4};
  double indentation_mm{4};
  std::string report{};
};

struct Visibility {
  std::vector<double> depths;  ///< [m]
  std::vector<double> ratios;  ///< [-]
  /// [m], by depth, then ratio: 0 where even the largest ball is not seen; the smallest ball of the
  /// database where that is seen.
  std::vector<std::vector<double>> radii;
  double radius_min{};  ///< [m], of the database
};

[[nodiscard]] Visibility visibility(const fem::DepthDatabase& database, const TapPlan& plan);
[[nodiscard]] std::string visibility_text(const Visibility& visibility);

void declare_visible(config::CommandLine& line, VisibilityFlags& flags);
[[nodiscard]] config::ExitStatus run_visible(const VisibilityFlags& flags);

}  // namespace palp::lab
