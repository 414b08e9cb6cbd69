#include "depth/cubic_fit.h"

#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "depth/paper_hash.h"
#include "patient_site/phantom.h"

namespace palp::depth {
namespace {

TEST(CubicFitTest, RecoversEveryCubic) {
  rc::check([] {
    const auto coefficient = [] { return *rc::gen::inRange(-1000, 1000) * 1e-4; };
    const Cubic cubic{{coefficient(), coefficient(), coefficient(), coefficient()}};
    std::vector<CurvePoint> points;
    for (int i = 0; i <= 16; ++i) points.push_back({i * 0.25e-3, cubic.force(i * 0.25e-3)});
    const auto fit = fit_cubic(points);
    RC_ASSERT(fit.has_value());
    for (std::size_t i = 0; i < 4; ++i) RC_ASSERT(std::abs(fit->c[i] - cubic.c[i]) < 1e-9);
    RC_ASSERT(std::abs(hash(*fit) - cubic.force(1e-3)) < 1e-9);
  });
}

TEST(CubicFitTest, ThreePointsAreNoCubic) {
  const std::vector<CurvePoint> points{{0, 0}, {1e-3, 1}, {2e-3, 2}};
  EXPECT_FALSE(fit_cubic(points));
  EXPECT_FALSE(fit_cubic({}));
}

// h of the shared curves: least squares over 0 to 4 mm, points evenly spaced.
TEST(CubicFitTest, GivesTheKnownHashOfTheSharedCurves) {
  struct Known {
    const char* phantom;
    double hash;  // [N]
  };
  for (const Known& known : {Known{"paper-5mm", 0.09192},
                             Known{"paper-10mm", 0.06885},
                             Known{"paper-15mm", 0.06381},
                             Known{"paper-20mm", 0.06187},
                             Known{"paper-25mm", 0.06091},
                             Known{"none", 0.05908}}) {
    const auto phantom = patient::make_phantom(known.phantom);
    ASSERT_TRUE(phantom);
    for (const double spacing : {0.25e-3, 0.1e-3, 0.02e-3}) {
      std::vector<CurvePoint> points;
      for (double d = 0; d < 4e-3 + spacing / 2; d += spacing) {
        points.push_back({d, phantom->over.force(d)});
      }
      EXPECT_NEAR(hash(*fit_cubic(points)), known.hash, 0.001 * known.hash)
          << known.phantom << " every " << spacing;
    }
  }
}

}  // namespace
}  // namespace palp::depth
