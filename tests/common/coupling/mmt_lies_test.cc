// Goal: no two models that a peer tells in turn make a wall or a step, whatever lies between them.
// Method: a hand that moves or rests by itself; what is shown is looked at after each tick.

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "common/coupling/mmt.h"

namespace palp::coupling {
namespace {

constexpr double kPeriod = 1e-3;  // [s]

/// A law that is told one model after the other.
class Told {
 public:
  explicit Told(double position) { law_.begin_epoch(position); }
  /// A tick with the hand at `position` [m].
  void step(double position, ModelPayload model) {
    model.version = ++version_;
    Incoming told;
    told.fresh = true;
    told.sample.payload = model;
    const std::array arrived{told};
    const SurgeonInput in{.state = SiteState::Engaged,
                          .position = position,
                          .force_applied = force_,
                          .arrived = arrived};
    force_ = law_.step(in, std::chrono::milliseconds{1}).force;
  }
  [[nodiscard]] double force() const { return force_; }                            ///< [N], given
  [[nodiscard]] double surface() const { return law_.shown().elastic().surface; }  ///< [m]
  /// [N/m], steepest that is shown down to 20 mm.
  [[nodiscard]] double steepest() const {
    double most = 0;
    for (int i = 1; i <= 200; ++i) most = std::max(most, law_.shown().elastic().slope(1e-4 * i));
    return most * quick_gain(law_.shown().relaxing());
  }

 private:
  MmtSurgeon law_{MmtConfig{}};
  std::uint32_t version_{};
  double force_{};  ///< [N]
};

/// A model that is huge where it reaches no depth, and a soft one that reaches deep.
TEST(MmtLiesTest, NothingBetweenTwoModelsIsSteeperThanADeviceMayShow) {
  for (std::size_t term = 0; term < kModelTerms; ++term) {
    for (const double huge : {0.3, 30.0, 3e4}) {
      const ModelPayload soft{.c = {0.03}, .depth_max = 8e-3};
      ModelPayload wall = soft;
      wall.c[term] = huge;
      Told told{-1e-3};
      for (int tick = 0; tick < 3000; ++tick) {
        const double position = 2e-3 - 3e-3 * std::cos(8e-3 * tick);
        told.step(position, tick / 50 % 2 == 0 ? soft : wall);
        ASSERT_LE(told.steepest(), MmtConfig{}.slope_max * (1 + 1e-6))
            << term << ", " << huge << " N, tick " << tick;
      }
    }
  }
}

/// A tissue that is hardly touched, and a peer that tells it was none.
TEST(MmtLiesTest, ATissueThatIsToldAwayIsGoneSoon) {
  Told told{-1e-3};
  const ModelPayload tissue{.c = {1.45}, .depth_max = 3e-3};
  const ModelPayload elsewhere{.c = {1.45}, .surface = 59e-3, .depth_max = 3e-3};
  for (int tick = 0; tick < 1200; ++tick)
    told.step(std::min(0.0, -1e-3 + 1e-6 * tick) + 25e-6, tissue);
  EXPECT_GT(told.force(), 0.025);
  for (int tick = 0; tick < 500; ++tick) told.step(25e-6, elsewhere);
  EXPECT_LT(told.force(), 1e-3);
}

/// The same force here, of a tissue whose surface is far above and of one that is hard.
TEST(MmtLiesTest, NoForceIsTakenFromAHandAtRestFasterThanItMayFall) {
  const double force = 2;  // [N]
  ModelPayload far{.surface = -45e-3, .depth_max = 8e-3};
  far.c[0] = force / 45e-3 * kModelDepthScale;
  ModelPayload hard{.surface = -force / 1500, .depth_max = 8e-3};
  hard.c[0] = 1500 * kModelDepthScale;
  const double fall = MmtConfig{}.fall * kPeriod;  // [N]
  Told told{0};
  double most = 0;
  for (int tick = 0; tick < 8000; ++tick) {
    const double before = told.force();
    told.step(0, tick < 4000 ? far : hard);
    most = std::max(most, told.force());
    ASSERT_GE(told.force(), before - fall * (1 + 1e-6)) << tick;
  }
  EXPECT_GT(most, 0.5) << "or nothing was shown";
  EXPECT_NEAR(told.surface(), hard.surface, 0.5e-3) << "and in the end it is the hard one";
}

}  // namespace
}  // namespace palp::coupling
