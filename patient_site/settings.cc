#include "patient_site/settings.h"

#include <algorithm>
#include <cmath>

#include "common/config/document.h"
#include "common/core/number_text.h"
#include "common/settings/units.h"
#include "proto/config.pb.h"

namespace palp::patient {
namespace {

using settings::from_micro;
using settings::from_milli;

/// The stage's servo runs past its target, and rounds to its encoder.
constexpr double kTableMargin = 0.1e-3;  // [m]

constexpr double kSameTip = 1e-3;  // [-], of tip radii

bool same_tip(double a, double b) noexcept { return std::abs(a - b) <= kSameTip * a; }

/// The forces of a database are those of one tip. The paper's formula is for its own.
Result<void> check_database(const Settings& made) {
  constexpr double kBuiltInTip = 5e-3;  // [m], of the database in the program
  const double solved =
      made.estimator.database ? made.estimator.database->grid().indenter_radius : kBuiltInTip;
  if (same_tip(made.tip_radius, solved)) return {};
  return fail(
      (made.estimator.database ? "the depth database" : "the depth database in the program") +
      number_text(" is of a tip of radius ", solved * 1e3, 2, " mm") +
      number_text(", this site's is of ", made.tip_radius * 1e3, 2, " mm (tip_radius_mm)") +
      ": set estimator.database to one of palp-fem database --indenter-radius-mm");
}

/// A simulated sensor feels nothing of a real stage, nor the other way round.
Result<void> check_devices(const proto::config::PatientConfig& message) {
  const std::string& stage = message.stage();
  const std::string& force = message.force();
  if (stage != "sim" && stage != "modbus") {
    return fail("unknown stage '" + stage + "'; there are: sim, modbus");
  }
  if (force != "sim" && force != "modbus" && force != "hid") {
    return fail("unknown force sensor '" + force + "'; there are: sim, modbus, hid");
  }
  if ((stage == "sim") != (force == "sim")) {
    return fail("stage '" + stage + "' and force sensor '" + force +
                "' do not go together: both are sim, or neither");
  }
  if (message.stage() != "sim" && message.devices().empty()) {
    return fail("stage '" + message.stage() + "' needs --devices FILE");
  }
  return {};
}

MotionGateConfig make_gate(const proto::config::MotionGate& message) {
  MotionGateConfig gate;
  gate.travel_min = from_milli(message.travel_min_mm());
  gate.travel_max = from_milli(message.travel_max_mm());
  gate.depth_max = from_milli(message.depth_max_mm());
  gate.speed_max = message.speed_max_m_per_s();
  gate.speed_near = message.speed_near_surface_m_per_s();
  gate.near_distance = from_milli(message.near_surface_mm());
  gate.speed_resync = message.speed_resync_m_per_s();
  gate.resync_distance = from_milli(message.resync_within_mm());
  gate.acceleration_max = message.acceleration_max_m_per_s2();
  gate.force_limit = message.force_limit_n();
  gate.force_stop = message.force_stop_n();
  gate.retreat_speed = message.withdraw_speed_m_per_s();
  gate.retract_speed = message.retract_speed_m_per_s();
  gate.clearance = from_milli(message.retract_clear_mm());
  gate.plane.travel_x = from_milli(message.plane_travel_x_mm());
  gate.plane.travel_y = from_milli(message.plane_travel_y_mm());
  gate.plane.speed_max = message.plane_speed_max_m_per_s();
  gate.plane.drag_speed = message.drag_speed_max_m_per_s();
  return gate;
}

SimulatedPhantomConfig make_simulation(const proto::config::SimulatedPhantom& message,
                                       std::uint64_t seed) {
  SimulatedPhantomConfig simulation;
  simulation.servo_frequency = message.servo_hz();
  simulation.servo_damping = message.servo_damping();
  simulation.stage_lag = from_milli(message.stage_lag_ms());
  simulation.acceleration_max = message.acceleration_max_m_per_s2();
  simulation.speed_max = message.speed_max_m_per_s();
  simulation.encoder_step = from_micro(message.encoder_um());
  simulation.surface_offset = from_milli(message.surface_offset_mm());
  simulation.breathing_amplitude = from_milli(message.breathing_mm());
  simulation.breathing_frequency = message.breathing_hz();
  simulation.breathing_variation = message.breathing_variation();
  simulation.can_drag = message.can_drag();
  simulation.viscous_factor = message.viscous_s_per_m();
  simulation.sensor_cut_off = message.sensor_pole_hz();
  simulation.force_noise = from_milli(message.sensor_noise_mn());
  simulation.force_quantum = from_milli(message.sensor_quantum_mn());
  simulation.servo_stiffness = 1e3 * message.servo_n_per_mm();
  simulation.yield = from_micro(message.yield_um_per_n());
  simulation.yield_stated = message.yield_stated();
  simulation.seed = seed;
  simulation.start_position += std::min(0.0, simulation.surface_offset);  // never in the tissue
  return simulation;
}

Result<void> check_servo(double newtons_per_mm) {
  if (newtons_per_mm == 0 || newtons_per_mm >= 1) return {};
  return fail(number_text("simulated_phantom.servo_n_per_mm = ",
                          newtons_per_mm,
                          3,
                          " is neither 1 or more nor 0, which nothing moves"));
}

Result<depth::DepthEstimatorConfig> make_estimator(const proto::config::Estimator& message,
                                                   Duration period) {
  depth::DepthEstimatorConfig config;
  if (message.kind() != "bayes" && message.kind() != "paper") {
    return fail("unknown estimator '" + message.kind() + "'; there are: bayes, paper");
  }
  config.kind =
      message.kind() == "paper" ? depth::EstimatorKind::Paper : depth::EstimatorKind::Bayes;
  depth::StrokeTrackerConfig& strokes = config.strokes;
  strokes.filter_cut_off = message.filter_hz();
  strokes.period = seconds(period);
  strokes.fit_range = from_milli(message.indentation_max_mm());
  depth::DepthPrior& prior = config.bayes.prior;
  prior.radius_min = from_milli(message.radius_min_mm());
  prior.radius_max = from_milli(message.radius_max_mm());
  prior.ratio_min = message.ratio_min();
  prior.ratio_max = message.ratio_max();
  prior.shape =
      message.shape() == "cylinder" ? fem::InclusionShape::Cylinder : fem::InclusionShape::Ball;
  if (!message.database().empty()) {
    auto database = depth::load_database(message.database());
    if (!database) return fail(database.error().text);
    const auto known = depth::known_part(prior, database->grid());
    if (!known) return fail(known.error().text);
    prior = *known;
    config.database = std::move(*database);
  }
  // The database's own block has this Young's modulus; every force is proportional to it.
  const fem::Block block = config.database ? config.database->grid().block : fem::Block{};
  const double modulus = message.youngs_modulus_kpa();
  if (modulus > 0 && modulus < 1) {
    return fail(number_text("estimator.youngs_modulus_kpa = ",
                            modulus,
                            3,
                            " is neither 1 or more nor 0, which is that of the database"));
  }
  config.bayes.stiffness.scale = modulus > 0 ? modulus / (block.youngs_modulus / 1e3) : 1;
  config.map.place_spread = message.place_spread();
  config.bayes.stiffness.scale_stddev =
      config.bayes.stiffness.scale * message.youngs_modulus_spread();
  return config;
}

}  // namespace

Result<Settings> make_settings(const proto::config::PatientConfig& message) {
  const auto coupling = settings::make_coupling(message.coupling());
  if (!coupling) return fail(coupling.error().text);
  if (const auto known = check_devices(message); !known) return fail(known.error().text);
  const auto servo = check_servo(message.simulated_phantom().servo_n_per_mm());
  if (!servo) return fail(servo.error().text);
  const auto record = settings::make_record(message.record());
  if (!record) return fail(record.error().text);
  Settings made;
  made.loop = settings::make_loop(message.loop());
  const auto estimator = make_estimator(message.estimator(), made.loop.period);
  if (!estimator) return fail(estimator.error().text);
  made.listen = message.listen();
  made.protection = settings::make_protection(message.link());
  made.coupling = *coupling;
  made.agreement = settings::agreement_hash(message.coupling(), made.loop.period);
  made.link = settings::make_link(message.link(), made.loop.period);
  made.node.period = made.loop.period;
  made.node.gate = make_gate(message.motion_gate());
  made.stage = message.stage();
  made.force = message.force();
  made.devices = message.devices();
  made.phantom = message.simulated_phantom().phantom();
  made.simulation = make_simulation(message.simulated_phantom(), message.seed());
  made.node.watch.force_limit = made.node.gate.force_limit;
  made.estimator_kind = message.estimator().kind();
  made.estimator = *estimator;
  // The gate's travel lies half to either side of the middle.
  made.estimator.map.travel =
      0.5 * std::min(made.node.gate.plane.travel_x, made.node.gate.plane.travel_y);
  made.tip_radius = from_milli(message.tip_radius_mm());
  if (const auto same = check_database(made); !same) return fail(same.error().text);
  made.impairment = settings::make_impairment(message.impairment());
  made.record = *record;
  made.monitor = settings::make_monitor(message.monitor());
  auto camera = settings::make_camera(message.camera());
  if (!camera) return fail(camera.error().text);
  if (camera->source == "phantom" && made.stage != "sim") {
    return fail("camera 'phantom' is drawn beside a simulated stage; this stage is '" + made.stage +
                "'");
  }
  if (camera->any() && !made.protection.through.empty()) {
    return fail("camera '" + camera->source + "': there is no video through a relay");
  }
  made.camera = std::move(*camera);
  made.duration = from_seconds(message.duration_s());
  made.seed = message.seed();
  return made;
}

Result<Settings> make_settings(const config::Document& document) {
  return make_settings(document.as<proto::config::PatientConfig>());
}

Result<void> check_tip(const Settings& settings, const Phantom& phantom) {
  if (!phantom.tip_radius || same_tip(settings.tip_radius, *phantom.tip_radius)) return {};
  return fail(
      "phantom '" + phantom.name + "'" +
      number_text(" is of a tip of radius ", *phantom.tip_radius * 1e3, 2, " mm") +
      number_text(", this site's is of ", settings.tip_radius * 1e3, 2, " mm (tip_radius_mm)"));
}

MotionGateConfig within_tables(MotionGateConfig gate,
                               double surface_offset,
                               double depth_max) noexcept {
  gate.travel_max = std::min(gate.travel_max, surface_offset + depth_max - kTableMargin);
  return gate;
}

}  // namespace palp::patient
