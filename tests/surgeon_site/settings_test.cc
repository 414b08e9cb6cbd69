#include "surgeon_site/settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/document.h"
#include "common/coupling/any_coupling.h"
#include "tests/common/settings/knob_walk.h"
#include "tests/common/settings/settings_text.h"

namespace palp::surgeon {
namespace {

using testing::HasSubstr;

std::string text_of(const Settings& settings) {
  settings_test::FieldList list;
  list.add("peer", settings.peer);
  add(list, settings.protection);
  add(list, settings.coupling);
  add(list, settings.link);
  list.add("node.period", settings.node.period)
      .add("retract_after_gap", settings.node.supervisor.retract_after_gap)
      .add("retract_span", settings.node.supervisor.retract_span)
      .add("follow_within", settings.node.supervisor.follow_within)
      .add("round_trip_max_to_engage", settings.node.supervisor.round_trip_max_to_engage)
      .add("direct_round_trip_max", settings.direct_round_trip_max)
      .add("engagement_forced", settings.engagement_forced)
      .add("hold_in_plane", settings.node.hold_in_plane)
      .add("gate.force_max", settings.node.gate.force_max)
      .add("gate.force_continuous", settings.node.gate.force_continuous)
      .add("gate.thermal_time", settings.node.gate.thermal_time)
      .add("gate.fade_slew", settings.node.gate.fade_slew)
      .add("gate.growth.slew", settings.node.gate.growth.slew)
      .add("gate.growth.at_once", settings.node.gate.growth.at_once)
      .add("gate.growth.stiffness", settings.node.gate.growth.stiffness)
      .add("gate.growth.damping", settings.node.gate.growth.damping)
      .add("gate.growth.memory", settings.node.gate.growth.memory)
      .add("link_status_every", settings.node.link_status_every)
      .add("master", settings.master)
      .add("devices", settings.devices)
      .add("grip", settings.grip)
      .add("grip.mass", settings.hand.plant.grip.mass)
      .add("grip.damping", settings.hand.plant.grip.damping)
      .add("grip.stiffness", settings.hand.plant.grip.stiffness)
      .add("reaction.reflex", settings.hand.plant.reaction.reflex)
      .add("reaction.reflex_delay", settings.hand.plant.reaction.reflex_delay)
      .add("reaction.co_contraction", settings.hand.plant.reaction.co_contraction)
      .add("plant.mass", settings.hand.plant.mass)
      .add("plant.damping", settings.hand.plant.damping)
      .add("plant.friction", settings.hand.plant.friction)
      .add("plant.friction_speed", settings.hand.plant.friction_speed)
      .add("plant.step", settings.hand.plant.step)
      .add("person.surface_offset", settings.hand.person.surface_offset)
      .add("person.start", settings.hand.person.start)
      .add("person.engage_again", settings.hand.person.engage_again)
      .add("hand.tremor", settings.hand.tremor)
      .add("hand.tremor_frequency", settings.hand.tremor_frequency)
      .add("hand.encoder_step", settings.hand.encoder_step)
      .add("hand.velocity_cut_off", settings.hand.velocity_cut_off)
      .add("hand.force_max", settings.hand.force_max)
      .add("hand.force_continuous", settings.hand.force_continuous);
  add(list, settings.loop);
  add(list, settings.impairment);
  add(list, settings.record);
  add(list, settings.monitor);
  list.add("duration", settings.duration)
      .add("picture_in_step", settings.picture_in_step)
      .add("give_up_after", settings.give_up_after)
      .add("seed", settings.seed);
  return list.text();
}

Settings settings_with(const std::vector<std::string>& assignments) {
  config::Document document = config::surgeon_document();
  for (const std::string& assignment : assignments) EXPECT_TRUE(document.set(assignment));
  EXPECT_TRUE(document.check());
  return make_settings(document).value();
}

TEST(SurgeonSettingsTest, AnEmptyDocumentGivesTheDefaultsOfTheParts) {
  EXPECT_EQ(text_of(settings_with({})), text_of(Settings{}));
}

TEST(SurgeonSettingsTest, EveryKnobIsRead) {
  const std::string before = text_of(settings_with({}));
  settings_test::for_each_knob(
      *proto::config::SurgeonConfig::descriptor(),
      "",
      [&before](const std::string& path, const std::string& value) {
        config::Document document = config::surgeon_document();
        ASSERT_TRUE(document.set(path, value, path)) << path << " = " << value;
        const auto made = make_settings(document);
        EXPECT_TRUE(!made || text_of(*made) != before) << "nobody reads " << path;
      });
}

TEST(SurgeonSettingsTest, UnitsChangeAtTheBorder) {
  const Settings made = settings_with({"link.hold_after_ms=40",
                                       "loop.period_us=500",
                                       "hand.tremor_mm=0.5",
                                       "hand.encoder_um=10",
                                       "hand.reflex=30%",
                                       "hand.reflex_delay_ms=70",
                                       "hand.co_contraction_per_n=0.2",
                                       "impairment.loss=5%",
                                       "duration_s=1.5"});
  EXPECT_EQ(made.link.watchdog.hold_after, std::chrono::milliseconds{40});
  EXPECT_EQ(made.loop.period, std::chrono::microseconds{500});
  EXPECT_EQ(made.node.period, made.loop.period);
  EXPECT_EQ(made.link.period, made.loop.period);
  EXPECT_EQ(made.hand.tremor, 0.5e-3);
  EXPECT_EQ(made.hand.encoder_step, 10e-6);
  EXPECT_EQ(made.hand.plant.reaction.reflex, 0.3);
  EXPECT_EQ(made.hand.plant.reaction.reflex_delay, std::chrono::milliseconds{70});
  EXPECT_EQ(made.hand.plant.reaction.co_contraction, 0.2);
  EXPECT_EQ(made.impairment.loss, 0.05);
  EXPECT_EQ(made.duration, std::chrono::milliseconds{1500});
}

TEST(SurgeonSettingsTest, AReflexIsNoLargerThanTheGripBearsOnThisDevice) {
  for (const std::string grip : {"light", "mid", "firm", "arm"}) {
    EXPECT_EQ(settings_with({"hand.grip=" + grip, "hand.reflex=0.5"}).hand.plant.reaction.reflex,
              0.5);
  }
  config::Document document = config::surgeon_document();
  ASSERT_TRUE(document.set("hand.grip=light"));
  ASSERT_TRUE(document.set("hand.mass_kg=2"));
  ASSERT_TRUE(document.set("hand.reflex=0.06"));
  EXPECT_TRUE(make_settings(document));
  ASSERT_TRUE(document.set("hand.reflex=0.07"));
  const auto made = make_settings(document);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().text,
            "hand.reflex 0.07 is too much: grip 'light' on a device of 2 kg may swing by itself "
            "beyond 0.062");
}

TEST(SurgeonSettingsTest, AnUnknownCouplingIsAnErrorThatListsTheKnownOnes) {
  config::Document document = config::surgeon_document();
  ASSERT_TRUE(document.set("coupling.name=springy"));
  const auto made = make_settings(document);
  ASSERT_FALSE(made);
  EXPECT_THAT(made.error().text, HasSubstr("unknown coupling 'springy'; there are: direct"));
}

TEST(SurgeonSettingsTest, DirectAloneHasALimitOfTheRoundTripAndForcedEngagementLiftsIt) {
  const auto limit = [](const std::vector<std::string>& sets) {
    return settings_with(sets).node.supervisor.round_trip_max_to_engage;
  };
  EXPECT_EQ(limit({"coupling.name=mmt"}), Duration{0});
  EXPECT_EQ(limit({"coupling.name=direct"}), Settings{}.direct_round_trip_max);
  EXPECT_EQ(limit({"coupling.name=direct", "engagement.forced=true"}), Duration{0});
}

TEST(SurgeonSettingsTest, TouchWaitsForThePictureOnlyWhereTheCouplingBearsIt) {
  EXPECT_FALSE(settings_with({}).picture_in_step);
  for (const std::string name : {"wave", "tdpa"}) {
    EXPECT_TRUE(settings_with({"coupling.name=" + name, "picture_in_step=true"}).picture_in_step);
  }
  for (const std::string name : {"mmt", "direct"}) {
    config::Document document = config::surgeon_document();
    ASSERT_TRUE(document.set("coupling.name=" + name));
    ASSERT_TRUE(document.set("picture_in_step=true"));
    const auto made = make_settings(document);
    ASSERT_FALSE(made) << name;
    EXPECT_THAT(made.error().text, HasSubstr("coupling '" + name + "' does not bear"));
  }
}

TEST(SurgeonSettingsTest, TheAgreementIsOnTheLawAndThePeriodAlone) {
  const std::uint64_t agreement = settings_with({}).agreement;
  EXPECT_EQ(settings_with({"seed=2", "loop.priority=0", "hand.grip=firm"}).agreement, agreement);
  EXPECT_NE(settings_with({"coupling.direct.spring_n_per_m=100"}).agreement, agreement);
  EXPECT_NE(settings_with({"loop.period_us=500"}).agreement, agreement);
}

TEST(SurgeonSettingsTest, HelpListsTheCouplingsAndScriptsThereAre) {
  const config::Document document = config::surgeon_document();
  for (const std::string_view name : coupling::kCouplingNames) {
    EXPECT_THAT(document.describe("coupling.name"), HasSubstr(std::string{name}));
  }
  const std::string masters = document.describe("hand.master");
  for (const char* const name : {"standard", "demo", "breath", "long"}) {
    EXPECT_THAT(masters, HasSubstr(std::string{"script:"} + name));
  }
}

}  // namespace
}  // namespace palp::surgeon
