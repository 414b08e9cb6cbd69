#include "patient_site/devices/register_stage.h"

#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "patient_site/devices/device_plans.h"
#include "patient_site/devices/device_rig.h"
#include "patient_site/settings_devices.h"
#include "tests/common/io/device/fake_registers.h"

namespace palp::patient {
namespace {

std::unique_ptr<FakeRegisters> orca_registers() {
  auto port = std::make_unique<FakeRegisters>();
  auto* const raw = port.get();
  raw->written = [raw](std::uint16_t address) {
    if (address != 30) return;
    raw->words[342] = raw->words[30];
    raw->words[343] = raw->words[31];
  };
  return port;
}

DeviceInstallation installation() {
  DeviceInstallation built_in;
  built_in.speed_max = 1;
  built_in.acceleration_max = 100;
  built_in.tare_time = std::chrono::milliseconds{10};
  return built_in;
}

DeviceProfile quick_orca() {
  DeviceProfile profile = find_profile("orca").value();
  profile.period = std::chrono::milliseconds{1};
  profile.silence = std::chrono::seconds{30};  // of no account here
  return profile;
}

/// Looks until `done`, 20 s at most.
template <class Done>
bool wait_for(const Done& done) {
  const io::SteadyClock clock;
  const TimePoint end = clock.now() + std::chrono::seconds{20};
  while (!done()) {
    if (clock.now() > end) return false;
    std::this_thread::yield();
  }
  return true;
}

TEST(RegisterStageTest, GoesToItsTargetAndFeelsWithThreadsOfItsOwn) {
  DeviceThread axis{"normal", quick_orca(), installation(), orca_registers(), 0};
  RegisterStage stage{{&axis, nullptr, nullptr}, StageFacts{}};
  RegisterForce force{axis, ForceSensorFacts{}};
  const io::SteadyClock clock;
  EXPECT_TRUE(stage.read(clock.now()).faulted || axis.reading().state == DeviceState::Ready);
  ASSERT_TRUE(wait_for([&] { return axis.status().state == DeviceState::Ready; }));
  ASSERT_TRUE(wait_for([&] {
    const StageState state = stage.read(clock.now());
    stage.move_to({.position = 2e-3, .place = {}});
    return !state.faulted && std::abs(state.position - 2e-3) < 2e-6;
  }));
  ASSERT_TRUE(wait_for([&] { return force.sample(clock.now()).has_value(); }));
  stage.halt();
  EXPECT_EQ(axis.name(), "normal");
}

TEST(RegisterStageTest, AnOldReadingIsAFaultWhateverItsThreadSays) {
  DeviceThread axis{"normal", quick_orca(), installation(), orca_registers(), 0};
  RegisterStage stage{{&axis, nullptr, nullptr}, StageFacts{}};
  const io::SteadyClock clock;
  ASSERT_TRUE(wait_for([&] { return !stage.read(clock.now()).faulted; }));
  const TimePoint later = clock.now() + std::chrono::minutes{1};
  EXPECT_FALSE(stage.read(later).faulted) << "the caller slept, and so may its thread have done";
  const Duration silence = axis.profile().silence;
  constexpr Duration kTick = std::chrono::milliseconds{1};
  for (Duration past = kTick; past <= silence; past += kTick) {
    EXPECT_FALSE(stage.read(later + past).faulted);
  }
  EXPECT_EQ(axis.silences(), 0);
  EXPECT_TRUE(stage.read(later + silence + kTick).faulted);
  EXPECT_TRUE(stage.read(later + silence + 2 * kTick).faulted);
  EXPECT_EQ(axis.silences(), 1) << "told once";
}

TEST(RegisterStageTest, AStageWithAnAxisThatIsNotThereIsFaulted) {
  auto port = orca_registers();
  port->openable = false;
  DeviceThread axis{"normal", quick_orca(), installation(), std::move(port), 0};
  RegisterStage stage{{&axis, nullptr, nullptr}, StageFacts{}};
  RegisterForce force{axis, ForceSensorFacts{}};
  const io::SteadyClock clock;
  ASSERT_TRUE(wait_for([&] { return axis.status().reason == DeviceReason::Port; }));
  EXPECT_TRUE(stage.read(clock.now()).faulted);
  EXPECT_FALSE(force.sample(clock.now()).has_value());
}

TEST(DeviceRigTest, TellsByNameWhoIsNotThere) {
  const auto plans =
      make_device_plans("normal { profile: \"orca\" address: \"serial:/dev/null/none\" }", "rig");
  ASSERT_TRUE(plans) << plans.error().text;
  DeviceRig rig{*plans, 0};
  std::vector<DeviceNews> news;
  ASSERT_TRUE(wait_for([&] {
    news = rig.news();
    return !news.empty();
  }));
  EXPECT_FALSE(news[0].fit);
  EXPECT_EQ(news[0].sentence, "normal axis (Iris ORCA): absent, cannot be opened");
  EXPECT_TRUE(rig.stage().read(io::SteadyClock{}.now()).faulted);
  EXPECT_FALSE(rig.sensor().sample(io::SteadyClock{}.now()).has_value());
  EXPECT_EQ(rig.stage().stage_facts().axes, 1U);
  EXPECT_FALSE(rig.ready());
  EXPECT_FALSE(rig.hopeless(std::chrono::seconds{1}));
  EXPECT_EQ(rig.hopeless(std::chrono::seconds{6}), news[0].sentence);
  rig.restart();
  rig.tare();
  news.clear();
  ASSERT_TRUE(wait_for([&] {
    for (const DeviceNews& one : rig.news()) news.push_back(one);
    return !news.empty();
  }));
  EXPECT_EQ(news[0].sentence,
            "normal axis (Iris ORCA): the tare was refused, the sensor is not ready");
}

}  // namespace
}  // namespace palp::patient
