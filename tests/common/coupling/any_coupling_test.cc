#include "common/coupling/any_coupling.h"

#include <array>

#include <gtest/gtest.h>

#include "common/coupling/coupling.h"

namespace palp::coupling {
namespace {

constexpr Duration kTick = std::chrono::milliseconds{1};

TEST(AnyCouplingTest, EveryListedNameMakesBothHalves) {
  for (const std::string_view name : kCouplingNames) {
    CouplingConfig config;
    config.name = name;
    EXPECT_TRUE(make_surgeon_coupling(config).has_value()) << name;
    EXPECT_TRUE(make_patient_coupling(config).has_value()) << name;
  }
}

TEST(AnyCouplingTest, UnknownNameIsOneSentenceWithTheNameAndTheNamesThereAre) {
  CouplingConfig config;
  config.name = "magnetic";
  const auto surgeon = make_surgeon_coupling(config);
  const auto patient = make_patient_coupling(config);
  ASSERT_FALSE(surgeon.has_value());
  ASSERT_FALSE(patient.has_value());
  EXPECT_EQ(surgeon.error().text, patient.error().text);
  EXPECT_NE(surgeon.error().text.find("unknown coupling 'magnetic'"), std::string::npos);
  for (const std::string_view name : kCouplingNames) {
    EXPECT_NE(surgeon.error().text.find(name), std::string::npos) << name;
  }
  EXPECT_EQ(surgeon.error().text.find('\n'), std::string::npos);
}

TEST(AnyCouplingTest, ConfigurationReachesTheLaw) {
  CouplingConfig config;
  config.name = "direct";
  config.direct = {
      .force_scale = 2, .position_scale = 3, .spring = 0, .change = {.slew = 1e9, .at_once = 1e9}};
  SurgeonCoupling surgeon = *make_surgeon_coupling(config);
  PatientCoupling patient = *make_patient_coupling(config);
  begin_epoch(surgeon, 0);
  begin_epoch(patient, 0.007);
  EXPECT_EQ(step(patient, PatientInput{}, kTick).target_position, 0.007);
  Incoming incoming;
  incoming.fresh = true;
  incoming.sample.position = 0.001;
  incoming.sample.force = 1.5;
  const std::array arrived{incoming};
  SurgeonInput in;
  in.state = SiteState::Engaged;
  in.arrived = arrived;
  EXPECT_EQ(step(surgeon, in, kTick).force, 3);
  EXPECT_EQ(force_scale(surgeon), 2);
  EXPECT_EQ(step(patient, {.arrived = arrived}, kTick).target_position, 0.003);
}

TEST(AnyCouplingTest, ALawThatSaysNothingOfItMeansToGiveAllOfTheForce) {
  for (const char* name : {"wave", "tdpa", "mmt"}) {
    CouplingConfig config;
    config.name = name;
    config.direct.force_scale = 2;
    EXPECT_EQ(force_scale(*make_surgeon_coupling(config)), 1) << name;
  }
}

TEST(NewestTest, IsTheLastSampleAndOnlyIfItIsFresh) {
  std::array<Incoming, 2> arrived{};
  EXPECT_EQ(newest({}), nullptr);
  EXPECT_EQ(newest(arrived), nullptr);
  arrived[1].fresh = true;
  EXPECT_EQ(newest(arrived), &arrived[1]);
}

}  // namespace
}  // namespace palp::coupling
