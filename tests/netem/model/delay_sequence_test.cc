#include "netem/model/delay_sequence.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/netem/model/impairment_builders.h"

namespace palp::netem {
namespace {

using std::chrono::milliseconds;

/// Goal: the memory of 40 ms is one of time, whatever was drawn ahead. Method: the sender changes
/// between 1 ms and 40 ms after every 40 datagrams; delays that are so far apart correlate by
/// exp(-gap/40 ms), within four standard errors of 20,000 pairs.
TEST(DelaySequenceTest, CorrelatesByTheGapThatIsNotTheOneThatWas) {
  const PreparedLaw law{impaired("delay 100ms 10ms distribution normal correlation-time 40ms")};
  DelaySequence sequence{law, Streams{7, Direction::Up}, TimePoint{}};
  constexpr std::array kGaps{milliseconds{1}, milliseconds{40}};
  constexpr std::uint64_t kRun = 40;
  constexpr std::uint64_t kCount = 40'000;
  std::array<double, 2> products{};
  std::array<double, 2> pairs{};
  double before = 0;
  for (std::uint64_t k = 0; k < kCount; ++k) {
    const std::size_t which = k / kRun % 2;
    sequence.begin(k, k > 0 ? Duration{kGaps[which]} : Duration{});
    const double z = (seconds(sequence.draw(0, TimePoint{}).delay) - 0.1) / 0.01;
    products[which] += k > 0 ? before * z : 0;
    pairs[which] += k > 0 ? 1 : 0;
    before = z;
  }
  for (std::size_t which = 0; which < 2; ++which) {
    const double expected = std::exp(-seconds(kGaps[which]) / 0.04);
    // The product of two normals scatters by sqrt(1 + rho^2); those at 1 ms hang together in runs.
    const double error = std::sqrt((1 + expected * expected) / pairs[which]) *
                         (which == 0 ? std::sqrt(static_cast<double>(kRun)) : 1);
    EXPECT_NEAR(products[which] / pairs[which], expected, 4 * error) << which;
  }
}

}  // namespace
}  // namespace palp::netem
