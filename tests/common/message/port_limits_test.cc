#include "common/message/port_limits.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "common/message/range.h"

namespace palp::message {
namespace {

constexpr double kBad[]{1e300,
                        -1e300,
                        std::numeric_limits<double>::infinity(),
                        -std::numeric_limits<double>::infinity(),
                        std::numeric_limits<double>::quiet_NaN()};

TEST(PortLimitsTest, WhatIsWithinStaysAsItIs) {
  PortSample sample{.position = kLengthMax,
                    .velocity = -kSpeedMax,
                    .force = 1,
                    .payload = WavePayload{-kSumMax, 3}};
  EXPECT_FALSE(keep_limits(sample));
  EXPECT_EQ(sample.position, kLengthMax);
  EXPECT_EQ(std::get<WavePayload>(sample.payload).wave_integral, -kSumMax);
}

TEST(PortLimitsTest, WhateverALawComputesCanBeSent) {
  for (const double bad : kBad) {
    for (int which = 0; which < 5; ++which) {
      PortSample sample{.position = 1e-3, .velocity = 0, .force = 1, .payload = {}};
      if (which == 0) sample.position = bad;
      if (which == 1) sample.velocity = bad;
      if (which == 2) sample.force = bad;
      if (which == 3) sample.payload = TdpaPayload{bad};
      if (which == 4) sample.payload = ModelPayload{.version = 1, .c = {0, bad}, .surface = bad};
      EXPECT_FALSE(in_range<Form::Wire>(sample));
      EXPECT_TRUE(keep_limits(sample));
      EXPECT_TRUE(in_range<Form::Wire>(sample)) << which << " " << bad;
      EXPECT_EQ(keep_limits(sample), false) << "once is enough";
    }
  }
}

}  // namespace
}  // namespace palp::message
