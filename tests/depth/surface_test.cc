#include "depth/surface.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "common/core/random.h"
#include "patient_site/phantom.h"

namespace palp::depth {
namespace {

/// A slow press of a table with its surface at `surface`: points every 50 um, `count` samples each.
std::vector<ContactPoint> press(const patient::ForceTable& table,
                                double surface,
                                double noise = 0,
                                std::uint64_t seed = 1) {
  std::vector<ContactPoint> points;
  for (int i = -60; i <= 78; ++i) {
    const double d = i * 50e-6;
    const double force =
        table.force(d) + noise * random_normal(seed, 7, static_cast<unsigned>(i + 60));
    points.push_back({surface + d, force, 0, 1});
  }
  return points;
}

TEST(SurfaceTest, FindsItInCleanData) {
  for (const char* name : {"none", "paper-25mm", "paper-10mm", "paper-5mm"}) {
    const auto phantom = patient::make_phantom(name);
    ASSERT_TRUE(phantom);
    for (const double surface : {0.0, 1.7e-3, -2.3e-3}) {
      const auto points = press(phantom->over, surface);
      const auto law =
          find_surface({.points = points, .first_contact = surface + 0.9e-3, .noise = 1e-5}, {});
      ASSERT_TRUE(law) << name;
      EXPECT_NEAR(law->surface, surface, 10e-6) << name;
      for (double d = 0.5e-3; d < 3.9e-3; d += 0.1e-3) {
        EXPECT_NEAR(law->force(d), phantom->over.force(d), 0.03 * phantom->over.force(d)) << name;
      }
    }
  }
}

TEST(SurfaceTest, FindsItInNoisyDataOfTheKnownTissue) {
  const auto phantom = patient::make_phantom("paper-15mm");
  ASSERT_TRUE(phantom);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto points = press(phantom->over, 0, 0.005, seed);
    const auto law = find_surface({.points = points, .first_contact = 0.9e-3, .noise = 0.005}, {});
    ASSERT_TRUE(law);
    EXPECT_NEAR(law->surface, 0, 0.12e-3) << seed;
  }
}

TEST(SurfaceTest, CleanDataOverruleWhatIsExpectedOfTissue) {
  for (const double factor : {0.5, 2.5}) {
    const auto phantom = patient::make_phantom("none");
    ASSERT_TRUE(phantom);
    std::vector<ContactPoint> points = press(phantom->over, 0);
    for (ContactPoint& point : points) point.force *= factor;
    const auto law = find_surface({.points = points, .first_contact = 0.9e-3, .noise = 1e-5}, {});
    ASSERT_TRUE(law);
    EXPECT_NEAR(law->surface, 0, 10e-6);
    EXPECT_NEAR(law->force(1e-3), factor * phantom->over.force(1e-3), 0.02 * 0.0587 * factor);
  }
}

TEST(SurfaceTest, AirAloneHasNoSurface) {
  std::vector<ContactPoint> points;
  for (int i = 0; i < 100; ++i) points.push_back({i * 50e-6, 0, 0, 1});
  EXPECT_FALSE(find_surface({.points = points, .first_contact = 4e-3, .noise = 0.01}, {}));
  EXPECT_FALSE(find_surface({.points = {}, .first_contact = 0, .noise = 0.01}, {}));
}

}  // namespace
}  // namespace palp::depth
