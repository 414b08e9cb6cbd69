#include "common/coupling/self_oscillation.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace palp::coupling {
namespace {

/// A hand that swings about 2 mm depth.
struct Swing {
  double frequency{8};       ///< [Hz]
  double amplitude{0.3e-3};  ///< [m]
  double decay{0};           ///< [1/s]
  double noise{0};           ///< [m], of the encoder
  bool pressed{true};
};

/// How often it is found in a second.
int found(const Swing& swing) {
  SelfOscillation oscillation;
  int count = 0;
  for (int tick = 0; tick < 1000; ++tick) {
    const double at = 1e-3 * tick;
    const double phase = 2 * std::numbers::pi * swing.frequency * at;
    const double way = swing.amplitude * std::exp(-swing.decay * at) * std::sin(phase);
    const double position = 2e-3 + way + (tick % 2 == 0 ? swing.noise : 0);
    count += oscillation.step(position, swing.pressed, 1e-3) ? 1 : 0;
  }
  return count;
}

TEST(SelfOscillationTest, EachTurnOfAHandThatSwingsIsFoundFromTheThirdOn) {
  for (const double frequency : {6.0, 8.0, 15.0, 30.0}) {
    const int turns = static_cast<int>(2 * frequency);
    EXPECT_NEAR(found({.frequency = frequency}), turns - 2, 1) << frequency;
    EXPECT_NEAR(found({.frequency = frequency, .decay = -1}), turns - 2, 1) << frequency;
  }
}

TEST(SelfOscillationTest, ABounceThatDiesOutIsNone) {
  EXPECT_EQ(found({.amplitude = 2e-3, .decay = 15}), 0);
}

TEST(SelfOscillationTest, AHandThatTapsOrTremblesDoesItOfItsOwnWill) {
  EXPECT_EQ(found({.frequency = 4, .amplitude = 4e-3}), 0);
  EXPECT_EQ(found({.frequency = 10, .amplitude = 0.05e-3}), 0);
}

TEST(SelfOscillationTest, NothingSwingsAgainstAir) { EXPECT_EQ(found({.pressed = false}), 0); }

TEST(SelfOscillationTest, AnEncoderThatCannotDecideIsNoSwing) {
  EXPECT_EQ(found({.amplitude = 0, .noise = 30e-6}), 0);
  EXPECT_NEAR(found({.noise = 30e-6}), 14, 1);
}

}  // namespace
}  // namespace palp::coupling
