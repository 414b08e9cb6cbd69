#include "common/plot/picture.h"

#include "common/config/report.h"
#include "common/plot/pdf.h"

namespace palp::plot {

void declare_picture(config::CommandLine& line, PictureFlags& flags, const std::string& meaning) {
  std::vector<std::string> names;
  names.reserve(kStyles.size());
  for (const Style& style : kStyles) names.emplace_back(style.name);
  line.output("--svg", flags.svg, meaning);
  line.output("--pdf", flags.pdf, "the same as PDF");
  line.choice("--style", flags.style, names, "of the picture; a paper's column: 85 mm, 175 mm");
}

Result<void> can_write_picture(const PictureFlags& flags) {
  if (auto can = config::can_write_files({flags.svg, flags.pdf}); !can || flags.pdf.empty()) {
    return can;
  }
  const auto pdf = pdf_of(figure_svg({}, kStyles.front()));
  return pdf ? Result<void>{} : tl::unexpected(pdf.error());
}

Result<void> write_picture(const Figure& figure, const PictureFlags& flags) {
  if (!flags.asked()) return {};
  const std::string svg = figure_svg(figure, style_of(flags.style).value_or(kStyles.front()));
  if (!flags.svg.empty()) {
    if (auto written = config::write_whole_file(flags.svg, svg); !written) return written;
  }
  if (flags.pdf.empty()) return {};
  const auto pdf = pdf_of(svg);
  if (!pdf) return tl::unexpected(pdf.error());
  return config::write_whole_file(flags.pdf, *pdf);
}

}  // namespace palp::plot
