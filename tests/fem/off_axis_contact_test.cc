#include "fem/off_axis_contact.h"

#include <cmath>

#include <gtest/gtest.h>

#include "fem/curve.h"
#include "tests/fem/off_axis_reference.h"

namespace palp::fem {
namespace {

// Two ways to the same number: harmonics on cells, and the axisymmetric solver, whose contact's
// edge must lie finer than usual for it.
TEST(OffAxisContactTest, OnTheAxisItIsTheAxisymmetricSolver) {
  const Specimen specimen = ball(5, 5, 856);
  OffAxisContact contact{specimen, 0, Accuracy::Coarse};
  CurveRequest request{.specimen = specimen,
                       .accuracy = Accuracy::Fine,
                       .indentations = {1e-3, 2e-3, 3e-3, 4e-3},
                       .with_error = false};
  const auto with = solve_curve(request);
  request.specimen.inclusion.ratio = 1;
  const auto without = solve_curve(request);
  ASSERT_TRUE(with && without);
  for (std::size_t i = 0; i < request.indentations.size(); ++i) {
    const auto excess = contact.excess(request.indentations[i], 0);
    ASSERT_TRUE(excess) << excess.error().text;
    const double wanted = with->rows[i].force / without->rows[i].force;
    EXPECT_NEAR(std::exp(*excess) / wanted, 1, 1.5e-3) << request.indentations[i];
  }
}

// The slow tests compare more balls and depths.
TEST(OffAxisContactTest, TheShapeOverTheOffsetAgreesWithThreeDimensions) {
  OffAxisContact contact{ball(8, 8, 20), 20e-3, Accuracy::Coarse};
  double their_above = 0;
  double our_above = 0;
  int compared = 0;
  for (const Reference& row : read_off_axis("l1_ball_a8_d8_k20")) {
    if (row.indentation != 2) continue;
    const auto excess = contact.excess(2e-3, row.offset * 1e-3);
    ASSERT_TRUE(excess);
    const double theirs = std::log(row.force / row.plain);
    if (row.offset == 0) {
      their_above = theirs;
      our_above = *excess;
    }
    EXPECT_NEAR(*excess / our_above, theirs / their_above, 0.015) << row.offset;
    ++compared;
  }
  EXPECT_EQ(compared, 7);
}

TEST(OffAxisContactTest, TheLimitOfTheOffsetIsWithinReach) {
  EXPECT_GE(offset_limit({}), 35e-3);
  EXPECT_LT(offset_limit({}), 35.001e-3);
}

TEST(OffAxisContactTest, TheEffectIsEvenAndFallsWithTheOffset) {
  OffAxisContact contact{ball(5, 5, 856), 20e-3, Accuracy::Coarse};
  EXPECT_LT(contact.last_share(), 1e-4);
  double last = 1;
  for (const double offset : {0.0, 1e-3, 2.5e-3, 5e-3, 7.5e-3, 10e-3, 15e-3, 20e-3}) {
    const auto right = contact.excess(2e-3, offset);
    const auto left = contact.excess(2e-3, -offset);
    ASSERT_TRUE(right && left);
    EXPECT_NEAR(*right, *left, 1e-6);
    EXPECT_LT(*right, last) << offset;
    EXPECT_GT(*right, 0) << offset;
    last = *right;
  }
}

// The ball feels the strain of the tip's force twice, as the cube of the distance each.
TEST(OffAxisContactTest, FarFromTheBallItsEffectFallsAsTheSixthPower) {
  OffAxisContact contact{ball(3, 3, 900), 25e-3, Accuracy::Coarse};
  const auto near = contact.excess(1e-3, 18e-3);
  const auto far = contact.excess(1e-3, 24e-3);
  ASSERT_TRUE(near && far);
  EXPECT_GT(*far, 0);
  EXPECT_GT(*near / *far, std::pow(24.0 / 18, 6));
}

TEST(OffAxisContactTest, ASofterBallSoftensAndOneLikeTheBlockDoesNothing) {
  OffAxisContact soft{ball(6, 5, 0.2), 5e-3, Accuracy::Coarse};
  EXPECT_LT(*soft.excess(2e-3, 4e-3), -0.01);
  OffAxisContact same{ball(6, 5, 1), 5e-3, Accuracy::Coarse};
  EXPECT_NEAR(*same.excess(2e-3, 4e-3), 0, 1e-6);
  OffAxisContact none{Specimen{}, 5e-3, Accuracy::Coarse};
  EXPECT_EQ(*none.excess(2e-3, 4e-3), 0);
}

// A block bonded at its base sinks less than a half space; twice as stiff, half as much less.
TEST(OffAxisContactTest, TheBlocksConstantTakesSinkingAwayAndGoesByTheModulus) {
  OffAxisContact soft{Specimen{}, 0, Accuracy::Coarse};
  EXPECT_LT(soft.block_constant(), 0);
  Specimen stiff;
  stiff.block.youngs_modulus *= 2;
  OffAxisContact other{stiff, 0, Accuracy::Coarse};
  EXPECT_NEAR(other.block_constant() / soft.block_constant(), 0.5, 1e-4);
}

// The constant is fitted at one depth; the axisymmetric solver's own error there is 0.1 %.
TEST(OffAxisContactTest, ThePlainBlockIsThatOfTheAxisymmetricSolver) {
  const CurveRequest request{
      .specimen = {}, .indentations = {1e-3, 2e-3, 4e-3}, .with_error = false};
  const auto wanted = solve_curve(request);
  ASSERT_TRUE(wanted);
  const OffAxisContact contact{Specimen{}, 0, Accuracy::Coarse};
  for (const CurveRow& row : wanted->rows) {
    EXPECT_NEAR(contact.plain(0).press(row.indentation).force / row.force, 1, 1.5e-3);
  }
  EXPECT_LT(contact.plain(16).press(2e-3).force, contact.plain(0).press(2e-3).force);
}

}  // namespace
}  // namespace palp::fem
