#include "patient_site/devices/load_check.h"

#include <limits>

#include <gtest/gtest.h>

namespace palp::patient {
namespace {

using Verdict = LoadCheck::Verdict;

class LoadCheckTest : public testing::Test {
 protected:
  LoadCheckTest() {
    config_.force_zero = 2;
    config_.tare_within = 0.5;
    config_.tare_noise = 0.1;
    config_.tare_time = std::chrono::milliseconds{100};
    config_.stuck_after = std::chrono::milliseconds{200};
  }
  /// For 200 ms at 100 Hz, around `mean`, +- `swing`.
  Verdict quiet(LoadCheck& check, double mean, double swing = 0.01) {
    Verdict verdict{};
    for (int i = 0; i < 20; ++i) {
      at_ += std::chrono::milliseconds{10};
      verdict = check.take(mean + (i % 2 == 0 ? swing : -swing), at_);
      if (verdict == Verdict::Touched) break;
    }
    return verdict;
  }
  DeviceInstallation config_;
  TimePoint at_{};
};

TEST_F(LoadCheckTest, TakesTheMeanOfQuietAirAsZero) {
  LoadCheck check{config_};
  EXPECT_EQ(check.take(2.2, at_), Verdict::Taring);
  EXPECT_EQ(quiet(check, 2.2), Verdict::Good);
  EXPECT_NEAR(check.zero(), 2.2, 0.01);
  EXPECT_NEAR(check.noise(), 0.01, 0.005);
}

TEST_F(LoadCheckTest, RefusesWhereSomethingTouches) {
  LoadCheck check{config_};
  EXPECT_EQ(quiet(check, 2.6), Verdict::Touched);
  EXPECT_FALSE(check.tared());
  EXPECT_EQ(quiet(check, 2.0, 0.3), Verdict::Touched) << "pushed about";
}

TEST_F(LoadCheckTest, NoticesSameSaturatedAndNoNumbers) {
  LoadCheck check{config_};
  ASSERT_EQ(quiet(check, 2), Verdict::Good);
  EXPECT_EQ(check.take(48.6, at_), Verdict::Saturated);
  EXPECT_EQ(check.take(-49, at_), Verdict::Saturated);
  EXPECT_EQ(check.take(std::numeric_limits<double>::quiet_NaN(), at_), Verdict::NotFinite);
  EXPECT_EQ(quiet(check, 3, 0), Verdict::Good);
  EXPECT_EQ(quiet(check, 3, 0), Verdict::Stuck);
  check.resume();
  EXPECT_EQ(check.take(3, at_), Verdict::Good);
  EXPECT_TRUE(check.tared()) << "a tare outlives a gap";
}

TEST_F(LoadCheckTest, ATareThatIsUnderWayEndsWhereTheTipMayTouch) {
  LoadCheck check{config_};
  ASSERT_EQ(quiet(check, 2), Verdict::Good);
  check.heed({.asked = true, .ready = true, .may_touch = false});
  EXPECT_EQ(check.take(2.3, at_), Verdict::Good);
  check.heed({.asked = false, .ready = true, .may_touch = true});
  EXPECT_EQ(check.news().refused, 1U);
  EXPECT_EQ(check.news().why, "the tip may touch something");
  check.heed({.asked = false, .ready = true, .may_touch = false});
  EXPECT_EQ(quiet(check, 2.3), Verdict::Good);
  EXPECT_EQ(check.news().taken, 0U);
  EXPECT_NEAR(check.zero(), 2, 0.01);
  check.heed({.asked = true, .ready = true, .may_touch = true});
  check.heed({.asked = true, .ready = false, .may_touch = false});
  EXPECT_EQ(check.news().refused, 3U);
  EXPECT_EQ(check.news().why, "the sensor is not ready");
}

TEST_F(LoadCheckTest, NoTareReachesOverAGap) {
  LoadCheck check{config_};
  for (int i = 0; i < 9; ++i) EXPECT_EQ(check.take(2.4, at_), Verdict::Taring);
  at_ += std::chrono::milliseconds{200};
  check.resume();
  EXPECT_EQ(check.take(2, at_), Verdict::Taring) << "the first begins anew";
  ASSERT_EQ(quiet(check, 2), Verdict::Good);
  check.heed({.asked = true, .ready = true, .may_touch = false});
  EXPECT_EQ(check.take(2, at_), Verdict::Good);
  check.resume();
  EXPECT_EQ(quiet(check, 2.4), Verdict::Good);
  EXPECT_EQ(check.news().taken, 0U);
  EXPECT_EQ(check.news().refused, 1U);
  EXPECT_NEAR(check.zero(), 2, 0.01) << "it came back pressed";
}

}  // namespace
}  // namespace palp::patient
