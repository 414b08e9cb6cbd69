// What a force curve costs beside plain sparse linear algebra on its own matrix, in one run:
//   fem_bench [ROUNDS]
// An L1 curve over (analyse + one factorization + 40 solves); a neo-Hookean curve over one
// factorization. Every figure is the best of the rounds, CPU time of this process; the mesh's error
// is against the fine mesh.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <vector>

#include <Eigen/SparseCholesky>
#include <sys/resource.h>
#include <time.h>

#include "common/core/time.h"
#include "fem/assembler.h"
#include "fem/curve.h"
#include "fem/finite_contact.h"
#include "fem/linear_contact.h"

namespace palp::bench {
namespace {

using fem::Accuracy;
using fem::Model;

constexpr int kSteps = 20;
constexpr int kSolves = 40;

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

struct Case {
  const char* name{};
  fem::Specimen specimen;
};

std::vector<Case> cases() {
  Case ball{"ball a=5 depth 10", {}};
  ball.specimen.inclusion = {
      .shape = fem::InclusionShape::Ball, .depth = 10e-3, .radius = 5e-3, .ratio = 856};
  Case large{"ball a=15 depth 5", {}};
  large.specimen.inclusion = {
      .shape = fem::InclusionShape::Ball, .depth = 5e-3, .radius = 15e-3, .ratio = 856};
  Case cylinder{"cylinder a=8 depth 8", {}};
  cylinder.specimen.inclusion = {.shape = fem::InclusionShape::Cylinder,
                                 .depth = 8e-3,
                                 .radius = 8e-3,
                                 .height = 16e-3,
                                 .ratio = 100};
  return {{"plain block", {}}, ball, large, cylinder};
}

fem::CurveRequest request_of(const Case& one, Model model, Accuracy accuracy) {
  fem::CurveRequest request;
  request.specimen = one.specimen;
  request.model = model;
  request.accuracy = accuracy;
  request.with_error = false;
  const double most = model == Model::Linear ? 3e-3 : 4e-3;
  for (int i = 1; i <= kSteps; ++i) request.indentations.push_back(most * i / kSteps);
  return request;
}

/// What plain linear algebra takes on the curve's own matrix.
struct Floor {
  int equations{};
  double analyse{};    ///< [s]
  double factorize{};  ///< [s]
  double solve{};      ///< [s]
};

Floor floor_of(const Case& one, Accuracy accuracy, int rounds) {
  const fem::Mesh mesh = make_mesh(one.specimen, accuracy);
  const fem::Assembler assembler{mesh, materials_of(one.specimen), bonded_base(mesh)};
  fem::SparseMatrix matrix = assembler.pattern();
  Eigen::VectorXd force;
  assembler.assemble(
      fem::Strain::Small, Eigen::VectorXd::Zero(assembler.components()), matrix, force);
  Floor floor;
  floor.equations = assembler.equations();
  Eigen::SimplicialLDLT<fem::SparseMatrix, Eigen::Lower> factor;
  floor.analyse = best_of(rounds, [&] { factor.analyzePattern(matrix); });
  floor.factorize = best_of(rounds, [&] { factor.factorize(matrix); });
  const Eigen::VectorXd right = Eigen::VectorXd::Ones(floor.equations);
  Eigen::VectorXd solution;
  floor.solve = best_of(rounds, [&] { solution = factor.solve(right); });
  return floor;
}

/// Largest difference of the forces from 0.5 mm on, to three quarters of the cover: farther the
/// fine mesh may find no equilibrium.
double mesh_error(fem::CurveRequest request) {
  if (request.specimen.inclusion.shape != fem::InclusionShape::None) {
    const double most = 0.75 * request.specimen.inclusion.depth;
    std::erase_if(request.indentations, [&](double indentation) { return indentation > most; });
  }
  fem::CurveRequest fine = request;
  fine.accuracy = Accuracy::Fine;
  const auto one = solve_curve(request);
  const auto other = solve_curve(fine);
  if (!one || !other) return std::numeric_limits<double>::quiet_NaN();
  double error = 0;
  for (std::size_t i = 0; i < one->rows.size(); ++i) {
    if (one->rows[i].indentation < 0.5e-3) continue;
    error = std::max(error, std::abs(one->rows[i].force / other->rows[i].force - 1));
  }
  return error;
}

int factorizations_of(const fem::CurveRequest& request) {
  const fem::Mesh mesh = make_mesh(request.specimen, request.accuracy);
  fem::FiniteContact contact{mesh, request.specimen};
  for (const double indentation : request.indentations) {
    if (!contact.press(indentation)) break;
  }
  return contact.factorizations();
}

void measure(const Case& one, Model model, Accuracy accuracy, int rounds) {
  const bool linear = model == Model::Linear;
  const fem::CurveRequest request = request_of(one, model, accuracy);
  const Floor floor = floor_of(one, accuracy, 3 * rounds);
  bool solved = true;
  const double curve = best_of(rounds, [&] { solved &= static_cast<bool>(solve_curve(request)); });
  const double unit =
      linear ? floor.analyse + floor.factorize + kSolves * floor.solve : floor.factorize;
  std::printf("%-21s %-4s %-7s %6d %7.2f %8.1f %8.1f %6.2f %8.2f %8.1f %7.2f %s%s",
              one.name,
              std::string{to_string(model)}.c_str(),
              accuracy == Accuracy::Coarse ? "coarse" : "normal",
              floor.equations,
              100 * mesh_error(request),
              1e3 * floor.analyse,
              1e3 * floor.factorize,
              1e3 * floor.solve,
              1e3 * unit,
              1e3 * curve,
              curve / unit,
              linear ? "(at most 3)" : "(at most 120)",
              solved ? "" : " NOT SOLVED");
  if (!linear) std::printf("  %d factorizations", factorizations_of(request));
  std::printf("\n");
}

void run(int rounds) {
  std::printf("%-21s %-4s %-7s %6s %7s %8s %8s %6s %8s %8s %7s\n%33s %6s %7s %8s %8s %6s %8s %8s\n",
              "phantom",
              "",
              "mesh",
              "equ.",
              "error",
              "analyse",
              "factor",
              "solve",
              "unit",
              "curve",
              "ratio",
              "",
              "",
              "%",
              "ms",
              "ms",
              "ms",
              "ms",
              "ms");
  for (const Model model : {Model::Linear, Model::NeoHookean}) {
    for (const Accuracy accuracy : {Accuracy::Coarse, Accuracy::Normal}) {
      for (const Case& one : cases()) measure(one, model, accuracy, rounds);
    }
  }
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  std::printf("peak memory %.0f MB (the fine meshes of the error column included)\n",
              static_cast<double>(usage.ru_maxrss) / 1024);
}

}  // namespace
}  // namespace palp::bench

int main(int argc, char** argv) {
  palp::bench::run(argc > 1 ? std::max(1, std::atoi(argv[1])) : 5);
  return 0;
}
