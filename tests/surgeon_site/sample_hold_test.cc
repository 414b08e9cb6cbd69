#include "surgeon_site/sample_hold.h"

#include <gtest/gtest.h>

#include "common/core/random.h"

namespace palp::surgeon {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

Incoming sample(std::uint64_t number, TimePoint arrived_at) {
  Incoming made;
  made.number = number;
  made.arrived_at = arrived_at;
  return made;
}

/// A path that brings none, one or a bunch a millisecond, and what is let through of it.
class Path {
 public:
  explicit Path(std::uint64_t seed) : draws_{seed, 1} {}

  void run(Duration span, Duration wanted) {
    for (const TimePoint end = now + span; now < end; now += 1ms) {
      arrived_.clear();
      const double chance = draws_.uniform(tick_++);
      const int count = chance < 0.1 ? 0 : chance < 0.95 ? 1 : 7;
      for (int i = 0; i < count; ++i) {
        arrived_.push_back(sample(++sent, now));
      }
      for (const Incoming& one : hold.pass(arrived_, wanted, now)) {
        EXPECT_EQ(one.number, passed + 1);
        passed = one.number;
        least = std::min(least, now - one.arrived_at);
        most = std::max(most, now - one.arrived_at);
      }
    }
  }
  void measure_anew() {
    least = Duration::max();
    most = Duration{0};
  }

  SampleHold hold;
  TimePoint now{100s};
  std::uint64_t sent{};
  std::uint64_t passed{};
  Duration least{Duration::max()};  ///< that one was held
  Duration most{};

 private:
  RandomStream draws_;
  std::uint64_t tick_{};
  std::vector<Incoming> arrived_;
};

TEST(SampleHoldTest, WithoutAWishNothingWaits) {
  Path path{1};
  path.run(1s, Duration{0});
  EXPECT_EQ(path.passed, path.sent);
  EXPECT_EQ(path.most, Duration{0});
}

TEST(SampleHoldTest, EachSampleWaitsAsLongAsIsWantedAndNoneIsLost) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Path path{seed};
    path.run(100ms, Duration{0});
    path.run(3s, 40ms);
    path.measure_anew();
    path.run(1s, 40ms);
    EXPECT_EQ(path.least, 40ms);
    EXPECT_LE(path.most, 41ms);
    path.run(3s, Duration{0});
    EXPECT_EQ(path.passed, path.sent) << "what waits comes when nothing is to wait any more";
  }
}

TEST(SampleHoldTest, IsReachedSoSlowlyThatAHandFeelsNoStep) {
  Path path{3};
  path.run(100ms, Duration{0});
  path.run(500ms, 100ms);
  EXPECT_NEAR(seconds(path.hold.hold()), 0.5 * SampleHold::kSlew, 1e-4);
  path.run(10s, 1s);
  EXPECT_EQ(path.hold.hold(), SampleHold::kMax);
}

TEST(SampleHoldTest, AnEpochThatHasEndedTellsNothing) {
  Path path{4};
  path.run(100ms, Duration{0});
  path.run(3s, 50ms);
  path.hold.forget();
  EXPECT_TRUE(path.hold.pass({}, 50ms, path.now + 200ms).empty());
}

TEST(SampleHoldTest, OfABunchBeyondItsRoomTheNewestStay) {
  SampleHold hold;
  TimePoint now{1s};
  (void)hold.pass({}, Duration{0}, now);
  for (int i = 0; i < 3000; ++i) (void)hold.pass({}, 50ms, now += 1ms);
  std::vector<Incoming> bunch(700);
  std::uint64_t number = 0;
  for (int i = 0; i < 3; ++i) {
    now += 1ms;
    for (Incoming& one : bunch) one = sample(++number, now);
    (void)hold.pass(bunch, 50ms, now);
  }
  const auto passed = hold.pass({}, 50ms, now + 60ms);
  ASSERT_EQ(passed.size(), SampleHold::kKept);
  EXPECT_EQ(passed.back().number, number);
  EXPECT_EQ(passed.front().number, number - SampleHold::kKept + 1);
}

}  // namespace
}  // namespace palp::surgeon
