// The force over a line across a tissue, as CSV:
//   tissue_line PHANTOM DEPTH_MM X_FROM_MM X_TO_MM Y_MM > line.csv
#include <cstdio>
#include <cstdlib>

#include "common/core/conventions.h"
#include "patient_site/phantom.h"

int main(int argc, char** argv) {
  if (argc != 6) {
    std::fprintf(stderr, "usage: tissue_line PHANTOM DEPTH_MM X_FROM_MM X_TO_MM Y_MM\n");
    return 2;
  }
  const auto phantom = palp::patient::make_phantom(argv[1]);
  if (!phantom) {
    std::fprintf(stderr, "%s\n", phantom.error().text.c_str());
    return 2;
  }
  const auto field = palp::patient::make_field(*phantom, 0);
  const double depth = std::atof(argv[2]) * palp::kMillimetre;
  const double from = std::atof(argv[3]);  // [mm]
  const double to = std::atof(argv[4]);    // [mm]
  const double y = std::atof(argv[5]) * palp::kMillimetre;
  constexpr int kPoints = 400;
  std::puts("x_mm,force_n,stiffness_n_per_m");
  for (int i = 0; i <= kPoints; ++i) {
    const double x = from + (to - from) * i / kPoints;
    const palp::Place place{x * palp::kMillimetre, y};
    std::printf(
        "%.9g,%.9g,%.9g\n", x, field->elastic_force(place, depth), field->stiffness(place, depth));
  }
  return 0;
}
