#pragma once

#include <string>
#include <vector>

#include "common/config/command_line.h"
#include "common/plot/picture.h"
#include "fem/curve.h"
#include "fem/depth_formula.h"

namespace palp::fem {

/// `palp-fem paper`, as given on the command line.
struct PaperFlags {
  std::string model{"neo"};
  std::string accuracy{"normal"};
  double radius_mm{15};
  double range_mm{4};
  double step_mm{2.5};
  plot::PictureFlags picture{};
  std::string report{};
};

void declare_paper(config::CommandLine& line, PaperFlags& flags);
/// Solves the paper's phantoms and sets its numbers beside ours. Missed if a published hash or the
/// pole is off by more than 1 %.
[[nodiscard]] config::ExitStatus run_paper(const PaperFlags& flags);

/// One phantom.
struct PaperPhantom {
  double depth_mm{};  ///< [mm]; 0: no inclusion
  std::vector<double> indentations_mm;
  std::vector<double> forces_n;
  ForceCubic cubic;
};

/// Everything the command tells.
struct PaperStudy {
  std::vector<PaperPhantom> phantoms;  ///< with inclusion, by depth
  PaperPhantom plain;
  DepthFormula refitted;
  [[nodiscard]] const PaperPhantom* at(double depth_mm) const noexcept;
};

[[nodiscard]] Result<PaperStudy> study_paper(const PaperFlags& flags);
[[nodiscard]] std::string paper_text(const PaperStudy& study);
[[nodiscard]] plot::Figure paper_figure(const PaperStudy& study);
[[nodiscard]] std::string paper_report(const PaperStudy& study);
/// What is off by more than 1 %, one line each.
[[nodiscard]] std::vector<std::string> paper_misses(const PaperStudy& study);

}  // namespace palp::fem
