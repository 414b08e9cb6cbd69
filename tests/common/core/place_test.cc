#include "common/core/place.h"

#include <limits>

#include <gtest/gtest.h>

namespace palp {
namespace {

TEST(PlaceTest, DistanceIsThatOfThePlane) {
  EXPECT_DOUBLE_EQ(distance({3e-3, 0}, {0, 4e-3}), 5e-3);
  EXPECT_EQ(distance({-20e-3, 0}, kSiteA), 20e-3) << "along an axis nothing is rounded";
}

TEST(PlaceTest, AWayEndsExactlyWhereItEnds) {
  const Place from{1.1e-3, -7.3e-3};
  const Place to{0.1, 0.3e-3};
  EXPECT_EQ(between(from, to, 0), from);
  EXPECT_EQ(between(from, to, 1), to);
  EXPECT_NEAR(between(from, to, 0.25).x, 25.825e-3, 1e-15);
}

TEST(PlaceTest, NamedSitesAreAMillimetreWide) {
  EXPECT_EQ(site_at({0.7e-3, -0.7e-3}), Site::A);
  EXPECT_EQ(site_at({20e-3, 1e-3}), Site::B);
  EXPECT_EQ(site_at({20e-3, 1.01e-3}), Site::Other);
  EXPECT_EQ(site_at({10e-3, 0}), Site::Other);
}

TEST(PlaceTest, AnythingNotFiniteIsNoPlace) {
  EXPECT_TRUE(is_finite({1, -1}));
  EXPECT_FALSE(is_finite({std::numeric_limits<double>::quiet_NaN(), 0}));
  EXPECT_FALSE(is_finite({0, -std::numeric_limits<double>::infinity()}));
}

}  // namespace
}  // namespace palp
