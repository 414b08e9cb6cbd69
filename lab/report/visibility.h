#pragma once

#include <string>
#include <vector>

#include "common/config/command_line.h"
#include "depth/depth_database.h"
#include "lab/plan/depth_bound.h"

namespace palp::lab {

/// `palp-lab visible`: the smallest ball that differs from plain tissue by so many standard
/// deviations, by depth and stiffness ratio. What the sensor allows, whoever estimates.
struct VisibilityFlags {
  std::uint64_t taps{4};
  std::uint64_t reference_taps{4};
  double indentation_mm{4};
  double deviations{5};  ///< [-], standard deviations
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

/// `deviations` [-]: by so many standard deviations a ball differs that is seen.
[[nodiscard]] Visibility visibility(const depth::DepthDatabase& database,
                                    const TapPlan& plan,
                                    double deviations);
[[nodiscard]] std::string visibility_text(const Visibility& visibility);

void declare_visible(config::CommandLine& line, VisibilityFlags& flags);
[[nodiscard]] config::ExitStatus run_visible(const VisibilityFlags& flags);

}  // namespace palp::lab
