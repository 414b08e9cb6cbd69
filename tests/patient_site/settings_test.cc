#include "patient_site/settings.h"

#include <filesystem>
#include <fstream>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/document.h"
#include "depth/embedded_database.h"
#include "fem/depth_table.h"
#include "surgeon_site/settings.h"
#include "tests/common/settings/knob_walk.h"
#include "tests/common/settings/settings_text.h"
#include "tests/support/own_path.h"

namespace palp::patient {
namespace {

using testing::HasSubstr;

void add(settings_test::FieldList& list, const MotionGateConfig& gate) {
  list.add("gate.travel_min", gate.travel_min)
      .add("gate.travel_max", gate.travel_max)
      .add("gate.plane.travel_x", gate.plane.travel_x)
      .add("gate.plane.travel_y", gate.plane.travel_y)
      .add("gate.plane.speed_max", gate.plane.speed_max)
      .add("gate.plane.drag_speed", gate.plane.drag_speed)
      .add("gate.plane.acceleration_max", gate.plane.acceleration_max)
      .add("gate.depth_max", gate.depth_max)
      .add("gate.speed_max", gate.speed_max)
      .add("gate.speed_near", gate.speed_near)
      .add("gate.near_distance", gate.near_distance)
      .add("gate.speed_resync", gate.speed_resync)
      .add("gate.resync_distance", gate.resync_distance)
      .add("gate.acceleration_max", gate.acceleration_max)
      .add("gate.step_free", gate.step_free)
      .add("gate.force_limit", gate.force_limit)
      .add("gate.force_stop", gate.force_stop)
      .add("gate.retreat_speed", gate.retreat_speed)
      .add("gate.retract_speed", gate.retract_speed)
      .add("gate.clearance", gate.clearance)
      .add("gate.contact_force", gate.contact_force);
}

void add(settings_test::FieldList& list, const SimulatedPhantomConfig& simulation) {
  list.add("servo_frequency", simulation.servo_frequency)
      .add("servo_damping", simulation.servo_damping)
      .add("stage_lag", simulation.stage_lag)
      .add("acceleration_max", simulation.acceleration_max)
      .add("speed_max", simulation.speed_max)
      .add("encoder_step", simulation.encoder_step)
      .add("start_position", simulation.start_position)
      .add("start_place.x", simulation.start_place.x)
      .add("start_place.y", simulation.start_place.y)
      .add("plane_speed_max", simulation.plane_speed_max)
      .add("plane_travel", simulation.plane_travel)
      .add("can_drag", simulation.can_drag)
      .add("surface_offset", simulation.surface_offset)
      .add("breathing_amplitude", simulation.breathing_amplitude)
      .add("breathing_frequency", simulation.breathing_frequency)
      .add("breathing_variation", simulation.breathing_variation)
      .add("viscous_factor", simulation.viscous_factor)
      .add("sensor_cut_off", simulation.sensor_cut_off)
      .add("force_noise", simulation.force_noise)
      .add("force_quantum", simulation.force_quantum)
      .add("servo_stiffness", simulation.servo_stiffness)
      .add("yield", simulation.yield)
      .add("yield_stated", simulation.yield_stated)
      .add("simulation.seed", simulation.seed);
}

std::string text_of(const Settings& settings) {
  settings_test::FieldList list;
  list.add("listen", settings.listen);
  add(list, settings.protection);
  add(list, settings.coupling);
  add(list, settings.link);
  list.add("node.period", settings.node.period)
      .add("node.sensor_stale", settings.node.sensor_stale)
      .add("node.link_status_every", settings.node.link_status_every);
  add(list, settings.node.gate);
  list.add("stage", settings.stage)
      .add("force", settings.force)
      .add("devices", settings.devices)
      .add("phantom", settings.phantom)
      .add("estimator_kind", settings.estimator_kind)
      .add("estimator.filter_cut_off", settings.estimator.strokes.filter_cut_off)
      .add("estimator.period", settings.estimator.strokes.period)
      .add("estimator.fit_range", settings.estimator.strokes.fit_range)
      .add("estimator.radius_min", settings.estimator.bayes.prior.radius_min)
      .add("estimator.radius_max", settings.estimator.bayes.prior.radius_max)
      .add("estimator.ratio_min", settings.estimator.bayes.prior.ratio_min)
      .add("estimator.ratio_max", settings.estimator.bayes.prior.ratio_max)
      .add("estimator.shape", std::string{to_string(settings.estimator.bayes.prior.shape)})
      .add("estimator.place_spread", settings.estimator.map.place_spread)
      .add("estimator.scale", settings.estimator.bayes.stiffness.scale)
      .add("estimator.scale_stddev", settings.estimator.bayes.stiffness.scale_stddev);
  add(list, settings.simulation);
  add(list, settings.loop);
  add(list, settings.impairment);
  add(list, settings.record);
  add(list, settings.monitor);
  add(list, settings.camera);
  list.add("duration", settings.duration).add("seed", settings.seed);
  return list.text();
}

Settings settings_with(const std::vector<std::string>& assignments) {
  config::Document document = config::patient_document();
  for (const std::string& assignment : assignments) EXPECT_TRUE(document.set(assignment));
  EXPECT_TRUE(document.check());
  return make_settings(document).value();
}

TEST(PatientSettingsTest, AnEmptyDocumentGivesTheDefaultsOfTheParts) {
  EXPECT_EQ(text_of(settings_with({})), text_of(Settings{}));
}

TEST(PatientSettingsTest, EveryKnobIsRead) {
  const std::string before = text_of(settings_with({}));
  settings_test::for_each_knob(
      *proto::config::PatientConfig::descriptor(),
      "",
      [&before](const std::string& path, const std::string& value) {
        config::Document document = config::patient_document();
        ASSERT_TRUE(document.set(path, value, path)) << path << " = " << value;
        const auto made = make_settings(document);
        EXPECT_TRUE(!made || text_of(*made) != before) << "nobody reads " << path;
      });
}

TEST(PatientSettingsTest, UnknownDevicesAreErrorsThatListTheKnownOnes) {
  config::Document document = config::patient_document();
  ASSERT_TRUE(document.set("stage=robot"));
  EXPECT_THAT(make_settings(document).error().text,
              HasSubstr("unknown stage 'robot'; there are: sim, modbus"));
  document = config::patient_document();
  ASSERT_TRUE(document.set("force=kistler"));
  EXPECT_THAT(make_settings(document).error().text,
              HasSubstr("unknown force sensor 'kistler'; there are: sim, modbus"));
  document = config::patient_document();
  ASSERT_TRUE(document.set("stage=modbus"));
  EXPECT_THAT(make_settings(document).error().text, HasSubstr("do not go together"));
  ASSERT_TRUE(document.set("force=modbus"));
  EXPECT_THAT(make_settings(document).error().text, HasSubstr("needs --devices FILE"));
}

TEST(PatientSettingsTest, ACameraIsOneThatCanBe) {
  EXPECT_FALSE(settings_with({}).camera.any());
  EXPECT_TRUE(settings_with({"camera.source=phantom"}).camera.any());
  EXPECT_TRUE(settings_with({"camera.codec=jpeg"}).camera.jpeg);
  config::Document document = config::patient_document();
  ASSERT_TRUE(document.set("camera.source=film"));
  EXPECT_THAT(make_settings(document).error().text,
              HasSubstr("unknown camera 'film'; there are: none, phantom, test"));
  ASSERT_TRUE(document.set("camera.source=test"));
  ASSERT_TRUE(document.set("link.through=127.0.0.1:9"));
  EXPECT_THAT(make_settings(document).error().text, HasSubstr("no video through a relay"));
}

TEST(PatientSettingsTest, AServoIsMovedByNothingOrHasSomeStiffness) {
  EXPECT_EQ(settings_with({"simulated_phantom.servo_n_per_mm=1"}).simulation.servo_stiffness, 1e3);
  config::Document document = config::patient_document();
  ASSERT_TRUE(document.set("simulated_phantom.servo_n_per_mm=0.9"));
  EXPECT_THAT(make_settings(document).error().text,
              HasSubstr("servo_n_per_mm = 0.900 is neither 1 or more nor 0"));
  EXPECT_THAT(document.set("simulated_phantom.yield_um_per_n=1001").error().text,
              HasSubstr("yield_um_per_n"));
}

TEST(PatientSettingsTest, TheEstimatorHasTheLoopsPeriod) {
  EXPECT_EQ(settings_with({"loop.period_us=500"}).estimator.strokes.period, 0.5e-3);
}

TEST(PatientSettingsTest, WhatADeviceSaysItselfIsNoKnob) {
  for (const std::string path : {"coupling.wave.stage_lag_ms",
                                 "coupling.mmt.sensor_pole_hz",
                                 "coupling.mmt.sensor_quantum_mn",
                                 "coupling.mmt.stage_lag_ms",
                                 "estimator.sensor_pole_hz"}) {
    config::Document document = config::patient_document();
    const auto refused = document.set(path + "=20");
    ASSERT_FALSE(refused) << path;
    const std::string field = path.substr(path.rfind('.') + 1);
    EXPECT_THAT(refused.error().text, HasSubstr(field));
    const auto group = path.substr(0, path.rfind('.'));
    std::string text = field + ": 20";
    for (std::size_t end = group.size(); end != std::string::npos;) {
      const std::size_t dot = group.rfind('.', end - 1);
      text = group.substr(dot == std::string::npos ? 0 : dot + 1,
                          end - (dot == std::string::npos ? 0 : dot + 1)) +
             " { " + text + " }";
      end = dot;
    }
    const auto in_file = document.merge(text, "site.textproto");
    ASSERT_FALSE(in_file) << text;
    EXPECT_THAT(in_file.error().text, HasSubstr("no field \"" + field + "\""));
  }
}

TEST(PatientSettingsTest, BothSitesAgreeByDefault) {
  EXPECT_EQ(settings_with({}).agreement,
            surgeon::make_settings(config::surgeon_document()).value().agreement);
}

TEST(PatientSettingsTest, TheStageStartsClearOfTheSurfaceWhereverThatLies) {
  for (const std::string offset : {"-10", "-3", "0", "4"}) {
    const auto simulation =
        settings_with({"simulated_phantom.surface_offset_mm=" + offset}).simulation;
    EXPECT_LE(simulation.start_position, simulation.surface_offset - 9.99e-3) << offset;
  }
}

/// The program's own database with another grid, on disk as long as this lives.
struct ChangedDatabase {
  explicit ChangedDatabase(const std::function<void(fem::DepthGrid& grid)>& change) {
    auto table = fem::parse_table(depth::embedded_database());
    EXPECT_TRUE(table);
    change(table->grid);
    std::ofstream{file, std::ios::binary} << fem::table_bytes(*table);
  }
  ~ChangedDatabase() { std::filesystem::remove(file); }
  ChangedDatabase(const ChangedDatabase&) = delete;
  ChangedDatabase& operator=(const ChangedDatabase&) = delete;

