#include "netem/model/kernel_model.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/netem/model/impairment_builders.h"
#include "tests/netem/model/outcomes.h"

namespace palp::netem {
namespace {

double share_of_copies(const char* words) {
  constexpr std::size_t kCount = 100'000;
  double copies = 0;
  for (const PacketOutcome& outcome :
       outcomes_of(*parse_impairment(words, Mode::Netem61), kCount)) {
    copies += static_cast<double>(outcome.count - 1);
  }
  return copies / kCount;
}

TEST(KernelModelTest, TheCorrelationOfDuplicatesAloneIsNotSentByTc) {
  // 10 % as asked; the kernel's way of correlation would leave a thousandth.
  EXPECT_NEAR(share_of_copies("duplicate 10% 50%"), 0.1, 4 * std::sqrt(0.09 / 100'000));
  EXPECT_LT(share_of_copies("duplicate 10% 50% delay 20ms 1ms 25%"), 0.02);
}

}  // namespace
}  // namespace palp::netem
