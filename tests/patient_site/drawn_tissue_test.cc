#include "patient_site/drawn_tissue.h"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp::patient {
namespace {

Phantom any_tissue() { return drawn_tissue(*rc::gen::arbitrary<std::uint64_t>()); }

RC_GTEST_PROP(DrawnTissueTest, EveryOneIsMonotoneAndReachesAsDeepAsAGateLetsGo, ()) {
  const Phantom tissue = any_tissue();
  RC_ASSERT(tissue.depth_max() >= 8e-3);
  for (const ForceTable* table : {&tissue.plain, &tissue.over}) {
    RC_ASSERT(table->force(0) == 0);
    for (int i = 1; i <= 800; ++i) RC_ASSERT(table->force(i * 1e-5) > table->force((i - 1) * 1e-5));
  }
}

RC_GTEST_PROP(DrawnTissueTest, StiffnessIsInTheRangeThatIsSaid, ()) {
  const Phantom tissue = any_tissue();
  const double a = tissue.plain.force(3e-3) / 3e-3;  // [N/m]
  const double b = tissue.over.force(3e-3) / 3e-3;   // [N/m]
  RC_ASSERT(a >= 20 * (1 - 1e-6) && a <= 1500 * (1 + 1e-6));
  RC_ASSERT(b / a >= 1.1 * (1 - 1e-6) && b / a <= 2.5 * (1 + 1e-6));
  double share = 0;
  for (const Relaxation::Part& part : tissue.relaxation.parts) share += part.share;
  RC_ASSERT(share == 0 || (share > 0.049 && share < 0.351));
}

TEST(DrawnTissueTest, SomeSoftenAndSomeBend) {
  int soften = 0;
  int bend = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const ForceTable table = drawn_tissue(seed).plain;
    const double first = table.force(0.5e-3) / 0.5e-3;
    if (table.derivative(3e-3) < 0.9 * first) ++soften;
    for (double d = 0.6e-3; d < 4e-3; d += 0.1e-3) {
      if (table.derivative(d + 0.4e-3) < 1.4 * table.derivative(d - 0.2e-3)) continue;
      ++bend;
      break;
    }
  }
  EXPECT_GT(soften, 10);
  EXPECT_GT(bend, 20);
}

TEST(DrawnTissueTest, ASeedIsATissue) {
  EXPECT_EQ(drawn_tissue(7).plain.force(2e-3), drawn_tissue(7).plain.force(2e-3));
  EXPECT_NE(drawn_tissue(7).plain.force(2e-3), drawn_tissue(8).plain.force(2e-3));
}

TEST(DrawnTissueTest, IsAPhantomByName) {
  const auto tissue = make_phantom("random:7");
  ASSERT_TRUE(tissue);
  EXPECT_EQ(tissue->name, "random:7");
  for (const char* wrong : {"random:", "random:x", "random:-1", "random:7 "}) {
    EXPECT_FALSE(make_phantom(wrong)) << wrong;
  }
}

}  // namespace
}  // namespace palp::patient
