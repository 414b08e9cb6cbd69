#include "patient_site/block_tissue.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fem/off_axis_curve.h"
#include "patient_site/phantom.h"
#include "patient_site/tissue_words.h"

namespace palp::patient {
namespace {

using ::testing::HasSubstr;

constexpr double kDeep = 2e-3;  // [m]

/// A phantom of words and its field.
struct Tissue {
  explicit Tissue(std::string_view words) : phantom{*make_phantom(words)} {}
  [[nodiscard]] double force(const Place& place, double indentation) const {
    return field->elastic_force(place, indentation);
  }
  Phantom phantom;
  std::unique_ptr<TissueField> field{make_field(phantom, 0)};
};

/// Force over the plain block's by finite elements, the tip beside a ball.
double solved(const fem::Approach& approach, bool ball) {
  fem::CurveRequest request;
  request.specimen.inclusion = {
      .shape = ball ? fem::InclusionShape::Ball : fem::InclusionShape::None,
      .depth = 6e-3,
      .radius = 8e-3,
      .ratio = 100};
  request.model = fem::Model::NeoHookean;
  request.accuracy = fem::Accuracy::Coarse;
  request.indentations = {kDeep};
  request.with_error = false;
  return fem::solve_off_axis_curve(request, approach)->front().force;
}

TEST(BlockFieldTest, BesideABallTheForceIsThatOfFiniteElements) {
  const Tissue tissue{"ball depth=6 radius=8 ratio=100 at=20,0"};
  for (const double offset : {3e-3, 9e-3}) {
    const double wanted = solved({.offset = offset}, true) / solved({.offset = offset}, false);
    const double found =
        tissue.force({20e-3 - offset, 0}, kDeep) / tissue.phantom.plain.force(kDeep);
    EXPECT_NEAR(found / wanted, 1, 2.5e-3) << offset;
  }
}

TEST(BlockFieldTest, OnASlopeTheForceIsThatOfFiniteElements) {
  const Tissue tissue{"ball depth=6 radius=8 ratio=100 at=0,0; surface slope_x=10"};
  const double tilt = 10 * std::numbers::pi / 180;
  // The tip touches 5 mm up the slope from the ball's axis and walks towards it.
  const double touched = 5e-3 * std::cos(tilt);
  const double tip = touched - 5e-3 * std::sin(tilt);
  const double wanted = solved({.offset = 5e-3, .tilt = -tilt}, true);
  EXPECT_NEAR(tissue.force({tip, 0}, kDeep) / wanted, 1, 5e-3);
}

TEST(BlockFieldTest, OnADomeTheForceIsThatOfFiniteElements) {
  const Tissue dome{"block; surface radius=60"};
  const Tissue flat{"block"};
  const double wanted = solved({.surface_curvature = 1 / 60e-3}, false) / solved({}, false);
  EXPECT_NEAR(dome.force({}, kDeep) / flat.force({}, kDeep), wanted, 1e-3);
}

TEST(BlockFieldTest, TheEffectFallsWithTheDistanceWhateverTheDirection) {
  const Tissue tissue{"ball depth=6 radius=8 ratio=100 at=-5,10"};
  double last = tissue.force({-5e-3, 10e-3}, kDeep);
  EXPECT_EQ(last, tissue.phantom.over.force(kDeep));
  for (double away = 1e-3; away < 40e-3; away += 1e-3) {
    const double here = tissue.force({-5e-3 + away, 10e-3}, kDeep);
    EXPECT_LT(here, last) << away;
    EXPECT_NEAR(tissue.force({-5e-3, 10e-3 - away}, kDeep), here, 1e-9);
    last = here;
  }
  EXPECT_EQ(tissue.force({35.1e-3, 10e-3}, kDeep), tissue.phantom.plain.force(kDeep));
}

TEST(BlockFieldTest, InclusionsFarApartAddUp) {
  const Tissue one{"ball depth=6 radius=8 ratio=100 at=-15,0"};
  const Tissue other{"ball depth=5 radius=5 ratio=30 at=20,0"};
  const Tissue both{
      "ball depth=6 radius=8 ratio=100 at=-15,0\n# a second one\nball depth=5 radius=5 ratio=30 "
      "at=20,0"};
  const double plain = one.phantom.plain.force(kDeep);
  for (const Place& place : {Place{0, 0}, Place{15e-3, 4e-3}, Place{-10e-3, -8e-3}}) {
    EXPECT_NEAR(both.force(place, kDeep) / plain,
                one.force(place, kDeep) / plain * other.force(place, kDeep) / plain,
                1e-9);
  }
}

TEST(BlockFieldTest, StiffnessScalesEveryForceAndVariesAsGiven) {
  const Tissue soft{"ball depth=6 at=0,0"};
  const Tissue stiff{"ball depth=6 at=0,0; block e_kpa=30.6"};
  EXPECT_NEAR(stiff.force({4e-3, 0}, kDeep) / soft.force({4e-3, 0}, kDeep), 2, 1e-9);
  const Tissue plain{"block"};
  double sum = 0;
  double squares = 0;
  double near = 0;
  double far = 0;
  int count = 0;
  for (int seed = 1; seed <= 20; ++seed) {
    const Tissue varied{"block varies=0.05 length=10 seed=" + std::to_string(seed)};
    const auto log_at = [&](double x, double y) {
      return std::log(varied.force({x, y}, kDeep) / plain.force({x, y}, kDeep)) / 0.05;
    };
    for (double x = -60e-3; x <= 60e-3; x += 20e-3) {
      for (double y = -60e-3; y <= 60e-3; y += 20e-3) {
        const double here = log_at(x, y);
        sum += here;
        squares += here * here;
        near += here * log_at(x + 5e-3, y);
        far += here * log_at(x, y + 40e-3);
        ++count;
      }
    }
  }
  EXPECT_NEAR(sum / count, 0, 0.15);
  EXPECT_NEAR(squares / count, 1, 0.2);
  EXPECT_NEAR(near / count, std::exp(-0.125), 0.2) << "correlated over half a length";
  EXPECT_NEAR(far / count, 0, 0.15) << "not over four";
  const Tissue again{"block varies=0.05 length=10 seed=20"};
  const Tissue same{"block varies=0.05 length=10 seed=20"};
  EXPECT_EQ(again.force({7e-3, 3e-3}, kDeep), same.force({7e-3, 3e-3}, kDeep));
}

TEST(BlockFieldTest, TheSurfaceLiesWhereItsWordsSay) {
  const Tissue level{"block"};
  EXPECT_EQ(level.field->surface({10e-3, 0}), 0);
  const Tissue slope{"surface slope_x=10"};
  const double tilt = 10 * std::numbers::pi / 180;
  const double sooner = 5e-3 * (1 / std::cos(tilt) - 1);
  EXPECT_NEAR(slope.field->surface({10e-3, 0}), -10e-3 * std::tan(tilt) - sooner, 1e-9);
  const Tissue dome{"surface radius=60 at=5,0"};
  EXPECT_NEAR(dome.field->surface({5e-3, 0}), 0, 1e-12);
  EXPECT_GT(dome.field->surface({15e-3, 0}), 0.7e-3) << "it falls away from the apex";
}

TEST(BlockFieldTest, AThinBlockIsStifferAndALawTakesTheDatabasesPlace) {
  const Tissue paper{"block"};
  const Tissue thin{"block height=30"};
  EXPECT_GT(thin.force({}, kDeep), 1.03 * paper.force({}, kDeep));
  EXPECT_GT(thin.force({}, 4e-3) / paper.force({}, 4e-3),
            thin.force({}, 1e-3) / paper.force({}, 1e-3));
  const Tissue law{"ball depth=6 at=20,0; block law=exponential"};
  const Tissue ball{"ball depth=6 at=20,0"};
  EXPECT_NEAR(law.force({-30e-3, 0}, kDeep), make_phantom("exponential")->plain.force(kDeep), 1e-4);
  EXPECT_NEAR(law.force(kSiteB, kDeep) / law.phantom.plain.force(kDeep),
              ball.force(kSiteB, kDeep) / ball.phantom.plain.force(kDeep),
              1e-9);
}

TEST(BlockFieldTest, StiffnessIsTheDerivativeOfTheForce) {
  const Tissue tissue{"ball depth=6 at=5,0; surface slope_y=5; block varies=0.1"};
  constexpr double kStep = 1e-6;  // [m]
  for (const double d : {0.61e-3, 2.83e-3}) {
    const double rise = (tissue.force({}, d + kStep) - tissue.force({}, d - kStep)) / (2 * kStep);
    EXPECT_NEAR(tissue.field->stiffness({}, d) / rise, 1, 1e-4);
  }
  EXPECT_EQ(tissue.field->stiffness({}, -1e-3), 0);
}

TEST(BlockTissueTest, WhatNobodyComputedIsRefused) {
  struct Refusal {
    const char* words;
    const char* sentence;
  };
  for (const auto& [words, sentence] : std::vector<Refusal>{
           {"ball depth=6 at=0,0; ball depth=6 at=25,0", "inclusions 1 and 2 lie nearer"},
           {"ball depth=2", "the inclusion's depth is 2 mm, expected 3 to 27 mm"},
           {"surface slope_x=19 slope_y=19", "more than 20 degrees"},
           {"surface radius=10", "below 20 mm, four tip radii"},
           {"surface slope_x=21", "is not a number from -20 to 20"},
           {"block height=15; ball depth=6 radius=5",
            "reaches 16 mm below the surface, expected at most 14.94 mm in a block of height 15 "
            "mm"},
           {"block height=15; cylinder depth=6 radius=12", "in a block of height 15 mm"},
           {"surface radius=19", "four tip radii, which nobody computed"},
           {"block e_kpa=soft", "is not a number from 0.1 to 1000"},
           {"block law=jelly", "there is no law 'jelly'"},
           {"block depth=3", "'depth' is unknown of a block; there are e_kpa, height"},
           {"ball depth=12 depth=13", "'depth' is given twice of a ball"},
           {"block e_kpa=18; ball depth=6; block varies=0.05", "'block' is given twice"},
           {"ball depth=6; bell depth=6", "'bell' is unknown; there are ball, cylinder"},
           {"block seed=1.5", "'seed=1.5' is not a whole number from 0"},
           {"block seed=-1", "'seed=-1' is not a whole number from 0"},
           {"surface radius=0", "a level surface has none"},
           {"database; ball depth=6", "'database' names no file"},
           {"database file=none.bin; ball depth=6", "cannot read none.bin"}}) {
    const auto phantom = make_phantom(words);
    ASSERT_FALSE(phantom) << words;
    EXPECT_THAT(phantom.error().text, HasSubstr(sentence));
    EXPECT_THAT(phantom.error().text, HasSubstr(std::string{"phantom '"} + words));
  }
}

TEST(BlockTissueTest, ABlockThatPressesHarderThanATableHoldsIsRefused) {
  BlockTissue block = parse_tissue_words("block e_kpa=1000")->block;
  EXPECT_TRUE(plain_table(block));
  block.youngs_modulus = 1e12;
  const auto plain = plain_table(block);
  ASSERT_FALSE(plain);
  EXPECT_THAT(plain.error().text, HasSubstr("the block's force: row 2"));
}

}  // namespace
}  // namespace palp::patient
