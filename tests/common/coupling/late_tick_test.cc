// Goal: a tick that comes late shows no law a motion that was not there, and its books are exact
// over it. Method: both halves of each law palpate a spring twice, once with a tick of the surgeon
// that is late; the device holds its force meanwhile. The run in time is what the motion explains.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/core/random.h"
#include "common/coupling/any_coupling.h"

namespace palp::coupling {
namespace {

constexpr Duration kTick = std::chrono::milliseconds{1};
constexpr double kStiffness = 300;  // [N/m], of the tissue

CouplingConfig named(const std::string& name) {
  CouplingConfig config;
  config.name = name;
  return config;
}

/// A hand on a given way, and a stage that is where it is told to be.
class Session {
 public:
  explicit Session(const std::string& name)
      : surgeon_{make_surgeon_coupling(named(name)).value()},
        patient_{make_patient_coupling(named(name)).value()} {
    begin_epoch(surgeon_, hand_);
    begin_epoch(patient_, tip_);
  }

  /// One period. `asleep`: the surgeon's process stands still, and what is sent to it waits.
  void step(bool asleep) {
    const double before = hand_;
    now_ += kTick;
    // Taps of 4 mm, a second each, at up to 13 mm/s.
    hand_ = -1e-3 + 2.5e-3 * (1 - std::cos(2 * std::numbers::pi * seconds(now_ - TimePoint{})));
    work_ += force_ * (hand_ - before);
    work_min_ = std::min(work_min_, work_);
    ++periods_;
    if (!asleep) tick_surgeon();
    tick_patient();
  }
  [[nodiscard]] double force() const { return force_; }        ///< [N], of the device
  [[nodiscard]] double work_min() const { return work_min_; }  ///< [J]

 private:
  Incoming incoming(const PortSample& sample, std::uint64_t number) const {
    return {.sample = sample,
            .number = number,
            .fresh = true,
            .repaired = false,
            .sent_at = PeerTimePoint{(now_ - kTick).time_since_epoch()},
            .arrived_at = now_};
  }
  void tick_surgeon() {
    SurgeonInput in;
    in.now = now_;
    in.state = SiteState::Engaged;
    in.position = hand_;
    in.force_applied = force_;
    in.arrived = down_;
    const SurgeonOutput out = coupling::step(surgeon_, in, {kTick, periods_});
    force_ = out.force;
    periods_ = 0;
    down_.clear();
    up_.push_back(incoming(out.to_patient, ++up_number_));
  }
  void tick_patient() {
    PatientInput in;
    in.now = now_;
    in.state = SiteState::Engaged;
    in.position = tip_;
    in.contact_force = kStiffness * std::max(0.0, tip_);
    in.arrived = up_;
    const PatientOutput out = coupling::step(patient_, in, kTick);
    up_.clear();
    tip_ = out.target_position;
    down_.push_back(incoming(out.to_surgeon, ++down_number_));
  }

