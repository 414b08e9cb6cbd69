// What the forward model beside a ball's axis costs, beside an axisymmetric curve, in one run:
//   off_axis_bench [ROUNDS]
// Ten harmonics of a kernel, with the ball and without it; an off-axis curve of eight depths, and
// the same above the ball. Every figure is the best of the rounds,
// CPU time of this process.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <vector>

#include <time.h>

#include "fem/curve.h"
#include "fem/harmonic_body.h"
#include "fem/linear_contact.h"
#include "fem/off_axis_contact.h"

namespace palp::bench {
namespace {

constexpr int kHarmonics = 10;
constexpr double kOffset = 10e-3;  // [m]

double processor_seconds() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double best_of(int rounds, const std::function<void()>& work) {
  double best = std::numeric_limits<double>::infinity();
  for (int round = 0; round < rounds; ++round) {
    const double from = processor_seconds();
    work();
    best = std::min(best, processor_seconds() - from);
  }
  return best;
}

void measure(double radius_mm, double depth_mm, int rounds) {
  fem::Specimen specimen;
  specimen.inclusion = {.shape = fem::InclusionShape::Ball,
                        .depth = depth_mm * 1e-3,
                        .radius = radius_mm * 1e-3,
                        .ratio = 856};
  const fem::Mesh mesh =
      make_mesh(specimen, fem::Accuracy::Normal, {.reach = 32e-3, .spacing = 1.5e-3});
  std::vector<int> nodes;
  for (const fem::SurfaceEdge& edge : mesh.surface) nodes.push_back(edge[0]);
  const std::vector<fem::Material> with = materials_of(specimen);
  const std::vector<fem::Material> without{with.front(), with.front()};
  int equations = 0;
  const double kernel = best_of(rounds, [&] {
    fem::HarmonicBody body{mesh, nodes};
    equations = body.equations();
    for (int order = 0; order < kHarmonics; ++order) {
      static_cast<void>(body.compliance(with, order) - body.compliance(without, order));
    }
  });
  fem::OffAxisContact contact{specimen, kOffset, fem::Accuracy::Normal};
  fem::CurveRequest request{.specimen = specimen, .indentations = {}, .with_error = false};
  for (int i = 1; i <= 8; ++i) request.indentations.push_back(0.5e-3 * i);
  bool solved = true;
  double offset = kOffset;  // each round another, or the compliance is at hand
  const double beside = best_of(rounds, [&] {
    offset -= 1e-6;
    for (const double d : request.indentations) {
      solved &= contact.excess(d, offset).has_value();
    }
  });
  const double above = best_of(rounds, [&] { solved &= fem::solve_curve(request).has_value(); });
  std::printf("a=%-3g depth %-3g %6d %14.2f %16.1f %16.1f%s\n",
              radius_mm,
              depth_mm,
              equations,
              kernel,
              1e3 * beside,
              1e3 * above,
              solved ? "" : " NOT SOLVED");
}

void run(int rounds) {
  std::printf("ball             equ.  10 harmonics s  curve beside ms   curve above ms\n");
  measure(5, 5, rounds);
  measure(15, 10, rounds);
  measure(8, 8, rounds);
  std::printf("at most                         3.00             50.0\n");
}

}  // namespace
}  // namespace palp::bench

int main(int argc, char** argv) {
  palp::bench::run(argc > 1 ? std::max(1, std::atoi(argv[1])) : 3);
  return 0;
}
