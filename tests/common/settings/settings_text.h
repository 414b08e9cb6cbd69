#pragma once

#include <sstream>
#include <string>
#include <string_view>

#include "common/settings/site_settings.h"

/// Settings as text, every field of them: equal texts are equal settings, up to
/// the last bit of a changed unit.
namespace palp::settings_test {

class FieldList {
 public:
  FieldList() { text_.precision(15); }
  template <class Value>
  FieldList& add(std::string_view name, const Value& value) {
    text_ << name << " = ";
    if constexpr (requires { value.count(); }) {
      text_ << value.count();
    } else {
      text_ << value;
    }
    text_ << '\n';
    return *this;
  }
  [[nodiscard]] std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
};

inline void add(FieldList& list, const coupling::CouplingConfig& config) {
  list.add("coupling.name", config.name)
      .add("coupling.direct.force_scale", config.direct.force_scale)
      .add("coupling.direct.position_scale", config.direct.position_scale)
      .add("coupling.wave.impedance", config.wave.impedance)
      .add("coupling.wave.stiffness_expected", config.wave.stiffness_expected)
      .add("coupling.tdpa.damping", config.tdpa.damping)
      .add("coupling.tdpa.damping_back", config.tdpa.damping_back)
      .add("coupling.tdpa.damping_out", config.tdpa.damping_out)
      .add("coupling.tdpa.slew", config.tdpa.slew)
      .add("coupling.tdpa.reserve", config.tdpa.reserve)
      .add("coupling.tdpa.spring", config.tdpa.spring)
      .add("coupling.mmt.tank", config.mmt.tank)
      .add("coupling.mmt.contact_damping", config.mmt.contact_damping)
      .add("coupling.mmt.air_damping", config.mmt.air_damping)
      .add("coupling.mmt.repay_contact", config.mmt.repay_contact)
      .add("coupling.mmt.repay_air", config.mmt.repay_air)
      .add("coupling.mmt.stiffness_expected", config.mmt.estimator.stiffness_expected)
      .add("coupling.mmt.memory", config.mmt.estimator.memory)
      .add("coupling.direct.spring", config.direct.spring)
      .add("coupling.direct.fade_out", config.direct.fade_out)
      .add("coupling.direct.fade_in", config.direct.fade_in);
}

inline void add(FieldList& list, const settings::ProtectionSettings& protection) {
  list.add("insecure", protection.insecure)
      .add("identity", protection.identity)
      .add("rekey_after", protection.rekey_after)
      .add("through", protection.through)
      .add("room", protection.room);
}

inline void add(FieldList& list, const link::LinkConfig& config) {
  list.add("link.period", config.period)
      .add("link.hold_after", config.watchdog.hold_after)
      .add("link.lost_after", config.watchdog.lost_after)
      .add("link.closed_after", config.closed_after)
      .add("link.sync_time", config.sync_time)
      .add("link.sync_exchanges", config.sync_exchanges)
      .add("link.round_trip_max", config.round_trip_max)
      .add("link.stale_after", config.stale_after);
}

inline void add(FieldList& list, const settings::LoopSettings& loop) {
  list.add("loop.period", loop.period)
      .add("loop.spin", loop.spin)
      .add("loop.priority", loop.priority)
      .add("loop.lock_memory", loop.lock_memory);
}

inline void add(FieldList& list, const settings::ImpairmentSettings& impairment) {
  list.add("impairment.spec", impairment.spec)
      .add("impairment.delay", impairment.delay)
      .add("impairment.jitter", impairment.jitter)
      .add("impairment.loss", impairment.loss);
}

inline void add(FieldList& list, const settings::MonitorSettings& monitor) {
  list.add("monitor.serve", monitor.serve)
      .add("monitor.port", monitor.port)
      .add("monitor.origin", monitor.origin);
}

inline void add(FieldList& list, const settings::CameraSettings& camera) {
  list.add("camera.source", camera.source)
      .add("camera.jpeg", camera.jpeg)
      .add("camera.rate_max_kbps", camera.rate_max_kbps);
}

inline void add(FieldList& list, const settings::RecordSettings& record) {
  list.add("record.file", record.file)
      .add("record.files", record.files)
      .add("record.queue_records", record.queue_records);
}

}  // namespace palp::settings_test
