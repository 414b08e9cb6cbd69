#include "fem/depth_formula.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp::fem {
namespace {

TEST(DepthFormulaTest, ACubicIsItsOwnFitAndTheHashItsValueAtOneMillimetre) {
  const ForceCubic wanted{{-0.003, 0.05, 0.04, -0.002}};
  std::vector<double> d;
  std::vector<double> f;
  for (int i = 0; i <= 16; ++i) {
    d.push_back(0.25 * i);
    f.push_back(wanted.force(d.back()));
  }
  const ForceCubic found = fit_cubic(d, f);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(found.coefficients[k], wanted.coefficients[k], 1e-12);
  }
  EXPECT_NEAR(found.hash(), -0.003 + 0.05 + 0.04 - 0.002, 1e-15);
}

// Paper, Table I: the printed formula turns the measured hashes into the printed estimates.
TEST(DepthFormulaTest, ThePrintedFormulaGivesThePrintedEstimates) {
  EXPECT_NEAR(kPaperFormula.depth_mm(0.0925485), 5.1039, 0.03);
  EXPECT_NEAR(kPaperFormula.depth_mm(0.0697493), 9.8251, 0.01);
  EXPECT_NEAR(kPaperFormula.depth_mm(0.0654103), 13.2451, 0.01);
}

TEST(DepthFormulaTest, HashesOfAFormulaGiveItBack) {
  std::vector<double> hashes;
  std::vector<double> depths;
  for (const double h : {0.061, 0.0615, 0.062, 0.0635, 0.065, 0.07, 0.08, 0.092}) {
    hashes.push_back(h);
    depths.push_back(kPaperFormula.depth_mm(h));
  }
  const auto found = fit_formula(hashes, depths, 0.0590);
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_NEAR(found->pole, kPaperFormula.pole, 2e-5);
  for (const double h : {0.0612, 0.067, 0.088}) {
    EXPECT_NEAR(found->depth_mm(h), kPaperFormula.depth_mm(h), 1e-3);
  }
}

TEST(DepthFormulaTest, AHashBelowThatOfThePlainBlockIsRefused) {
  const auto found = fit_formula({0.058, 0.06, 0.07, 0.08, 0.09}, {25, 20, 15, 10, 5}, 0.059);
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().text.find("plain block"), std::string::npos);
}

}  // namespace
}  // namespace palp::fem
