#include "patient_site/force_foresight.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "patient_site/motion_gate.h"
#include "patient_site/simulated_phantom.h"

namespace palp::patient {
namespace {

constexpr Duration kTick = std::chrono::milliseconds{1};
constexpr double kLimit = 3;  // [N]

/// Straight up to `kink` [m], and `steeper` times as steep below it.
Phantom kinked(double stiffness, double kink, double steeper) {
  std::vector<ForceRow> rows;
  for (int i = 0; i <= 1000; ++i) {
    const double d = 10e-6 * i;
    rows.push_back({d, stiffness * (d + (steeper - 1) * std::max(0.0, d - kink))});
  }
  const ForceTable table = *ForceTable::make(std::move(rows));
  return {.name = "kinked",
          .plain = table,
          .over = table,
          .depth = std::nullopt,
          .radius = std::nullopt,
          .ratio = std::nullopt,
          .shape = "none"};
}

/// A gate above a simulated stage, tissue and transducer, as a control ties them together.
class GatedTip {
 public:
  GatedTip(const Phantom& phantom, const SimulatedPhantomConfig& config, int sensor_ticks = 1)
      : plant_{phantom, config}, sensor_ticks_{sensor_ticks}, gate_{{}, facts(config)} {
    gate_.begin(config.start_position, {});
  }

  void step(double asked) {
    at_ += kTick;
    const double tip = plant_.read(at_).position;
    const double force = plant_.sample(at_)->force;
    const bool fresh = tick_++ % sensor_ticks_ == 0;
    if (fresh) felt_ = force;
    gate_.feel(tip, felt_, fresh ? std::optional{0.0} : std::nullopt);
    answer_ = gate_.pass({SiteState::Engaged, asked, {}, tip, felt_}, kTick);
    plant_.move_to({answer_.position, {}});
  }
  [[nodiscard]] double force() const { return plant_.truth().contact_force; }
  [[nodiscard]] double tip() const { return plant_.truth().position; }
  [[nodiscard]] const MotionAnswer& answer() const { return answer_; }

