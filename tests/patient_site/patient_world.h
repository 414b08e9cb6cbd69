#pragma once

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "patient_site/patient_node.h"
#include "patient_site/simulated_phantom.h"
#include "tests/common/link/link_couple.h"
#include "tests/support/fake_recorder.h"

/// A patient site on a simulated phantom, with the surgeon's end of its link in a test's hands.
namespace palp::patient::test {

inline constexpr Duration kTick = std::chrono::milliseconds{1};

/// The simulated phantom with faults that a test switches on.
class FaultySite final : public Stage, public ForceSensor {
 public:
  explicit FaultySite(SimulatedPhantom& site) : site_{site} {}
  [[nodiscard]] StageFacts stage_facts() const noexcept override { return site_.stage_facts(); }
  [[nodiscard]] ForceSensorFacts sensor_facts() const noexcept override {
    return site_.sensor_facts();
  }
  StageState read(TimePoint now) noexcept override {
    StageState state = site_.read(now);
    if (stage_gives_nan) state.position = std::nan("");
    if (stage_creep != 0) state.position = (crept_ += 1e-3 * stage_creep);
    crept_ = state.position;
    state.faulted = stage_faulted;
    return state;
  }
  void move_to(const StageTarget& target) noexcept override {
    target_ = target;
    halted = false;
    if (stage_stuck) return site_.halt();
    site_.move_to(target);
  }
  void halt() noexcept override {
    halted = true;
    site_.halt();
  }
  std::optional<ForceSample> sample(TimePoint now) noexcept override {
    std::optional<ForceSample> sample = site_.sample(now);
    if (silent) return std::nullopt;
    if (force) sample->force = *force;
    sample->saturated = saturated;
    return sample;
  }
  void expect_touch(bool may_touch) noexcept override { touch_expected = may_touch; }
  [[nodiscard]] StageTarget target() const { return target_; }

  bool stage_gives_nan{};
  bool stage_faulted{};
  bool stage_stuck{};
  double stage_creep{};  ///< [m/s], wherever it is sent
  bool silent{};
  bool saturated{};
  bool halted{};
  bool touch_expected{};
  std::optional<double> force;  ///< [N], in place of the sensor's

 private:
  SimulatedPhantom& site_;
  StageTarget target_;
  double crept_{};  ///< [m]
};

/// A patient site with everything, and the surgeon's end of the link in the hands of the test.
struct World {
  link::TestPipe pipe;
  Phantom phantom{*make_phantom("paper-10mm")};
  SimulatedPhantom plant;
  FaultySite site{plant};
  coupling::PatientCoupling law{*coupling::make_patient_coupling({})};
  link::Link patient_link{{}, link::Couple::make_codec(false)};
  link::Link surgeon_link{{}, link::Couple::make_codec(false)};
  palp::test::KeepingRecorder recorder;
  SpscQueue<ContactSample> contact{1 << 15};
  Mailbox<Findings> found;
  Mailbox<MapCells> cells;
  PatientNode node{{}, {site, site, law, patient_link, recorder, contact, found, cells}};
  Telegram say;  ///< the surgeon's
  link::Arrivals heard;
  TimePoint now{};
  bool silent{};

  explicit World(const SimulatedPhantomConfig& config = {}) : plant{phantom, config} {
    (void)surgeon_link.adopt(link::Couple::link_update(pipe.surgeon_end(), 3, 2, 1), now);
    (void)patient_link.adopt(link::Couple::link_update(pipe.patient_end(), 2, 3, 1), now);
    say.port.position = -10e-3;
  }
  void tick() {
    now += kTick;
    heard = surgeon_link.receive(now);
    if (!silent) surgeon_link.send(say, now);
    node.tick(now);
  }
  void run(Duration span) {
    for (const TimePoint end = now + span; now < end;) tick();
  }
  PatientStatus status() { return node.status().get(); }

  /// Engaged in epoch 1 at the start position.
  void engage() {
    say.site.state = SiteState::Clutched;
    run(std::chrono::milliseconds{200});
    ASSERT_EQ(status().state, SiteState::Clutched);
    say.site.state = SiteState::Engaged;
    say.site.epoch = status().epoch + 1;
    run(std::chrono::milliseconds{5});
    ASSERT_EQ(status().state, SiteState::Engaged);
  }
  void move(double to, Duration span) {
    const double from = say.port.position;
    const auto steps = span / kTick;
    for (std::int64_t i = 1; i <= steps; ++i) {
      say.port.position = from + (to - from) * static_cast<double>(i) / static_cast<double>(steps);
      tick();
    }
    run(std::chrono::milliseconds{200});
  }
};

}  // namespace palp::patient::test
