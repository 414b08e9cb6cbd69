#include "patient_site/device_watch.h"

#include <gtest/gtest.h>

namespace palp::patient {
namespace {

constexpr Duration kTick = std::chrono::milliseconds{1};

/// A tip that goes in at 100 mm/s, and a sensor that reads each 20 ms.
class SlowSensor {
 public:
  DeviceWatch::Stuck tick(bool works) {
    now_ += kTick;
    look_.tip += 1e-4;
    look_.target = look_.tip;
    if (++ticks_ % 20 == 0) {
      look_.felt_at = now_;
      if (works) look_.force += 0.1;
    }
    return watch_.judge(look_, lapse_);
  }

 private:
  DeviceWatch watch_{{}};
  DeviceWatch::Look look_{.force = 0.2, .in_tissue = true};
  Lapse lapse_{kTick};
  TimePoint now_{};
  int ticks_{};
};

TEST(DeviceWatchTest, AReadingMayStandForTheWayOfSomeOfTheSensorsPeriods) {
  SlowSensor sensor;
  for (int i = 0; i < 200; ++i) ASSERT_FALSE(sensor.tick(true).sensor) << i;
  int after = 0;
  while (!sensor.tick(false).sensor && after < 1000) ++after;
  EXPECT_NEAR(after, 100, 20) << "the fifth reading that is the same";
}

}  // namespace
}  // namespace palp::patient
