#include "fem/finite_contact.h"

#include <gtest/gtest.h>

#include "fem/linear_contact.h"

namespace palp::fem {
namespace {

Specimen small_block() {
  Specimen specimen;
  specimen.block.half_width = 15e-3;
  specimen.block.height = 12e-3;
  specimen.inclusion = {.shape = InclusionShape::Ball, .depth = 5e-3, .radius = 3e-3, .ratio = 20};
  return specimen;
}

// Energy balance: F = dW/dd, at finite strain and with the true sphere.
TEST(FiniteContactTest, ForceIsTheSlopeOfTheEnergy) {
  const Specimen specimen = small_block();
  FiniteContact contact{make_mesh(specimen, Accuracy::Coarse), specimen};
  const double step = 5e-6;
  ASSERT_TRUE(contact.press(1.5e-3 - step));
  const double below = contact.energy();
  const auto at = contact.press(1.5e-3);
  ASSERT_TRUE(at) << at.error().text;
  ASSERT_TRUE(contact.press(1.5e-3 + step));
  const double above = contact.energy();
  EXPECT_NEAR((above - below) / (2 * step) / at->force, 1, 1e-4);
}

TEST(FiniteContactTest, AtSmallIndentationItIsTheLinearModel) {
  Specimen specimen = small_block();
  const Mesh mesh = make_mesh(specimen, Accuracy::Normal);
  FiniteContact finite{mesh, specimen};
  LinearContact linear{mesh, specimen, 0.05e-3};
  const auto one = finite.press(0.05e-3);
  const auto other = linear.press(0.05e-3);
  ASSERT_TRUE(one && other);
  EXPECT_NEAR(one->force / other->force, 1, 0.01);
}

TEST(FiniteContactTest, TheWayThereDoesNotMatter) {
  const Specimen specimen = small_block();
  const Mesh mesh = make_mesh(specimen, Accuracy::Coarse);
  FiniteContact direct{mesh, specimen};
  FiniteContact stops{mesh, specimen};
  const auto one = direct.press(1e-3);
  for (const double d : {0.13e-3, 0.41e-3, 0.77e-3}) ASSERT_TRUE(stops.press(d));
  const auto other = stops.press(1e-3);
  ASSERT_TRUE(one && other);
  EXPECT_NEAR(one->force / other->force, 1, 1e-4);
}

// Work, not time: a step of 0.2 mm takes one factorization once the contact is wider than a few
// elements, two or three before.
TEST(FiniteContactTest, AStepNeedsFewFactorizations) {
  Specimen specimen;
  specimen.inclusion = {.shape = InclusionShape::Ball, .depth = 10e-3, .radius = 5e-3};
  FiniteContact contact{make_mesh(specimen, Accuracy::Coarse), specimen};
  for (int i = 1; i <= 20; ++i) {
    ASSERT_TRUE(contact.press(i * 0.2e-3));
    EXPECT_LT(contact.residuals().back(), 1e-5);
  }
  EXPECT_LE(contact.factorizations(), 45);
}

TEST(FiniteContactTest, WhatCannotBeSolvedIsSaidInOneSentence) {
  Specimen specimen = small_block();
  specimen.inclusion.ratio = 800;
  FiniteContact contact{make_mesh(specimen, Accuracy::Coarse), specimen};
  const auto row = contact.press(4.99e-3);
  if (!row) {
    EXPECT_NE(row.error().text.find("mm"), std::string::npos);
  }
}

}  // namespace
}  // namespace palp::fem