  std::string file = test::own_path("changed.bin");
};

TEST(PatientSettingsTest, ADatabasesOwnBlockIsTheTissueUnlessItIsSaid) {
  const ChangedDatabase soft{[](fem::DepthGrid& grid) { grid.block.youngs_modulus = 9e3; }};
  const std::string database = "estimator.database=" + soft.file;
  const auto scale = [](const std::vector<std::string>& assignments) {
    return settings_with(assignments).estimator.bayes.stiffness.scale;
  };
  EXPECT_DOUBLE_EQ(scale({database}), 1);
  EXPECT_DOUBLE_EQ(scale({database, "estimator.youngs_modulus_kpa=18"}), 2);
  EXPECT_DOUBLE_EQ(scale({"estimator.youngs_modulus_kpa=30.6"}), 2);
  config::Document document = config::patient_document();
  ASSERT_TRUE(document.set("estimator.youngs_modulus_kpa=0.5"));
  EXPECT_THAT(make_settings(document).error().text, HasSubstr("is neither 1 or more nor 0"));
}

TEST(PatientSettingsTest, BallsThatADatabaseDoesNotHoldAreNotLookedFor) {
  const ChangedDatabase softer{[](fem::DepthGrid& grid) {
    for (double& ratio : grid.ratios) ratio /= 2;  // 1.5 to 450
  }};
  const std::string database = "estimator.database=" + softer.file;
  const depth::DepthPrior prior = settings_with({database}).estimator.bayes.prior;
  EXPECT_DOUBLE_EQ(prior.ratio_min, 3);
  EXPECT_DOUBLE_EQ(prior.ratio_max, 450);
  config::Document document = config::patient_document();
  ASSERT_TRUE(document.set(database));
  ASSERT_TRUE(document.set("estimator.ratio_min=500"));
  EXPECT_THAT(make_settings(document).error().text,
              HasSubstr("has a ratio of 500 to 900, it holds 1.5 to 450"));
}

TEST(PatientSettingsTest, TheTipStopsShortOfTheTablesEnd) {
  const MotionGateConfig gate = within_tables({}, 1.7e-3, 6e-3);
  EXPECT_LT(gate.travel_max, 7.7e-3);
  EXPECT_GT(gate.travel_max, 7.5e-3);
  EXPECT_EQ(within_tables({}, 0, 1).travel_max, MotionGateConfig{}.travel_max);
}

}  // namespace
}  // namespace palp::patient
