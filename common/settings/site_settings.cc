#include "common/settings/site_settings.h"

#include "common/config/settings_text.h"
#include "common/core/random.h"
#include "common/settings/units.h"
#include "proto/config.pb.h"

namespace palp::settings {

namespace {

coupling::MmtConfig make_mmt(const proto::config::Mmt& message) {
  coupling::MmtConfig config;
  config.tank = message.tank_mj() * 1e-3;
  config.contact_damping = message.contact_damping_n_s_per_m();
  config.air_damping = message.air_damping_n_s_per_m();
  config.repay_contact = message.repay_contact_n_s_per_m();
  config.repay_air = message.repay_air_n_s_per_m();
  config.estimator.stiffness_expected = message.stiffness_expected_n_per_m15();
  config.estimator.memory = message.memory_s();
  return config;
}

coupling::WaveConfig make_wave(const proto::config::Wave& message) {
  coupling::WaveConfig config;
  config.impedance = message.impedance_n_s_per_m();
  config.stiffness_expected = message.stiffness_expected_n_per_m();
  return config;
}

coupling::TdpaConfig make_tdpa(const proto::config::Tdpa& message) {
  coupling::TdpaConfig config;
  config.damping = message.damping_n_s_per_m();
  config.damping_back = message.damping_back_n_s_per_m();
  config.damping_out = message.damping_out_n_s_per_m();
  config.slew = message.slew_n_per_s();
  config.reserve = message.reserve_mj() * 1e-3;
  config.spring = message.spring_n_per_m();
  return config;
}

}  // namespace

Result<coupling::CouplingConfig> make_coupling(const proto::config::Coupling& message) {
  const proto::config::Direct& direct = message.direct();
  coupling::CouplingConfig config{.name = message.name(),
                                  .direct = {.force_scale = direct.force_scale(),
                                             .position_scale = direct.position_scale(),
                                             .spring = direct.spring_n_per_m(),
                                             .fade_out = direct.fade_out_s(),
                                             .fade_in = direct.fade_in_s()},
                                  .wave = make_wave(message.wave()),
                                  .tdpa = make_tdpa(message.tdpa()),
                                  .mmt = make_mmt(message.mmt())};
  if (const auto law = coupling::make_surgeon_coupling(config); !law) {
    return fail(law.error().text);
  }
  return config;
}

link::LinkConfig make_link(const proto::config::Link& message, Duration period) {
  link::LinkConfig config;
  config.period = period;
  config.watchdog.hold_after = from_milliseconds(message.hold_after_ms());
  config.watchdog.lost_after = from_milliseconds(message.lost_after_ms());
  config.round_trip_max = from_milliseconds(message.round_trip_max_ms());
  config.closed_after = from_seconds(message.closed_after_s());
  config.stale_after = from_milliseconds(message.stale_after_ms());
  return config;
}

LoopSettings make_loop(const proto::config::Loop& message) {
  return {.period = std::chrono::microseconds{message.period_us()},
          .spin = std::chrono::microseconds{message.spin_us()},
          .priority = static_cast<int>(message.priority()),
          .lock_memory = message.lock_memory()};
}

ImpairmentSettings make_impairment(const proto::config::Impairment& message) {
  return {.spec = message.spec(),
          .delay = from_milliseconds(message.delay_ms()),
          .jitter = from_milliseconds(message.jitter_ms()),
          .loss = message.loss()};
}

ProtectionSettings make_protection(const proto::config::Link& message) {
  return {.insecure = message.insecure(),
          .identity = message.identity(),
          .rekey_after = from_seconds(message.rekey_after_s()),
          .through = message.through(),
          .room = message.room()};
}

Result<RecordSettings> make_record(const proto::config::Record& message) {
  if (!message.file().empty() && !message.files().empty()) {
    return fail(
        "record.file (--session-file) and record.files (--session-files) exclude each other");
  }
  return RecordSettings{
      .file = message.file(), .files = message.files(), .queue_records = message.queue_records()};
}

Result<CameraSettings> make_camera(const proto::config::Camera& message) {
  const std::string& source = message.source();
  const bool device = source.starts_with('/');
  if (!device && source != "none" && source != "phantom" && source != "test") {
    return fail("unknown camera '" + source +
                "'; there are: none, phantom, test, or a video device's file (/dev/video0)");
  }
  return CameraSettings{.source = source,
                        .jpeg = message.codec() == "jpeg",
                        .rate_max_kbps = message.rate_max_kbps()};
}

MonitorSettings make_monitor(const proto::config::Monitor& message) {
  return {.serve = message.serve(),
          .port = static_cast<std::uint16_t>(message.port()),
          .origin = message.origin()};
}

std::uint64_t agreement_hash(const proto::config::Coupling& message, Duration period) {
  return random_bits(config::settings_hash(message), 0, static_cast<std::uint64_t>(period.count()));
}

}  // namespace palp::settings
