#pragma once

#include <cstdint>

#include "common/config/command_line.h"
#include "common/core/result.h"

namespace palp::study {

/// `palp-study contrast`, as given on the command line.
struct ContrastFlags {
  double radius_mm{8};  ///< [mm], of the ball
  double ratio{100};    ///< [-], its stiffness over the block's
  double from_mm{8};    ///< [mm], least depth of its top
  double to_mm{20};     ///< [mm], greatest
  std::uint64_t count{7};
  double press_mm{4};  ///< [mm]
};

void declare_contrast(config::CommandLine& line, ContrastFlags& flags);

/// Lines for a study file, the ball and `depth { top_mm: 10 contrast_ln: 0.14 }`: how much stiffer
/// the tissue is above a ball than beside it, by the force at the press, as the database of finite
/// elements has it.
[[nodiscard]] config::ExitStatus run_contrast(const ContrastFlags& flags);

/// [-], ln of the force above a ball of that radius [m] and ratio [-], whose top lies `depth` [m]
/// deep, over that beside it, at an indentation of `press` [m]. A sentence where the database
/// does not reach so far.
[[nodiscard]] Result<double> ball_contrast(double radius, double ratio, double depth, double press);

}  // namespace palp::study
