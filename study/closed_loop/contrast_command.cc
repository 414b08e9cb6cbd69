#include "study/closed_loop/contrast_command.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "common/config/number.h"
#include "study/level_curves.h"

namespace palp::study {

using config::ExitCode;
using config::ExitStatus;
using config::number_text;

void declare_contrast(config::CommandLine& line, ContrastFlags& flags) {
  line.number("--radius-mm", flags.radius_mm, {.min = 1, .max = 50}, "of the ball");
  line.number("--ratio", flags.ratio, {.min = 1.01, .max = 1e4}, "its stiffness over the block's");
  line.number("--from-mm", flags.from_mm, {.min = 0.1, .max = 100}, "least depth of its top");
  line.number("--to-mm", flags.to_mm, {.min = 0.1, .max = 100}, "greatest depth of its top");
  line.whole("--count", flags.count, {.min = 2, .max = 60}, "depths, the same factor apart");
  line.number("--press-mm", flags.press_mm, {.min = 0.5, .max = 8}, "how deep it is pressed");
  line.footer("Prints the depths of a study that asks for something hard: detect and detect2.");
}

Result<double> ball_contrast(double radius, double ratio, double depth, double press) {
  const auto phantom = ball_phantom(radius, ratio, depth);
  if (!phantom) return tl::unexpected(phantom.error());
  const double solved = std::min(phantom->over.depth_max(), phantom->plain.depth_max());
  if (press > solved) {
    return fail("over a ball " + number_text(depth * 1e3) + " mm deep forces are known to " +
                number_text(solved * 1e3) + " mm: give a smaller --press-mm, or deeper balls");
  }
  return std::log(phantom->over.force(press) / phantom->plain.force(press));
}

ExitStatus run_contrast(const ContrastFlags& flags) {
  if (flags.from_mm >= flags.to_mm) {
    return {ExitCode::BadInput, "palp-study: --from-mm must be below --to-mm"};
  }
  std::string text = "ball { radius_mm: " + number_text(flags.radius_mm) +
                     " ratio: " + number_text(flags.ratio) + " }\n";
  for (std::uint64_t i = 0; i < flags.count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(flags.count - 1);
    const double mm = flags.from_mm * std::pow(flags.to_mm / flags.from_mm, share);
    const auto contrast =
        ball_contrast(flags.radius_mm / 1e3, flags.ratio, mm / 1e3, flags.press_mm / 1e3);
    if (!contrast) return config::refusal("palp-study", contrast.error());
    std::array<char, 96> line{};
    std::snprintf(
        line.data(), line.size(), "depth { top_mm: %.4g contrast_ln: %.4g }\n", mm, *contrast);
    text += line.data();
  }
  return {ExitCode::Done, text};
}

}  // namespace palp::study
