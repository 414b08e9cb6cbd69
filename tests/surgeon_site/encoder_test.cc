#include "surgeon_site/encoder.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp::surgeon {
namespace {

using std::chrono_literals::operator""ms;

TEST(EncoderTest, TellsWholeStepsAndTheirRate) {
  Encoder encoder{1e-4, 60, 0};
  double position = 0;
  for (int i = 0; i < 200; ++i) {
    position += 0.02 * 1e-3;  // 20 mm/s
    encoder.sample(position, 1ms);
    ASSERT_NEAR(encoder.position(), position, 0.5e-4 + 1e-12);
    const double steps = encoder.position() / 1e-4;
    ASSERT_NEAR(steps, std::round(steps), 1e-9);
  }
  EXPECT_NEAR(encoder.velocity(), 0.02, 0.02);
  for (int i = 0; i < 200; ++i) encoder.sample(position, 1ms);
  EXPECT_NEAR(encoder.velocity(), 0, 1e-9);
}

TEST(EncoderTest, TheRateIsTheSameInHalfSteps) {
  Encoder whole{1e-6, 60, 0}, halves{1e-6, 60, 0};
  for (int i = 1; i <= 50; ++i) {
    whole.sample(1e-3 * i, 1ms);
    halves.sample(1e-3 * (i - 0.5), Duration{500'000});
    halves.sample(1e-3 * i, Duration{500'000});
  }
  EXPECT_NEAR(whole.velocity(), halves.velocity(), 1e-3);
}

}  // namespace
}  // namespace palp::surgeon
