#include "common/plot/pdf.h"

#include "common/io/process/child_output.h"

namespace palp::plot {

Result<std::string> pdf_of(const std::string& svg) {
  auto pdf = io::child_output({"rsvg-convert", "--format=pdf"}, svg);
  if (!pdf && pdf.error().unreachable) {
    return fail_to_reach(pdf.error().text + "; it makes PDF, and Debian has it in librsvg2-bin");
  }
  return pdf;
}

}  // namespace palp::plot