 private:
  [[nodiscard]] PatientDevices facts(const SimulatedPhantomConfig& config) const {
    PatientDevices devices = facts_of(config);
    devices.sensor.rate = 1e3 / sensor_ticks_;
    return devices;
  }
  SimulatedPhantom plant_;
  int sensor_ticks_;
  MotionGate gate_;
  TimePoint at_{};
  int tick_{};
  double felt_{};
  MotionAnswer answer_;
};

TEST(ForceForesightTest, InTheAirEverythingIsAllowed) {
  ForceForesight foresight;
  foresight.begin(0);
  EXPECT_GT(foresight.bound(0, kLimit), 1);
  for (int i = 0; i < 100; ++i) foresight.feel(50e-6 * i, i % 7 == 0 ? 0.05 : 0, 0.0);
  EXPECT_GT(foresight.bound(5e-3, kLimit), 10e-3);
}

/// Readings of a tissue of 800 N/m under a tip that goes evenly, behind one pole and in steps.
ForceForesight felt(double speed, double step, int sensor_ticks) {
  ForceForesight foresight;
  foresight.begin(0);
  LowPass pole{20, 1e-3};
  for (int i = 0; i * 1e-3 * speed < 2e-3; ++i) {
    const double tip = 1e-3 * speed * i;
    const double force = step * std::round(pole.step(800 * tip) / step);
    foresight.feel(tip, force, i % sensor_ticks == 0 ? std::optional{0.0} : std::nullopt);
  }
  return foresight;
}

TEST(ForceForesightTest, KnowsHowSteepTheTissueIsFromItsLastWay) {
  EXPECT_NEAR(felt(0.05, 1e-6, 1).stiffness(), 800, 1);
  EXPECT_NEAR(felt(0.01, 1e-6, 1).stiffness(), 800, 1);
  EXPECT_NEAR(felt(0.05, 0.05, 1).stiffness(), 800, 120);
  EXPECT_NEAR(felt(0.03, 0.05, 20).stiffness(), 800, 120) << "a sensor of 50 Hz";
}

TEST(ForceForesightTest, AForceThatRisesUnderATipThatStandsSaysNothingOfItsTissue) {
  ForceForesight foresight{{.stage = {}, .sensor = {.pole = 1e5, .lag = 0}}};
  foresight.begin(0);
  for (int i = 0; i <= 100; ++i) foresight.feel(20e-6 * i, 16e-3 * i, 0.0);
  for (int i = 0; i <= 1000; ++i) foresight.feel(2e-3, 1.6 + 1e-3 * i, 0.0);
  EXPECT_NEAR(foresight.stiffness(), 800, 100);
  EXPECT_NEAR(foresight.bound(2e-3, kLimit), 2e-3 + 3 * 0.25 / foresight.stiffness(), 30e-6)
      << "but it counts";
}

TEST(ForceForesightTest, ForcesThatLeaveTheLineCountAtOnce) {
  ForceForesight foresight{{.stage = {}, .sensor = {.pole = 1e5, .lag = 0}}};
  foresight.begin(0);
  for (int i = 0; i < 60; ++i) foresight.feel(20e-6 * i, 16e-3 * i, 0.0);
  const double force = 16e-3 * 60 + 0.5;
  foresight.feel(20e-6 * 60, force, 0.0);
  const double doubt = ForceSensorFacts{}.step + 2 * ForceSensorFacts{}.noise;
  const double kink = (3.4 - force + doubt) / (2.5 * foresight.stiffness());
  EXPECT_LE(foresight.bound(20e-6 * 60, kLimit), 20e-6 * 60 + 3 * kink + 1e-9);
}

TEST(ForceForesightTest, AReadingThatIsOldBelongsToWhereTheTipWas) {
  const auto bound_with = [](double lag) {
    ForceForesight foresight{{.stage = {}, .sensor = {.pole = 1e5, .lag = lag}}};
    foresight.begin(0);
    for (int i = 0; i <= 40; ++i) foresight.feel(50e-6 * i, 40e-3 * i, 0.0);
    return foresight.bound(2e-3, kLimit);
  };
  EXPECT_NEAR(bound_with(0) - bound_with(0.01), 3 * 0.5e-3, 20e-6) << "by a third of its lead";
}

/// The law: whatever is asked, and however stiff a tissue gets, the tip stays within half a newton
/// of the limit, and comes to rest.
TEST(ForceForesightTest, NoPressExceedsTheLimitByHalfANewton) {
  for (const double stiffness : {300.0, 800.0, 1500.0, 2500.0}) {
    for (const double steeper : {1.0, 2.5}) {
      const Phantom phantom = kinked(stiffness, 1.2 / stiffness, steeper);
      for (const double servo : {10.0, 20.0, 30.0}) {
        for (const int sensor_ticks : {1, 5, 20}) {
          // What is too steep for a sensor of 50 Hz, or for any.
          if (stiffness * steeper > (sensor_ticks > 5 ? 2000 : 4000)) continue;
          GatedTip gated{phantom, {.servo_frequency = servo}, sensor_ticks};
          double highest = 0;
          double shallow = 1;
          double deep = -1;
          for (int tick = 0; tick < 3000; ++tick) {
            gated.step(9e-3);
            highest = std::max(highest, gated.force());
            if (tick < 2500) continue;
            shallow = std::min(shallow, gated.tip());
            deep = std::max(deep, gated.tip());
          }
          const std::string where = std::to_string(stiffness) + " N/m, " + std::to_string(steeper) +
                                    ", " + std::to_string(servo) + " Hz, " +
                                    std::to_string(sensor_ticks) + " ms";
          EXPECT_LE(highest, 3.5) << where;
          EXPECT_GE(highest, stiffness > 500 ? 2.5 : 2.1) << where;
          EXPECT_LE(deep - shallow, 0.1e-3) << where;
        }
      }
    }
  }
}

TEST(ForceForesightTest, APressThatEndsBelowTheLimitGoesAsItIsAsked) {
  for (const double stiffness : {100.0, 300.0, 600.0, 1000.0}) {
    const Phantom phantom = kinked(stiffness, 10e-3, 1);
    GatedTip gated{phantom, {.start_position = -1e-3}};
    // Taps to 2 N, or 3 mm, of up to 44 mm/s.
    const double depth = std::min(3e-3, 2 / stiffness);
    for (int tick = 0; tick < 3000; ++tick) {
      const double swing = (1 - std::cos(2 * std::numbers::pi * 3.5e-3 * tick)) / 2;
      const double asked = -1e-3 + (depth + 1e-3) * swing;
      gated.step(asked);
      ASSERT_NEAR(gated.answer().position, asked, 1e-9) << stiffness << " N/m, " << tick << " ms";
    }
  }
}

}  // namespace
}  // namespace palp::patient
