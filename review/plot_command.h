#pragma once

#include <optional>

#include "common/config/command_line.h"
#include "common/plot/picture.h"
#include "review/demo_report.h"

namespace palp::review {

/// `palp-review plot`, as given.
struct PlotFlags {
  SessionPaths sessions;
  plot::PictureFlags picture;
  std::optional<double> from{};  ///< [s]
  std::optional<double> to{};    ///< [s]
};

void declare_plot(config::CommandLine& line, PlotFlags& flags);
[[nodiscard]] config::ExitStatus run_plot(const PlotFlags& flags);

}  // namespace palp::review
