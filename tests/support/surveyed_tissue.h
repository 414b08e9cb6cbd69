#pragma once

#include <cmath>
#include <cstdio>
#include <string>

namespace palp::test {

/// A tissue for `--phantom file:`: Hertz' law of the paper's block on a grid of 5 mm, 30 mm wide
/// and 10 mm high about (10, 0) mm, where it is 1.6 times as stiff, as a bell of 6 mm.
inline std::string surveyed_tissue_csv() {
  std::string text = "# x and y of the place, then its curve\nx_mm,y_mm,d_mm,F_N\n";
  for (int x = -5; x <= 25; x += 5) {
    for (int y = -5; y <= 5; y += 5) {
      const double square = ((x - 10.0) * (x - 10.0) + y * y) / 36.0;
      const double harder = 1 + 0.6 * std::exp(-square / 2);
      for (int i = 0; i <= 24; ++i) {
        const double depth = 0.25 * i;  // [mm]
        const double force = harder * 0.06 * depth * std::sqrt(depth);
        char line[80];
        std::snprintf(line, sizeof line, "%d,%d,%g,%.6g\n", x, y, depth, force);
        text += line;
      }
    }
  }
  return text;
}

/// Taps beside and above, and a drag across, all by coordinates.
inline constexpr char kPlaneScript[] =
    "tap 2 times at -5,0\n"
    "tap 2 times at 10,0   # where it is hardest\n"
    "move to -5,2\n"
    "press 3 0.6 0.5\n"
    "drag to 25,2 in 4 s\n"
    "lift 0.6 0.5\n"
    "move to A\n"
    "hold 0.2\n";

}  // namespace palp::test
