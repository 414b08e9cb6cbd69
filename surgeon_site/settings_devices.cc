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
  if (kind == MasterKind::ShaftMotor) {
    return {ShaftMotor::kPositionUnit, ShaftMotor::kForceUnit, std::chrono::milliseconds{30}};
  }
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

Result<proto::config::SurgeonDeviceFile> parse(std::string_view text, const std::string& name) {
  proto::config::SurgeonDeviceFile message;
  if (const auto merged = config::merge_text(text, name, message); !merged) {
    return tl::unexpected{merged.error()};
  }
  if (const auto checked = config::check_settings(message); !checked) {
    return fail(name, checked.error());
  }
  return message;
}

Result<io::ModbusAddress> make_line(const HidMasterDevice& told) {
  auto line = io::parse_modbus_address(told.address());
  if (!line) return line;
  line->station = static_cast<std::uint8_t>(told.station());
  line->baud = told.baud();
  line->parity = ShaftMotor::kParity;
  line->reply_delay = ShaftMotor::kReplyDelay;
  return line;
}

/// Where a master that is no device on USB is, and how fast its line makes it.
Result<void> enter_line(const HidMasterDevice& told, MasterPlan& plan) {
  auto line = make_line(told);
  if (!line) return tl::unexpected{line.error()};
  plan.line = std::move(*line);
  const proto::config::HidPedal& pedal = told.pedal();
  if (pedal.vendor() == 0) return fail("it has no button: a pedal is missing");
  plan.pedal.vendor = static_cast<std::uint16_t>(pedal.vendor());
  plan.pedal.product = static_cast<std::uint16_t>(pedal.product());
  plan.pedal.interface_number = static_cast<int>(pedal.interface());
  plan.pedal.serial = pedal.serial();
  plan.pedal_bit = {pedal.byte(), static_cast<std::uint8_t>(pedal.mask())};
  const Duration usual = plan.installation.period;
  plan.installation.period = std::max(usual, ShaftMotor::time_of_exchange(plan.line));
  plan.facts.rate = 1 / seconds(plan.installation.period);
  if (told.silence_ms() > 0) return {};
  constexpr int kExchanges = 6;  // that may fail in a row
  plan.installation.silence =
      std::max(plan.installation.silence, kExchanges * plan.installation.period);
  return {};
}

/// How many buttons a master has, or its pedal bits.
std::uint32_t buttons_of(MasterKind kind) noexcept {
  if (kind == MasterKind::Board) return 64;
  if (kind == MasterKind::SpaceMouse) return 16;
  return kind == MasterKind::ShaftMotor ? 512 : 0;
}

Result<AnswerButtons> answer_buttons_of(const HidMasterDevice& told, const KnownMaster& master) {
  const std::uint32_t count = buttons_of(master.kind);
  std::vector<std::uint32_t> buttons;
  for (const auto& one : told.answer()) {
    if (count == 0) return fail("it has a pedal and no other button: no answer can be given by it");
    const std::uint32_t button = one.button();
    if (button >= count) {
      return fail("answer.button is " + std::to_string(button) + ", expected 0 to " +
                  std::to_string(count - 1));
    }
    if (master.kind != MasterKind::ShaftMotor && button == told.pedal_button()) {
      return fail("button " + std::to_string(button) + " is the pedal, and cannot be an answer");
    }
    if (std::ranges::find(buttons, button) != buttons.end()) {
      return fail("button " + std::to_string(button) + " stands for two answers");
    }
    buttons.push_back(button);
  }
  if (buttons.size() > AnswerButtons::kMost) {
    return fail("it has " + std::to_string(buttons.size()) + " answers, expected 8 at most");
  }
  return AnswerButtons{std::move(buttons)};
}

}  // namespace

Result<MasterPlan> make_master_plan(const KnownMaster& master,
                                    std::string_view text,
                                    const std::string& name) {
  const auto message = parse(text, name);
  if (!message) return tl::unexpected{message.error()};
  const HidMasterDevice& told = message->master();
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
  auto answers = answer_buttons_of(told, master);
  if (!answers) return fail(name + ": " + std::string{master.name}, answers.error());
  plan.answer_buttons = std::move(*answers);
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
  if (master.kind != MasterKind::ShaftMotor) return plan;
  if (const auto entered = enter_line(told, plan); !entered) {
    return fail(name + ": " + std::string{master.name}, entered.error());
  }
  return plan;
}

Result<std::optional<io::ModbusAddress>> line_in(std::string_view text, const std::string& name) {
  const auto message = parse(text, name);
  if (!message) return tl::unexpected{message.error()};
  if (message->master().address().empty()) return std::optional<io::ModbusAddress>{};
  auto line = make_line(message->master());
  if (!line) return fail(name, line.error());
  return std::optional{std::move(*line)};
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
