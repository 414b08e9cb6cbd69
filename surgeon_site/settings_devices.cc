#include "surgeon_site/settings_devices.h"

#include <algorithm>
#include <cmath>

#include "common/config/settings_text.h"
#include "common/core/whole_file.h"
#include "common/settings/units.h"
#include "proto/devices.pb.h"
#include "surgeon_site/devices/paddle.h"

namespace palp::surgeon {
namespace {

using proto::config::HidMasterDevice;
using settings::from_micro;
using settings::from_milli;
using settings::from_milliseconds;

/// Of the device itself, where the file says nothing.
struct MasterDefaults {
  double position_unit{};  // [m] per count; 0: none
  double force_unit{};     // [N] per count; 0: none
  Duration silence{};
};

MasterDefaults defaults_of(MasterKind kind) {
  if (kind == MasterKind::Paddle) {
    return {Paddle::kPositionUnit, Paddle::kForceUnit, std::chrono::milliseconds{5}};
  }
  if (kind == MasterKind::Board) return {0, 0, std::chrono::milliseconds{200}};
  return {SpaceMouse::kPositionUnit, 0, Duration{0}};
}

MasterInstallation make_master_installation(const HidMasterDevice& message,
                                            const MasterDefaults& defaults) {
  MasterInstallation built_in;
  const auto unit = [](double given, double otherwise) { return given > 0 ? given : otherwise; };
  built_in.position_unit = unit(from_micro(message.um_per_count()), defaults.position_unit);
  built_in.force_unit = unit(from_milli(message.mn_per_count()), defaults.force_unit);
  built_in.zero = from_milli(message.zero_mm());
  built_in.reversed = message.reversed();
  built_in.force_reversed = message.force_reversed();
  built_in.travel_min = from_milli(message.travel_min_mm());
  built_in.travel_max = from_milli(message.travel_max_mm());
  built_in.speed_max = message.speed_max_m_per_s();
  built_in.force_max = message.force_max_n();
  built_in.silence =
      message.silence_ms() > 0 ? from_milliseconds(message.silence_ms()) : defaults.silence;
  return built_in;
}

}  // namespace

Result<MasterPlan> make_master_plan(const KnownMaster& master,
                                    std::string_view text,
                                    const std::string& name) {
  proto::config::SurgeonDeviceFile message;
  if (const auto merged = config::merge_text(text, name, message); !merged) {
    return tl::unexpected{merged.error()};
  }
  if (const auto checked = config::check_settings(message); !checked) {
    return fail(name, checked.error());
  }
  const HidMasterDevice& told = message.master();
  MasterPlan plan;
  plan.product = &master;
  plan.installation = make_master_installation(told, defaults_of(master.kind));
  if (plan.installation.position_unit <= 0) {
    return fail(name + ": " + std::string{master.name} + " is not calibrated: no um_per_count");
  }
  if (master.force && plan.installation.force_unit <= 0) {
    return fail(name + ": " + std::string{master.name} + " is not calibrated: no mn_per_count");
  }
  if (!master.force) plan.installation.force_unit = 0;  // whatever the file says
  plan.pedal_button = static_cast<int>(told.pedal_button());
  plan.serial = told.serial();
  plan.rates.speed_max = told.rate_mm_per_s() * 1e-3;
  plan.rates.side_speed_max = told.side_rate_mm_per_s() * 1e-3;
  plan.rates.travel_min = plan.installation.travel_min;
  plan.rates.travel_max = plan.installation.travel_max;
  plan.rates.begin =
      std::clamp(SpaceMouse::Rates{}.begin, plan.rates.travel_min, plan.rates.travel_max);
  plan.rates.pedal_button = plan.pedal_button;
  plan.facts.axes = master.force ? 1 : 3;
  plan.facts.force_peak = told.force_max_n();
  plan.facts.force_continuous = told.force_continuous_n();
  plan.facts.lag = from_milli(told.lag_ms());
  return plan;
}

Result<MasterPlan> read_master_plan(const KnownMaster& master, const std::string& path) {
  const auto text = read_whole_file(path);
  if (!text) return tl::unexpected{text.error()};
  return make_master_plan(master, *text, path);
}

Result<std::string> calibrated_text(std::string_view text,
                                    const std::string& name,
                                    const MasterPlan& found) {
  proto::config::SurgeonDeviceFile message;
  if (const auto merged = config::merge_text(text, name, message); !merged) {
    return tl::unexpected{merged.error()};
  }
  HidMasterDevice& master = *message.mutable_master();
  const MasterInstallation& built_in = found.installation;
  // As a person reads it: no more digits than a check can tell.
  const auto rounded = [](double value) {
    const double size = std::pow(10, 5 - std::floor(std::log10(std::abs(value))));
    return value == 0 ? 0 : std::round(value * size) / size;
  };
  if (found.product->force) {
    master.set_um_per_count(rounded(built_in.position_unit * 1e6));
    master.set_mn_per_count(rounded(built_in.force_unit * 1e3));
    master.set_zero_mm(rounded(built_in.zero * 1e3));
    master.set_reversed(built_in.reversed);
    master.set_force_reversed(built_in.force_reversed);
    master.set_travel_min_mm(rounded(built_in.travel_min * 1e3));
    master.set_travel_max_mm(rounded(built_in.travel_max * 1e3));
    master.set_lag_ms(rounded(found.facts.lag * 1e3));
  }
  std::string changed = config::changed_settings_text(message, name);
  if (const auto plan = make_master_plan(*found.product, changed, name); !plan) {
    return tl::unexpected{plan.error()};
  }
  return changed;
}

}  // namespace palp::surgeon
