#include "common/coupling/outside_law.h"

#include <utility>

#include <gtest/gtest.h>

#include "common/coupling/any_coupling.h"

namespace palp::coupling {
namespace {

constexpr Duration kTick = std::chrono::milliseconds{1};

/// A spring from where the epoch began; each step makes it stiffer by 1 N/m.
class StiffeningSpring {
 public:
  void begin_epoch(double position) noexcept { began_ = position; }
  SurgeonOutput step(const SurgeonInput& in, const Lapse& /*lapse*/) noexcept {
    stiffness_ += 1;
    return {stiffness_ * (in.position - began_), {}};
  }

 private:
  double began_{};      ///< [m]
  double stiffness_{};  ///< [N/m]
};

SurgeonInput at(double position) {
  SurgeonInput in;
  in.position = position;
  return in;
}

TEST(OutsideLawTest, StepsAsAnyLawDoes) {
  SurgeonCoupling law{OutsideSurgeon{StiffeningSpring{}}};
  begin_epoch(law, 1);
  EXPECT_EQ(step(law, at(3), kTick).force, 2);
  EXPECT_EQ(step(law, at(3), kTick).force, 4);
  PatientCoupling follows{OutsidePatient{DirectPatient{{}}}};
  begin_epoch(follows, 0.007);
  EXPECT_EQ(step(follows, PatientInput{}, kTick).target_position, 0.007);
}

TEST(OutsideLawTest, ACopyGoesOnByItself) {
  OutsideSurgeon law{StiffeningSpring{}};
  law.begin_epoch(0);
  (void)law.step(at(1), kTick);
  OutsideSurgeon copy{law};
  EXPECT_EQ(copy.step(at(1), kTick).force, 2);
  EXPECT_EQ(copy.step(at(1), kTick).force, 3);
  EXPECT_EQ(law.step(at(1), kTick).force, 2);
  law = copy;
  EXPECT_EQ(law.step(at(1), kTick).force, 4);
  EXPECT_EQ(copy.step(at(1), kTick).force, 4);
  const OutsideSurgeon moved{std::move(law)};
  EXPECT_EQ(OutsideSurgeon{moved}.step(at(1), kTick).force, 5);
}

}  // namespace
}  // namespace palp::coupling
