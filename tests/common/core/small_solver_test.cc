// Goal: what the solver says solves the equations, or it says that nothing does. Method: systems
// whose matrix is a sum of squares of random rows.
#include "common/core/small_solver.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "common/core/random.h"

namespace palp {
namespace {

constexpr std::size_t kUnknowns = 6;
using System = SmallSystem<kUnknowns>;
using Row = std::array<double, kUnknowns>;

/// Least squares of 20 random equations; what lies right of the diagonal is no number. `repeats`:
/// the last unknown acts as the sum of the first two, so that nothing tells them apart.
System random_system(std::uint64_t seed, bool repeats = false) {
  System system;
  std::uint64_t draw = 0;
  const auto next = [&] { return 2 * random_uniform(seed, 1, draw++) - 1; };
  for (int equation = 0; equation < 20; ++equation) {
    Row row{};
    for (double& value : row) value = next();
    if (repeats) row.back() = row[0] + row[1];
    const double wanted = next();
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      for (std::size_t j = 0; j <= i; ++j) system.matrix[i][j] += row[i] * row[j];
      system.right[i] += row[i] * wanted;
    }
  }
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    for (std::size_t j = i + 1; j < kUnknowns; ++j) {
      system.matrix[i][j] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return system;
}

double entry(const System& system, std::size_t i, std::size_t j) {
  return i < j ? system.matrix[j][i] : system.matrix[i][j];
}

double left_side(const System& system, std::size_t i, const Row& x) {
  double sum = 0;
  for (std::size_t j = 0; j < kUnknowns; ++j) sum += entry(system, i, j) * x[j];
  return sum;
}

TEST(SmallSolverTest, TheSolutionSolvesTheEquations) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const System system = random_system(seed);
    const auto solution = solve(system);
    ASSERT_TRUE(solution.regular);
    double explained = 0;
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      EXPECT_NEAR(left_side(system, i, solution.x), system.right[i], 1e-12);
      explained += solution.x[i] * system.right[i];
    }
    EXPECT_NEAR(solution.explained, explained, 1e-12);
  }
}

TEST(SmallSolverTest, ClosedUnknownsStayOut) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const System system = random_system(seed);
    std::array<bool, kUnknowns> open{};
    for (std::size_t i = 0; i < kUnknowns; ++i) open[i] = random_uniform(seed, 2, i) < 0.6;
    const auto solution = solve(system, open);
    ASSERT_TRUE(solution.regular);
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      if (open[i]) {
        EXPECT_NEAR(left_side(system, i, solution.x), system.right[i], 1e-12);
      } else {
        EXPECT_EQ(solution.x[i], 0);
      }
    }
  }
}

TEST(SmallSolverTest, SaysThatTheEquationsLeaveAnUnknownOpen) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const auto solution = solve(random_system(seed, true));
    EXPECT_FALSE(solution.regular) << seed;
    EXPECT_EQ(solution.x, Row{});
    EXPECT_EQ(solution.explained, 0);
  }
}

TEST(SmallSolverTest, NumbersThatAreNoneAreSingular) {
  System system = random_system(1);
  system.matrix[3][2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(solve(system).regular);
}

/// Other units make no other rank, and powers of two no other bits.
TEST(SmallSolverTest, UnitsDoNotMatter) {
  const Row unit{0x1p-40, 0x1p+30, 1, 0x1p-3, 0x1p+50, 0x1p-60};
  for (const bool repeats : {false, true}) {
    const System system = random_system(7, repeats);
    System scaled = system;
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      for (std::size_t j = 0; j <= i; ++j) scaled.matrix[i][j] *= unit[i] * unit[j];
      scaled.right[i] *= unit[i];
    }
    const auto solution = solve(system);
    const auto again = solve(scaled);
    EXPECT_EQ(solution.regular, again.regular);
    EXPECT_EQ(solution.regular, !repeats);
    for (std::size_t i = 0; i < kUnknowns; ++i) EXPECT_EQ(again.x[i] * unit[i], solution.x[i]);
  }
}

}  // namespace
}  // namespace palp
