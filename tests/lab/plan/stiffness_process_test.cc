// Goal: the Gaussian process that searches are compared with is one. Method: its laws, on readings
// without noise and on such of a known kernel.
#include "lab/plan/stiffness_process.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "common/core/random.h"

namespace palp::lab {
namespace {

using Kernel = StiffnessProcess::Kernel;

std::vector<StiffnessReading> some_readings(double noise) {
  return {{{0, 0}, 0.1, noise},
          {{6e-3, 0}, 0.25, noise},
          {{0, 8e-3}, -0.05, noise},
          {{-7e-3, -3e-3}, 0.02, noise}};
}

TEST(StiffnessProcessTest, ReadingsWithoutNoiseAreReproduced) {
  const auto readings = some_readings(0);
  const StiffnessProcess process{readings, {.own = 0}};
  for (const StiffnessReading& one : readings) {
    EXPECT_NEAR(process.at(one.place).mean, one.value, 1e-9);
    EXPECT_LT(process.at(one.place).stddev, 1e-6);
  }
}

TEST(StiffnessProcessTest, FarFromEveryTouchOnlyTheMeanIsKnown) {
  const Kernel kernel{.spread = 0.1, .own = 0, .mean = 0.07, .mean_stddev = 0};
  const StiffnessProcess process{some_readings(1e-3), kernel};
  const StiffnessTold far = process.at({0.2, 0.2});
  EXPECT_NEAR(far.mean, kernel.mean, 1e-9);
  EXPECT_NEAR(far.stddev, kernel.spread, 1e-9);
}

TEST(StiffnessProcessTest, ATouchTellsAndNoiseTellsLess) {
  const Place beside{3e-3, 1e-3};
  const Kernel kernel{.own = 0};
  auto readings = some_readings(0.01);
  const double before = StiffnessProcess{readings, kernel}.at(beside).stddev;
  EXPECT_GT((StiffnessProcess{some_readings(0.1), kernel}.at(beside).stddev), before);
  readings.push_back({beside, 0.2, 0.01});
  EXPECT_LT((StiffnessProcess{readings, kernel}.at(beside).stddev), before);
}

/// Of one reading it is a normal density; of two that are far apart, with a known mean, a product.
TEST(StiffnessProcessTest, TheMarginalLikelihoodIsThatOfTheReadings) {
  const Kernel kernel{.spread = 0.1, .own = 0.02, .mean = 0.05, .mean_stddev = 0};
  const double variance = 0.1 * 0.1 + 0.02 * 0.02 + 0.03 * 0.03;
  const auto density = [&](double value) {
    const double off = value - kernel.mean;
    return -0.5 * (off * off / variance + std::log(2 * std::acos(-1.0) * variance));
  };
  const StiffnessReading one{{0, 0}, 0.2, 0.03};
  const StiffnessReading other{{1, 0}, -0.1, 0.03};
  EXPECT_NEAR((StiffnessProcess{{one}, kernel}.log_evidence()), density(0.2), 1e-12);
  EXPECT_NEAR(
      (StiffnessProcess{{one, other}, kernel}.log_evidence()), density(0.2) + density(-0.1), 1e-9);
}

/// Drawn by conditional on conditional, as a process defines itself.
std::vector<StiffnessReading> drawn(const Kernel& kernel, std::uint64_t seed) {
  const RandomStream random{seed, 1};
  std::vector<StiffnessReading> out;
  for (int i = 0; i < 64; ++i) {
    const Place place{(i % 8) * 5e-3, (i / 8) * 5e-3};
    StiffnessTold told{.mean = kernel.mean, .stddev = kernel.spread};
    if (!out.empty()) told = StiffnessProcess{out, kernel}.at(place);
    const double value = told.mean + told.stddev * random.normal(2 * static_cast<unsigned>(i));
    const double own = kernel.own * random.normal(2 * static_cast<unsigned>(i) + 1);
    out.push_back({place, value + own, 0});
  }
  return out;
}

TEST(StiffnessProcessTest, TheKernelIsFoundByTheMarginalLikelihood) {
  for (const double length : {4e-3, 12e-3}) {
    const Kernel truth{.length = length, .spread = 0.12, .own = 0.01, .mean_stddev = 0};
    const auto readings = drawn(truth, 3);
    const StiffnessProcess found = StiffnessProcess::fitted(readings);
    EXPECT_NEAR(std::log(found.kernel().length / length), 0, 0.3);
    EXPECT_LE(found.kernel().own, 0.025);
    EXPECT_GE(found.log_evidence(), (StiffnessProcess{readings, {.spread = 0.3}}.log_evidence()));
  }
}

TEST(StiffnessProcessTest, TheStiffestPlaceIsSoughtWhereItWasFeltOrWhereNobodyFelt) {
  const StiffnessProcess process{some_readings(0.01), {}};
  EXPECT_LE(distance(stiffest_place(process, 25e-3, 0), {6e-3, 0}), 3e-3);
  const Place open = stiffest_place(process, 25e-3, 50);
  for (const StiffnessReading& one : some_readings(0)) EXPECT_GT(distance(open, one.place), 8e-3);
  EXPECT_LE(std::abs(open.x), 25e-3);
}

}  // namespace
}  // namespace palp::lab
