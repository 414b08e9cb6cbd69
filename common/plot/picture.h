#pragma once

#include <string>

#include "common/config/command_line.h"
#include "common/core/result.h"
#include "common/plot/figure.h"

/// Pictures as a program's flags ask for them.
namespace palp::plot {

struct PictureFlags {
  std::string svg{};
  std::string pdf{};
  std::string style{kStyles.front().name};

  [[nodiscard]] bool asked() const noexcept { return !svg.empty() || !pdf.empty(); }
};

/// --svg, --pdf and --style; `meaning`: what the picture shows.
void declare_picture(config::CommandLine& line, PictureFlags& flags, const std::string& meaning);

/// Whether write_picture() could write now, for runs that take long; leaves nothing behind.
[[nodiscard]] Result<void> can_write_picture(const PictureFlags& flags);
/// What was asked for, each file whole or not at all; what was there is written over. The error is
/// a CannotOpen.
[[nodiscard]] Result<void> write_picture(const Figure& figure, const PictureFlags& flags);

}  // namespace palp::plot
