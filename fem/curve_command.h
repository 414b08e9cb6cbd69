#pragma once

#include <string>

#include "common/config/command_line.h"
#include "fem/curve.h"
#include "fem/off_axis_curve.h"

namespace palp::fem {

/// `palp-fem curve`, as given on the command line.
struct CurveFlags {
  std::string shape{"none"};
  double depth_mm{10};
  double radius_mm{15};
  double cylinder_height_mm{20};
  double ratio{Inclusion{}.ratio};  ///< [-]
  double inclusion_poisson{0.49};   ///< [-]
  double youngs_modulus_kpa{15.3};  ///< [kPa]
  double poisson{0.49};             ///< [-]
  double half_width_mm{45};
  double height_mm{57};
  double indenter_radius_mm{5};
  double offset_mm{0};
  double tilt_deg{0};           ///< [deg]
  double surface_radius_mm{0};  ///< 0: flat
  std::string model{"neo"};
  std::string indentations_mm{"0:4:0.25"};
  std::string accuracy{"normal"};
  std::string csv{};
  std::string vtu{};
};

/// Of them those of block, tip and inclusion's material.
void declare_block(config::CommandLine& line, CurveFlags& flags);
void declare_curve(config::CommandLine& line, CurveFlags& flags);
[[nodiscard]] config::ExitStatus run_curve(const CurveFlags& flags);

/// "0.5,1,2" or "0:4:0.25" (inclusive), in millimetre -> [m].
[[nodiscard]] Result<std::vector<double>> parse_indentations(const std::string& text);
[[nodiscard]] Result<CurveRequest> curve_request(const CurveFlags& flags);
[[nodiscard]] Approach approach_of(const CurveFlags& flags);
/// `d_mm,F_N,contact_radius_mm,err_N` and a line per row.
[[nodiscard]] std::string csv_text(const std::vector<CurveRow>& rows);

}  // namespace palp::fem