  SurgeonCoupling surgeon_;
  PatientCoupling patient_;
  TimePoint now_{};
  double hand_{-1e-3};  ///< [m]
  double tip_{-1e-3};   ///< [m]
  double force_{};      ///< [N]
  double work_{};       ///< [J]
  double work_min_{};   ///< [J]
  std::int64_t periods_{};
  std::vector<Incoming> up_;
  std::vector<Incoming> down_;
  std::uint64_t up_number_{};
  std::uint64_t down_number_{};
};

/// [N], most that the force within 20 ms after a tick that is `late` periods late at tick `at` is
/// above what was held and what the same palpation has in time: what lets go kicks nobody.
double kick(const std::string& name, int at, int late) {
  Session session{name};
  Session in_time{name};
  double explained = 0;
  double most = 0;
  for (int tick = 0; tick < at + late + 20; ++tick) {
    const bool asleep = tick >= at && tick < at + late;
    session.step(asleep);
    in_time.step(false);
    if (tick < at) {
      explained = std::abs(session.force());
      continue;
    }
    explained = std::max(explained, std::abs(in_time.force()));
    if (!asleep) most = std::max(most, std::abs(session.force()) - explained);
  }
  return most;
}

class LateTickTest : public testing::TestWithParam<std::string_view> {};
INSTANTIATE_TEST_SUITE_P(Laws,
                         LateTickTest,
                         testing::ValuesIn(kCouplingNames),
                         [](const auto& law) { return std::string{law.param}; });

TEST_P(LateTickTest, TheForceIsThatOfTheMotionThereWas) {
  const std::string name{GetParam()};
  for (const int late : {1, 4, 20, 49}) {
    // On the way in, at the deepest, on the way out, in the air; after a first tap.
    for (const int at : {2250, 2350, 2480, 2650, 2750, 2980}) {
      // 200 N/m of `direct` times the way that the tip had no news of.
      EXPECT_LE(kick(name, at, late), 0.13) << late << " ms at " << at;
    }
  }
}

TEST_P(LateTickTest, ManyOfThemGiveTheHandNoMoreThanATankHeld) {
  if (GetParam() == "direct") return;  // it has none, and no bound
  Session session{std::string{GetParam()}};
  int left = 0;
  for (std::uint64_t tick = 0; tick < 10'000; ++tick) {
    const double uniform = random_uniform(3, 1, tick);
    if (left > 0) {
      --left;
    } else if (uniform < 0.02) {
      left = static_cast<int>(uniform * 2500);
    }
    session.step(left > 0);
  }
  EXPECT_GE(session.work_min(), -1.05e-3);
}

/// A hand that jumps by `way` [m] in all of `periods` against the 1 N that the device held.
template <class Law>
Law after_a_jump(Law law, double way, std::int64_t periods) {
  law.begin_epoch(0);
  SurgeonInput in;
  in.state = SiteState::Engaged;
  in.force_applied = 1;
  (void)law.step(in, kTick);
  in.position = way;
  (void)law.step(in, {kTick, periods});
  return law;
}

TEST(LateTickBooksTest, TheWorkOfAHeldForceIsThatForceTimesTheWay) {
  for (const double way : {-0.9e-3, -0.2e-3, 0.4e-3, 1.5e-3}) {
    for (const std::int64_t periods : {1, 5, 50, 5000}) {
      const MmtConfig mmt;
      EXPECT_DOUBLE_EQ(after_a_jump(MmtSurgeon{mmt}, way, periods).tank(),
                       mmt.tank + std::min(0.0, way))
          << "it is full at first";
      const WaveConfig wave;
      EXPECT_DOUBLE_EQ(after_a_jump(WaveSurgeon{wave}, way, periods).tank(), wave.tank.start + way);
    }
  }
}

TEST(LateTickBooksTest, AnEvenMotionIsAsFastAsItWasHoweverSeldomItIsSeen) {
  constexpr double kSpeed = 0.05;  // [m/s]
  for (const std::int64_t periods : {2, 10, 50}) {
    const auto drag = [&](std::int64_t last) {
      MmtSurgeon law{MmtConfig{}};
      law.begin_epoch(-50e-3);
      SurgeonInput in;
      in.state = SiteState::Engaged;
      in.position = -50e-3;
      double force = 0;
      for (int tick = 0; tick < 100; ++tick) {
        in.position += 1e-3 * kSpeed;
        force = law.step(in, kTick).force;
      }
      in.position += 1e-3 * kSpeed * static_cast<double>(last);
      return law.step(in, {kTick, last}).force / force;
    };
    EXPECT_NEAR(drag(periods), 1, 0.02) << periods;
  }
}

TEST(LateTickBooksTest, ALateTickBuysNoMoreOfANewTissueThanAnyOther) {
  const auto rise = [](std::int64_t periods) {
    MmtSurgeon law{MmtConfig{}};
    law.begin_epoch(4e-3);
    Incoming incoming;
    incoming.sample.payload = ModelPayload{.version = 1, .c = {0, 0.03}, .depth_max = 4e-3};
    incoming.fresh = true;
    const std::array arrived{incoming};
    SurgeonInput in;
    in.state = SiteState::Engaged;
    in.position = 4e-3;
    in.round_trip = std::chrono::milliseconds{100};
    in.arrived = arrived;
    for (int tick = 0; tick < 5; ++tick) in.force_applied = law.step(in, kTick).force;
    return law.step(in, {kTick, periods}).force - in.force_applied;
  };
  EXPECT_GT(rise(1), 0);
  for (const std::int64_t periods : {2, 10, 50, 5000}) EXPECT_NEAR(rise(periods), rise(1), 1e-6);
}

TEST(LateTickBooksTest, WhatAHeldForceTookOfASpringDoesNotFadeOnceMore) {
  MmtSurgeon law{MmtConfig{}};
  law.begin_epoch(-1e-3);
  Incoming incoming;
  incoming.sample.payload = ModelPayload{.version = 1, .c = {0.3}, .depth_max = 5e-3};
  incoming.fresh = true;
  const std::array arrived{incoming};
  SurgeonInput in;
  in.state = SiteState::Engaged;
  in.arrived = arrived;
  for (in.position = -1e-3; in.position < 4e-3; in.position += 20e-6) {
    in.force_applied = law.step(in, kTick).force;
  }
  ASSERT_GT(in.force_applied, 1);
  // Out under the full force until nothing is left of spring and tank.
  in.state = SiteState::Clutched;
  in.position -= 20e-6 + (law.stored() + law.tank()) / in.force_applied;
  const SurgeonOutput out = law.step(in, {kTick, 400});
  EXPECT_NEAR(law.stored() + law.tank(), 0, 1e-9);
  EXPECT_NEAR(out.fade_max, 0, 0.02);
}

}  // namespace
}  // namespace palp::coupling
