#include "patient_site/tissue_field.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "patient_site/phantom.h"

namespace palp::patient {
namespace {

constexpr double kDeep = 3e-3;  // [m]

const Phantom& shallow_ball() {
  static const Phantom phantom = *make_phantom("paper-5mm");
  return phantom;
}

TEST(InclusionShareTest, FallsFromOneOnTheAxisToNothingAtItsReach) {
  EXPECT_EQ(inclusion_share(0), 1);
  EXPECT_EQ(inclusion_share(kInclusionReach), 0);
  EXPECT_EQ(inclusion_share(distance(kSiteA, kSiteB)), 0) << "A is plain";
  double before = 1;
  for (double at = 0.1e-3; at < kInclusionReach; at += 0.1e-3) {
    const double share = inclusion_share(at);
    EXPECT_LT(share, before) << at;
    before = share;
  }
}

TEST(InclusionShareTest, HasAContinuousSlope) {
  constexpr double kStep = 1e-6;  // [m]
  const auto slope = [](double at) {
    return (inclusion_share(at + kStep) - inclusion_share(at - kStep)) / (2 * kStep);
  };
  EXPECT_NEAR(inclusion_share(kStep), inclusion_share(-kStep), 1e-15) << "level on the axis";
  for (double at = 0.1e-3; at < 20e-3; at += 0.1e-3) {
    EXPECT_NEAR(slope(at + 2 * kStep), slope(at), 0.5) << at;  // [1/m], of some 100
  }
}

TEST(TissueFieldTest, TheForceOverALineAcrossAnInclusionIsABump) {
  const auto field = make_field(shallow_ball(), 0);
  const double plain = shallow_ball().plain.force(kDeep);
  const double over = shallow_ball().over.force(kDeep);
  double before = plain;
  for (int tenths = 0; tenths <= 200; ++tenths) {
    const double force = field->elastic_force({tenths * 0.1e-3, 0}, kDeep);
    EXPECT_GE(force, before) << tenths;
    EXPECT_LE(force - before, 0.02 * (over - plain)) << tenths;
    EXPECT_NEAR(field->elastic_force({(400 - tenths) * 0.1e-3, 0}, kDeep), force, 1e-12);
    EXPECT_NEAR(field->elastic_force({20e-3, (200 - tenths) * 0.1e-3}, kDeep), force, 1e-12);
    before = force;
  }
  EXPECT_EQ(before, over);
}

TEST(TissueFieldTest, AForceOfATelegramsPlaceIsThatOfTheAxis) {
  const auto field = make_field(shallow_ball(), 0);
  const Place rounded{double{static_cast<float>(kSiteB.x)}, 0};
  ASSERT_NE(rounded, kSiteB);
  EXPECT_EQ(field->elastic_force(rounded, kDeep), shallow_ball().over.force(kDeep));
}

TEST(TissueFieldTest, BetweenAxisAndReachTheLogarithmsAreMixed) {
  const auto field = make_field(shallow_ball(), 0);
  for (const double d : {0.3e-3, 1e-3, 4e-3}) {
    const double plain = shallow_ball().plain.force(d);
    const double excess = std::log(shallow_ball().over.force(d) / plain);
    const double expected = plain * std::exp(excess * inclusion_share(5e-3));
    EXPECT_NEAR(field->elastic_force({15e-3, 0}, d), expected, 0.3e-3) << d;  // the 1 mN
  }
}

TEST(TissueFieldTest, RateAddsAShareAndNeverPulls) {
  const auto field = make_field(shallow_ball(), 0.5);
  const double rest = field->elastic_force(kSiteB, kDeep);
  EXPECT_DOUBLE_EQ(field->force(kSiteB, kDeep, 0.1), 1.05 * rest);
  EXPECT_EQ(field->force(kSiteB, kDeep, -3), 0);
  EXPECT_EQ(field->force(kSiteB, -1e-6, 0.1), 0);
}

void expect_stiffness_is_the_derivative(const TissueField& field, const Place& place) {
  constexpr double kStep = 1e-7;  // [m]
  for (const double d : {0.61e-3, 1.37e-3, 2.83e-3}) {
    const double rise =
        (field.elastic_force(place, d + kStep) - field.elastic_force(place, d - kStep)) /
        (2 * kStep);
    EXPECT_NEAR(field.stiffness(place, d), rise, 1e-4 * rise + 1e-3);
  }
}

TEST(TissueFieldTest, StiffnessIsTheDerivativeEverywhere) {
  const auto field = make_field(shallow_ball(), 0);
  for (const Place& place : {kSiteA, kSiteB, Place{16e-3, 3e-3}}) {
    expect_stiffness_is_the_derivative(*field, place);
  }
}

ForceTable scaled(double factor) {
  std::vector<ForceRow> rows{shallow_ball().plain.rows().begin(),
                             shallow_ball().plain.rows().end()};
  for (ForceRow& row : rows) row.force *= factor;
  return *ForceTable::make(std::move(rows));
}

/// A smooth bump of the logarithm, looked at on a grid of 5 mm.
double bump(const Place& place) {
  const double square = (place.x * place.x + place.y * place.y) / (10e-3 * 10e-3);
  return 1 + 0.6 * std::exp(-square);
}

std::vector<PlacedCurve> grid() {
  std::vector<PlacedCurve> curves;
  for (int i = -3; i <= 3; ++i) {
    for (int j = -3; j <= 3; ++j) {
      const Place place{5e-3 * i, 5e-3 * j};
      curves.push_back({place, scaled(bump(place))});
    }
  }
  return curves;
}

TEST(SurveyFieldTest, IsItsCurvesAtTheirPlaces) {
  const std::vector<PlacedCurve> curves = grid();
  const SurveyField field{curves, 0};
  for (const PlacedCurve& curve : curves) {
    EXPECT_EQ(field.elastic_force(curve.place, kDeep), curve.table.force(kDeep));
  }
}

TEST(SurveyFieldTest, ComesNearTheTissueBetweenThem) {
  const std::vector<PlacedCurve> curves = grid();
  const SurveyField field{curves, 0};
  for (int i = -14; i <= 14; ++i) {
    const Place place{1.07e-3 * i, 0.71e-3 * i};
    const double expected = bump(place) * shallow_ball().plain.force(kDeep);
    EXPECT_NEAR(field.elastic_force(place, kDeep), expected, 0.03 * expected) << i;
  }
}

TEST(SurveyFieldTest, HasAContinuousSlopeAlsoAcrossItsPlaces) {
  const std::vector<PlacedCurve> curves = grid();
  const SurveyField field{curves, 0};
  constexpr double kStep = 1e-5;  // [m]
  const auto slope = [&](double x) {
    return (field.elastic_force({x + kStep, 0.4e-3}, kDeep) -
            field.elastic_force({x - kStep, 0.4e-3}, kDeep)) /
           (2 * kStep);
  };
  const auto across = [&](double x) {
    return (field.elastic_force({x + kStep, 0}, kDeep) - field.elastic_force({x, 0}, kDeep)) /
           kStep;
  };
  for (double x = -15e-3; x < 15e-3; x += 0.25e-3) {
    EXPECT_NEAR(slope(x + kStep), slope(x), 0.5) << x;  // [N/m], of some 20
  }
  EXPECT_NEAR(across(5e-3), across(5e-3 - kStep), 0.5) << "through a place itself";
}

TEST(SurveyFieldTest, FarAwayItIsAMeanOfAllAndAlwaysAForce) {
  const std::vector<PlacedCurve> curves = grid();
  const SurveyField field{curves, 0};
  const double low = shallow_ball().plain.force(kDeep);
  for (const Place& place : {Place{0.25, 0.25}, Place{-0.25, 0}, Place{0, 60e-3}}) {
    const double force = field.elastic_force(place, kDeep);
    EXPECT_GT(force, low);
    EXPECT_LT(force, 1.6 * low);
  }
  EXPECT_EQ(field.elastic_force({3e-3, 1e-3}, 0), 0);
  EXPECT_EQ(field.elastic_force({3e-3, 1e-3}, std::nan("")), 0);
}

TEST(SurveyFieldTest, PlacesInALineSayNothingAcrossIt) {
  std::vector<PlacedCurve> curves;
  for (int i = 0; i < 5; ++i) curves.push_back({{5e-3 * i, 0}, scaled(1 + 0.1 * i)});
  const SurveyField field{curves, 0};
  for (const double y : {1e-3, 4e-3}) {
    EXPECT_NEAR(
        field.elastic_force({8e-3, y}, kDeep), field.elastic_force({8e-3, -y}, kDeep), 1e-12);
  }
  expect_stiffness_is_the_derivative(field, {8e-3, 1e-3});
}

TEST(SurveyFieldTest, WhereASlopeWouldLeadBeyondTheStiffestOrSoftestPlaceItIsThatPlaces) {
  const std::vector<PlacedCurve> curves{
      {{0, 0}, scaled(1)}, {{10e-3, 0}, scaled(2)}, {{20e-3, 0}, scaled(4)}};
  const SurveyField field{curves, 0};
  for (int i = 1; i <= 8; ++i) {
    EXPECT_LE(field.elastic_force({20e-3 + 0.5e-3 * i, 0}, kDeep), curves[2].table.force(kDeep));
    EXPECT_GE(field.elastic_force({-0.5e-3 * i, 0}, kDeep), curves[0].table.force(kDeep));
  }
  EXPECT_EQ(field.elastic_force({22e-3, 0}, kDeep), curves[2].table.force(kDeep));
  EXPECT_EQ(field.elastic_force({-2e-3, 0}, kDeep), curves[0].table.force(kDeep));
}

TEST(SurveyFieldTest, AnyPlacesGiveAForceBetweenTheLeastAndTheMostOfTheirs) {
  rc::check([] {
    std::vector<PlacedCurve> curves;
    for (int i = 0; i < 6; ++i) {
      const Place place{*rc::gen::inRange(-40, 40) * 1e-3, *rc::gen::inRange(-40, 40) * 1e-3};
      bool apart = true;
      for (const PlacedCurve& other : curves) {
        apart = apart && distance(other.place, place) >= kPlacesApart;
      }
      if (apart) curves.push_back({place, scaled(*rc::gen::inRange(1, 50) * 0.1)});
    }
    RC_PRE(curves.size() >= 2);
    const SurveyField field{curves, 0};
    const auto softer = [](const PlacedCurve& a, const PlacedCurve& b) {
      return a.table.force(kDeep) < b.table.force(kDeep);
    };
    const auto [least, most] = std::ranges::minmax_element(curves, softer);
    for (int i = -20; i <= 20; ++i) {
      const double force = field.elastic_force({2.3e-3 * i, 1.7e-3 * i - 4e-3}, kDeep);
      RC_ASSERT(force >= least->table.force(kDeep) && force <= most->table.force(kDeep));
    }
  });
}

}  // namespace
}  // namespace palp::patient
